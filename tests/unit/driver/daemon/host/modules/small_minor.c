/* SPDX-License-Identifier: MIT */
/* A plain C plugin of a smaller minor version: its class ends before `extension`, its parameters before `def_text`. */
#include "hapticd/shape.h"

static char the_shape;
static double depth;

static hsp_shape* create(const hsp_class* c, const hsp_host* h) {
  (void)c, (void)h;
  return (hsp_shape*)&the_shape;
}
static void destroy(hsp_shape* s) {
  (void)s;
}
static hsp_status set(hsp_shape* s, uint32_t i, const hsp_value* v) {
  (void)s;
  if (i != 0) return HSP_E_ARG;
  depth = v->number;
  return HSP_OK;
}
static hsp_status get(hsp_shape* s, uint32_t i, hsp_value* v) {
  (void)s, (void)i;
  v->kind = HSP_REAL;
  v->number = depth;
  return HSP_OK;
}
static hsp_status activate(hsp_shape* s, const hsp_activation* a, hsp_report* r) {
  (void)s, (void)a;
  r->max_stiffness = 1;
  return HSP_OK;
}
static void deactivate(hsp_shape* s) {
  (void)s;
}
static void reset(hsp_shape* s) {
  (void)s;
}
static hsp_status step(hsp_shape* s, const hsp_step* st) {
  (void)s;
  HSP_AT(hsp_contact, st->out, st->out_stride, 0)->depth_m = depth;
  return HSP_OK;
}

/* What a compiler would have laid out before the last members existed: the same, but shorter. */
struct old_param {
  uint32_t struct_size, kind, flags, choice_count;
  const char *id, *unit, *doc;
  double min, max, def;
  const char* const* choices;
  uint32_t columns, min_count, max_count, reserved;
};
static const struct old_param kParams[2] = {
    {sizeof(struct old_param), HSP_REAL, 0, 0, "depth", "m", "The depth\tthat it reports.", 0, 1, 0, 0, 0, 0, 0, 0},
    {sizeof(struct old_param), HSP_INT, 0, 0, "unused", "", "Never used.", 0, 9, 3, 0, 0, 0, 0, 0}};
struct old_class {
  uint32_t struct_size, param_count, flags, reserved;
  const char *id, *name, *version, *license, *doc;
  const void* params;
  hsp_shape* (*create)(const hsp_class*, const hsp_host*);
  void (*destroy)(hsp_shape*);
  hsp_status (*set)(hsp_shape*, uint32_t, const hsp_value*);
  hsp_status (*get)(hsp_shape*, uint32_t, hsp_value*);
  hsp_status (*activate)(hsp_shape*, const hsp_activation*, hsp_report*);
  void (*deactivate)(hsp_shape*);
  void (*reset)(hsp_shape*);
  hsp_status (*step)(hsp_shape*, const hsp_step*);
};
static const struct old_class kClass = {sizeof(struct old_class),
                                        2,
                                        0,
                                        0,
                                        "org.hapticd.test.small",
                                        "small_minor",
                                        "1",
                                        "MIT",
                                        "An old\n\x1b[2Jplugin.",
                                        kParams,
                                        create,
                                        destroy,
                                        set,
                                        get,
                                        activate,
                                        deactivate,
                                        reset,
                                        step};
static const hsp_class* const kClasses[] = {(const hsp_class*)(const void*)&kClass};
const hsp_entry hsp_plugin_entry = {HSP_MAGIC, HSP_ABI_MAJOR, 0, 1, kClasses};
