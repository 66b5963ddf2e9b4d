/* SPDX-License-Identifier: MIT */
/* A ball in plain C: a small complete plugin, with two parameters and triangles for the view.
 * `hapticd plugin new NAME --language c` copies it under another name; delete what your shape does not need. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "hapticd/shape.h"

enum { RADIUS, STIFFNESS, PARAMS };  /* numbers of the parameters */
enum { RINGS = 24, SIDES = 36 };     /* of the triangles */
#define PI 3.14159265358979323846

/* One ball. `hsp_shape` is the name that the host has for it; its content belongs to the plugin. */
struct hsp_shape {
  double value[PARAMS];
  int active;
  float xyz[3 * (RINGS + 1) * (SIDES + 1)], normals[3 * (RINGS + 1) * (SIDES + 1)];
  uint32_t corners[6 * RINGS * SIDES];
};

static const hsp_param params[PARAMS] = {{.struct_size = sizeof(hsp_param),
                                          .kind = HSP_REAL,
                                          .id = "radius",
                                          .unit = "m",
                                          .doc = "Radius of the ball.",
                                          .min = 0.001,
                                          .max = 1,
                                          .def = 0.05},
                                         {.struct_size = sizeof(hsp_param),
                                          .kind = HSP_REAL,
                                          .flags = HSP_P_LIVE | HSP_P_SAFETY, /* it may change while a hand feels it */
                                          .id = "stiffness",
                                          .unit = "N/m",
                                          .doc = "Force for each metre of depth.",
                                          .min = 0,
                                          .max = 5000,
                                          .def = 500}};

static hsp_shape* create(const struct hsp_class* shape_class, const hsp_host* host) {
  hsp_shape* ball = calloc(1, sizeof *ball);
  (void)shape_class, (void)host;
  for (int i = 0; ball != NULL && i < PARAMS; ++i) ball->value[i] = params[i].def;
  return ball;
}

static void destroy(hsp_shape* ball) { free(ball); }

/* Called before activate(), once for each parameter of the scene. The host has checked kind and range; a number that is
 * not finite passes no comparison. */
static hsp_status set(hsp_shape* ball, uint32_t param, const hsp_value* value) {
  if (ball->active) return HSP_E_STATE;
  if (param >= PARAMS || value->kind != HSP_REAL) return HSP_E_ARG;
  if (!(value->number >= params[param].min && value->number <= params[param].max)) return HSP_E_ARG;
  ball->value[param] = value->number;
  return HSP_OK;
}

static hsp_status get(hsp_shape* ball, uint32_t param, hsp_value* value) {
  if (param >= PARAMS) return HSP_E_ARG;
  value->kind = HSP_REAL;
  value->number = ball->value[param];
  return HSP_OK;
}

/* May allocate and read files. Claims what the host may rely on. */
static hsp_status activate(hsp_shape* ball, const hsp_activation* activation, hsp_report* report) {
  if (ball->active) return HSP_E_STATE;
  if (!(activation->rate_hz > 0)) return HSP_E_ARG;
  report->max_stiffness = ball->value[STIFFNESS];
  report->size_m = 2 * ball->value[RADIUS];
  report->flags |= HSP_R_PUSHES; /* without friction it only pushes: a pull would be a wrong sign */
  report->typical_ns = 30;
  report->worst_ns = 2000;
  ball->active = 1;
  return HSP_OK;
}

static void deactivate(hsp_shape* ball) { ball->active = 0; }

/* Forgets what the shape remembers of the probes; this ball remembers nothing. */
static void reset(hsp_shape* ball) { (void)ball; }

