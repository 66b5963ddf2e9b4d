// SPDX-License-Identifier: MIT
/// bench_trace: measures the time of tracing and prints tables in Markdown. It is not a test. Run it on an idle
/// machine, and compare ratios rather than absolute times.
#include <cstdio>
#include <cstring>
#include <fstream>

#include "bench.hpp"

#ifdef HAPTICD_WITH_OCCT
#include <Standard_Version.hxx>
#endif

namespace {

using namespace hapticd::bench;

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
  std::printf(
      "\n* **table** keeps the polynomials of every knot span, **net** the control points alone; the parameter\n"
      "  `evaluation` of a model chooses. **Portable code** is the same without AVX2 and FMA.\n"
      "* **newton** goes on until the foot is known to the tolerance, 1 nm or 1 fm; **dpt x n** takes n first-order\n"
      "  steps of Thompson et al. (1999) a tick, whatever they leave. The parameter `method` chooses.\n"
      "* **Surfaces**: wavy sheets, 0.2 m long, of degree 3 (10 x 10 points) and 5 (12 x 12), a finely ridged one of\n"
      "  degree 3 (48 x 48), a rational sphere of radius 50 mm and torus of radii 60 and 20 mm.\n");
#ifdef HAPTICD_WITH_OCCT
  std::printf("* **OCCT** is Open CASCADE %s.\n", OCC_VERSION_COMPLETE);
#else
  std::printf("* Without Open CASCADE: install libocct-modeling-algorithms-dev libocct-modeling-data-dev.\n");
#endif
#ifdef HAPTICD_WITH_SISL
  std::printf("* **SISL** tells no version of its own; Debian 12 packages 4.6.0.\n");
#else
  std::printf("* Without SISL: install libsisl-dev.\n");
#endif
}

struct Part {
  const char* name;
  void (*print)();
};

constexpr Part kParts[] = {{"evaluation", printEvaluations},
                           {"float", printFloat},
                           {"tick", printTicks},
                           {"cold", printCold},
                           {"many", printMany},
                           {"scale", printScale}};

void printUsage(std::FILE* to) {
  std::fprintf(to,
               "Usage: bench_trace [PART...]\n"
               "       bench_trace --write\n\n"
               "Measures the time of tracing on this machine and prints tables in Markdown: all parts, or those that "
               "are named, of\n ");
  for (const Part& part : kParts) std::fprintf(to, " %s", part.name);
  std::fprintf(to,
               ".\n  --write    measure all parts and overwrite driver/docs/reports/bench_trace.md\n\n"
               "Run it on an idle machine; all parts together take minutes. Exit code 2: bad usage.\n"
               "Example: bench_trace tick\n");
}

bool isPart(const char* name) {
  for (const Part& part : kParts)
    if (std::strcmp(name, part.name) == 0) return true;
  return false;
}

}  // namespace

int main(int count, char** names) {
  for (int i = 1; i < count; ++i) {
    if (std::strcmp(names[i], "--help") == 0 || std::strcmp(names[i], "-h") == 0) {
      printUsage(stdout);
      return 0;
    }
    if (isPart(names[i]) || (count == 2 && std::strcmp(names[i], "--write") == 0)) continue;
    const bool writes = std::strcmp(names[i], "--write") == 0;
    std::fprintf(stderr, writes ? "error: %s takes no parts\n" : "error: there is no part %s\n", names[i]);
    printUsage(stderr);
    return 2;
  }
  if (count == 2 && std::strcmp(names[1], "--write") == 0) {
    count = 1;
    if (std::freopen(HAPTICD_SOURCE_DIR "/driver/docs/reports/bench_trace.md", "w", stdout) == nullptr) {
      std::perror("error: driver/docs/reports/bench_trace.md");
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
