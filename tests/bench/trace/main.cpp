/// bench_trace: figures to read, not a test. Run it on an idle machine; compare ratios, not absolute times.
#include <cstdio>

#include "bench.hpp"

int main() {
#ifndef HAPTICD_WITH_OCCT
  std::printf("without Open CASCADE: install libocct-modeling-algorithms-dev libocct-modeling-data-dev\n");
#endif
#ifndef HAPTICD_WITH_SISL
  std::printf("without SISL: install libsisl-dev\n");
#endif
  hapticd::bench::printEvaluations();
  hapticd::bench::printTicks();
}