static void touch(const hsp_shape* ball, const hsp_probe* probe, hsp_contact* contact) {
  const double* p = probe->position;
  const double radius = ball->value[RADIUS], stiffness = ball->value[STIFFNESS];
  const double distance = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
  if (probe->flags & HSP_IN_INVALID) return; /* no sample: no force */
  if (distance == 0) return;                 /* the centre has no nearest point of the surface */
  contact->flags = HSP_OUT_TRACED;
  contact->depth_m = radius - distance;
  for (int i = 0; i < 3; ++i) {
    contact->normal[i] = p[i] / distance;
    contact->point[i] = radius * contact->normal[i];
  }
  if (!(contact->depth_m > 0)) return;
  contact->flags |= HSP_OUT_CONTACT;
  contact->stiffness = stiffness;
  for (int i = 0; i < 3; ++i) contact->force[i] = stiffness * contact->depth_m * contact->normal[i];
}

/* Called once in every tick, in the servo thread: no allocation, lock or system call. All values are in the model frame
 * and in SI units. Records are `stride` bytes apart, because the host may know longer ones; HSP_AT() finds them. */
static hsp_status step(hsp_shape* ball, const hsp_step* step) {
  if (!ball->active) return HSP_E_STATE;
  for (uint32_t i = 0; i < step->change_count; ++i)
    if (step->changes[i].param == STIFFNESS) ball->value[STIFFNESS] = step->changes[i].value;
  for (uint32_t i = 0; i < step->count; ++i)
    touch(ball, HSP_AT(const hsp_probe, step->in, step->in_stride, i), HSP_AT(hsp_contact, step->out, step->out_stride, i));
  return HSP_OK;
}

static hsp_status bounds(hsp_shape* ball, double min[3], double max[3]) {
  for (int i = 0; i < 3; ++i) max[i] = ball->value[RADIUS], min[i] = -max[i];
  return HSP_OK;
}

/* Makes rings of vertices from pole to pole. The arrays stay valid until the next call. */
static hsp_status tessellate(hsp_shape* ball, double chord_error_m, hsp_mesh* mesh) {
  uint32_t corner = 0, vertex = 0;
  (void)chord_error_m;
  for (uint32_t i = 0; i <= RINGS; ++i)
    for (uint32_t k = 0; k <= SIDES; ++k, ++vertex) {
      const double down = PI * i / RINGS, round = 2 * PI * k / SIDES;
      const double n[3] = {sin(down) * cos(round), cos(down), -sin(down) * sin(round)};
      for (int axis = 0; axis < 3; ++axis) {
        ball->normals[3 * vertex + axis] = (float)n[axis];
        ball->xyz[3 * vertex + axis] = (float)(ball->value[RADIUS] * n[axis]);
      }
      if (i == RINGS || k == SIDES) continue;
      const uint32_t below = vertex + SIDES + 1;
      const uint32_t both[6] = {vertex, below, vertex + 1, vertex + 1, below, below + 1};
      memcpy(ball->corners + corner, both, sizeof both);
      corner += 6;
    }
  mesh->xyz = ball->xyz, mesh->normals = ball->normals, mesh->indices = ball->corners;
  mesh->vertex_count = vertex, mesh->triangle_count = corner / 3;
  return HSP_OK;
}

/* Returns the triangles for `run --view` and other drawings. Forces do not need them. */
static const void* extension(hsp_shape* ball, const char* name) {
  static const hsp_ext_geometry geometry = {sizeof(hsp_ext_geometry), 0, tessellate, bounds};
  (void)ball;
  return strcmp(name, HSP_EXT_GEOMETRY) == 0 ? &geometry : NULL;
}

static const hsp_class ball_class = {.struct_size = sizeof(hsp_class),
                                     .param_count = PARAMS,
                                     .id = "org.hapticd.shape.template",
                                     .name = "template",
                                     .version = "0.1.0",
                                     .license = "MIT",
                                     .doc = "A ball about the model's origin; start your own plugin from it.",
                                     .params = params,
                                     .create = create,
                                     .destroy = destroy,
                                     .set = set,
                                     .get = get,
                                     .activate = activate,
                                     .deactivate = deactivate,
                                     .reset = reset,
                                     .step = step,
                                     .extension = extension};
static const hsp_class* const classes[] = {&ball_class};
HSP_EXPORT const hsp_entry hsp_plugin_entry = {HSP_MAGIC, HSP_ABI_MAJOR, HSP_ABI_MINOR, 1, classes};
