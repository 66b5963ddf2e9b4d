/* SPDX-License-Identifier: MIT */
/* Plugins that must be refused; which one is chosen by a definition. */
#include <stdlib.h>
#include <unistd.h>

#include "hapticd/shape.h"

#if defined(BAD_NO_SYMBOL)
HSP_EXPORT extern const int something_else;
const int something_else = 1;
#else

#if defined(BAD_UNRESOLVED)
int a_function_that_nobody_has(void);
HSP_EXPORT int use_it(void);
int use_it(void) {
  return a_function_that_nobody_has();
}
#endif

#if defined(BAD_CRASH) || defined(BAD_EXIT) || defined(BAD_HANG)
__attribute__((constructor)) static void begin(void) {
#if defined(BAD_CRASH)
  volatile int* volatile nowhere = NULL;
  *nowhere = 1;
#elif defined(BAD_EXIT)
  _exit(0);
#else
  for (;;) pause();
#endif
}
#endif

#if defined(BAD_NULL_CLASS)
static const hsp_class* const kClasses[] = {NULL};
#else
static const hsp_class kClass = {.struct_size = sizeof(hsp_class),
                                 .id = "org.hapticd.test.bad",
                                 .name = "bad",
                                 .version = "1",
                                 .license = "MIT",
                                 .doc = ""};
static const hsp_class* const kClasses[] = {&kClass};
#endif

#if defined(BAD_MAGIC)
HSP_EXPORT const hsp_entry hsp_plugin_entry = {0xdeadbeefu, HSP_ABI_MAJOR, HSP_ABI_MINOR, 1, kClasses};
#elif defined(BAD_MAJOR)
HSP_EXPORT const hsp_entry hsp_plugin_entry = {HSP_MAGIC, HSP_ABI_MAJOR + 1, 3, 1, kClasses};
#elif defined(BAD_NO_CLASS)
HSP_EXPORT const hsp_entry hsp_plugin_entry = {HSP_MAGIC, HSP_ABI_MAJOR, HSP_ABI_MINOR, 0, kClasses};
#else
HSP_EXPORT const hsp_entry hsp_plugin_entry = {HSP_MAGIC, HSP_ABI_MAJOR, HSP_ABI_MINOR, 1, kClasses};
#endif
#endif
