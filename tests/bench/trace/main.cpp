/// bench_trace: figures to read, not a test, as Markdown. Run it on an idle machine; compare ratios, not absolute
/// times.
#include <cstdio>
#include <cstring>
#include <fstream>

#include "bench.hpp"

namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

void printHead() {
  std::printf("# What tracing costs\n\nMade by `bench_trace --write` (in the build folder's `bench/`). ");
  std::printf("Compare ratios, not times: they hold for one %s.\n", processor().c_str());
#ifndef HAPTICD_WITH_OCCT
  std::printf("Without Open CASCADE: install libocct-modeling-algorithms-dev libocct-modeling-data-dev.\n");
#endif
#ifndef HAPTICD_WITH_SISL
  std::printf("Without SISL: install libsisl-dev.\n");
#endif
}

struct Part {
  const char* name;
  void (*print)();
};

}  // namespace

/// Prints all parts, or those named; with --write, all into driver/docs/bench_trace.md.
int main(int count, char** names) {
  using namespace hapticd::bench;
  constexpr Part kParts[] = {{"evaluation", printEvaluations},
                             {"float", printFloat},
                             {"tick", printTicks},
                             {"cold", printCold},
                             {"many", printMany},
                             {"scale", printScale}};
  if (count == 2 && std::strcmp(names[1], "--write") == 0) {
    count = 1;
    if (std::freopen(HAPTICD_SOURCE_DIR "/driver/docs/bench_trace.md", "w", stdout) == nullptr) {
      std::perror("error: driver/docs/bench_trace.md");
      return 1;
    }
  }
  if (count == 1) printHead();
  for (const Part& part : kParts) {
    bool wanted = count == 1;
    for (int i = 1; i < count; ++i) wanted = wanted || std::strcmp(names[i], part.name) == 0;
    if (wanted) part.print();
  }
}
