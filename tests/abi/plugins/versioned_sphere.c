/* SPDX-License-Identifier: MIT */
/* A sphere in plain C, without any helper: the smallest whole plugin. It is built against the headers as they are,
 * against smaller ones and against larger ones (VERSIONED_NAME tells them apart); all must answer alike. */
#include <math.h>
#include <stdlib.h>

#include "shape.h"

#define TEXT_OF(x) #x
#define TEXT(x) TEXT_OF(x)

struct hsp_shape {
  double radius, stiffness;
  int active;
};

static const hsp_param kParams[] = {{.struct_size = sizeof(hsp_param),
                                     .kind = HSP_REAL,
                                     .id = "radius",
                                     .unit = "m",
                                     .doc = "Radius.",
                                     .min = 1e-4,
                                     .max = 10,
                                     .def = 0.05},
                                    {.struct_size = sizeof(hsp_param),
                                     .kind = HSP_REAL,
                                     .flags = HSP_P_SAFETY,
                                     .id = "stiffness",
                                     .unit = "N/m",
                                     .doc = "Stiffness.",
                                     .min = 0,
                                     .max = 1e5,
                                     .def = 500}};

static hsp_shape* create(const struct hsp_class* shape_class, const hsp_host* host) {
  (void)shape_class, (void)host;
  hsp_shape* sphere = calloc(1, sizeof *sphere);
  if (sphere != NULL) sphere->radius = kParams[0].def, sphere->stiffness = kParams[1].def;
  return sphere;
}

static void destroy(hsp_shape* sphere) {
  free(sphere);
}

static hsp_status set(hsp_shape* sphere, uint32_t param, const hsp_value* value) {
  if (sphere->active) return HSP_E_STATE;
  if (param > 1 || value->kind != HSP_REAL) return HSP_E_ARG;
  if (!(value->number >= kParams[param].min && value->number <= kParams[param].max)) return HSP_E_ARG;
  *(param == 0 ? &sphere->radius : &sphere->stiffness) = value->number;
  return HSP_OK;
}

static hsp_status get(hsp_shape* sphere, uint32_t param, hsp_value* value) {
  if (param > 1) return HSP_E_ARG;
  value->kind = HSP_REAL;
  value->number = param == 0 ? sphere->radius : sphere->stiffness;
  return HSP_OK;
}

static hsp_status activate(hsp_shape* sphere, const hsp_activation* activation, hsp_report* report) {
  if (sphere->active) return HSP_E_STATE;
  if (!(activation->rate_hz > 0)) return HSP_E_ARG;
  report->max_stiffness = sphere->stiffness;
  report->size_m = 2 * sphere->radius;
#ifdef VERSIONED_LARGER
  if (HSP_HAS(report, later)) report->later = 4.5;
#endif
  sphere->active = 1;
  return HSP_OK;
}

static void deactivate(hsp_shape* sphere) {
  sphere->active = 0;
}
static void reset(hsp_shape* sphere) {
  (void)sphere;
}

static void touch(const hsp_shape* sphere, const hsp_probe* in, hsp_contact* out) {
  if (in->flags & HSP_IN_INVALID) return; /* no good sample: no force */
  const double* p = in->position;
  const double distance = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
  const double inverse = distance > 0 ? 1 / distance : 0;
  out->depth_m = sphere->radius - distance;
  out->flags = HSP_OUT_TRACED | (out->depth_m > 0 ? (uint32_t)HSP_OUT_CONTACT : 0u);
  out->stiffness = sphere->stiffness;
  for (int i = 0; i < 3; ++i) {
    out->normal[i] = p[i] * inverse;
    out->point[i] = out->normal[i] * sphere->radius;
    out->force[i] = out->depth_m > 0 ? sphere->stiffness * out->depth_m * out->normal[i] : 0;
  }
}

static hsp_status step(hsp_shape* sphere, const hsp_step* step) {
  if (!sphere->active) return HSP_E_STATE;
  for (uint32_t i = 0; i < step->count; ++i) {
    hsp_contact* out = HSP_AT(hsp_contact, step->out, step->out_stride, i);
    touch(sphere, HSP_AT(const hsp_probe, step->in, step->in_stride, i), out);
#ifdef VERSIONED_LARGER
    if (step->out_stride >= sizeof *out)
      out->later = 7.5; /* members of records: the stride tells whether they are there */
#endif
  }
  return HSP_OK;
}

#ifndef VERSIONED_SMALLER
static const void* extension(hsp_shape* sphere, const char* name) {
  (void)sphere, (void)name;
  return NULL;
}
#endif

static const hsp_class kClass = {
    .struct_size = sizeof(hsp_class),
    .param_count = 2,
    .id = "org.hapticd.test." TEXT(VERSIONED_NAME),
    .name = TEXT(VERSIONED_NAME),
    .version = "1.0.0",
    .license = "MIT",
    .doc = "A sphere in plain C.",
    .params = kParams,
    .create = create,
    .destroy = destroy,
    .set = set,
    .get = get,
    .activate = activate,
    .deactivate = deactivate,
    .reset = reset,
    .step = step,
#ifndef VERSIONED_SMALLER
    .extension = extension,
#endif
};
static const hsp_class* const kClasses[] = {&kClass};
HSP_EXPORT const hsp_entry hsp_plugin_entry = {HSP_MAGIC, HSP_ABI_MAJOR, HSP_ABI_MINOR, 1, kClasses};
