/* SPDX-License-Identifier: MIT */
/* names.c - opens the library by every name that programs know it by: it is there once, with all its functions.
 * Usage: names GOLDEN     a file with a function a line */
#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

int main(int argc, char** argv) {
  static const char* const names[] = {"libHD.so", "libHD.so.3", "libHD.so.3.0", "libHD.so.3.4", "libHD.so.3.4.0"};
  static const char* const stubs[] = {"libHL.so", "libHL.so.3.4", "libPHANToMIO.so", "libPhantomIOLib42.so"};
  void *first = NULL, *library = NULL;
  char name[128];
  int count = 0;
  size_t i;
  FILE* golden = argc > 1 ? fopen(argv[1], "r") : NULL;
  if (golden == NULL) return fprintf(stderr, "names GOLDEN\n"), 2;
  for (i = 0; i < sizeof names / sizeof names[0]; ++i) {
    library = dlopen(names[i], RTLD_NOW);
    if (library == NULL) return printf("FAILED %s: %s\n", names[i], dlerror()), 1;
    if (first == NULL) first = dlsym(library, "hdInitDevice");
    if (dlsym(library, "hdInitDevice") != first) return printf("FAILED %s is there twice\n", names[i]), 1;
  }
  for (i = 0; i < sizeof stubs / sizeof stubs[0]; ++i)
    if (dlopen(stubs[i], RTLD_NOW) == NULL) return printf("FAILED %s: %s\n", stubs[i], dlerror()), 1;
  while (fgets(name, sizeof name, golden) != NULL) {
    name[strcspn(name, "\n")] = '\0';
    if (dlsym(library, name) == NULL) return printf("FAILED %s is missing\n", name), 1;
    ++count;
  }
  fclose(golden);
  printf("%s %d functions by every name\n", count == 36 ? "ok    " : "FAILED", count);
  return count == 36 ? 0 : 1;
}
