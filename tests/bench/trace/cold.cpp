#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench.hpp"
#include "kernels/trace/tracer.hpp"

namespace hapticd::bench {
namespace {

constexpr int kColdTicks = 100;
constexpr std::size_t kBeyondL2 = 4u << 20, kBeyondL3 = 128u << 20;  // [bytes]

double median(std::vector<double>& times) {
  std::nth_element(times.begin(), times.begin() + kColdTicks / 2, times.end());
  return times[kColdTicks / 2];
}

/// Median of `work()` after `bytes` of other memory went through the caches.
template <class Work>
double cold(std::size_t bytes, Work work) {
  std::vector<char> other(bytes, 1);
  std::vector<double> times;
  for (int tick = 0; tick < kColdTicks; ++tick) {
    for (std::size_t i = 0; i < bytes; i += 64) other[i] = static_cast<char>(other[i] + 1);
    keep(other.data());
    times.push_back(nanoseconds(1, work));
  }
  return median(times);
}

template <class Work>
void printRow(const std::string& name, const char* what, Work work) {
  std::printf("| %s | %s | %.0f | %.0f | %.0f |\n", name.c_str(), what, cold(0, work), cold(kBeyondL2, work),
              cold(kBeyondL3, work));
}

void printEvaluation(const spline::SurfaceData& data, spline::Form form, const char* what) {
  const spline::Surface surface(data, form);
  spline::SurfacePoint E;
  surface.evaluate2(0.31, 0.42, E);
  printRow(data.name, what, [&] {
    surface.evaluate2(0.31, 0.42, E);
    keep(E.S[0]);
  });
}

void printTick(const spline::SurfaceData& data) {
  const trace::Model model({data});
  trace::Tracer tracer(model);
  const Path path = contactPath(data, kStep, kDepth, kTicks);
  tracer.activate(0, path.uv[0][0], path.uv[0][1]);
  std::size_t i = 0;
  printRow(data.name, "tick", [&] { keep(tracer.step(path.probe[i++ % path.probe.size()]).depth); });
}

}  // namespace

void printCold() {
  std::printf("\n## Cold caches [ns, the clock's own cost included]\n\n");
  std::printf(
      "Median of %d single calls after so much other memory was touched. Most of a cold tick waits for code and page\n"
      "tables: to ask for its data a few microseconds ahead saved 18 %% of it, to ask at its start nothing, and a "
      "servo\n"
      "that sleeps until its deadline has no time ahead. So nothing is prefetched.\n\n",
      kColdTicks);
  std::printf("| surface | call | hot | 4 MB later | 128 MB later |\n|---|---|---|---|---|\n");
  for (const auto& data : surfaces()) {
    printEvaluation(data, spline::Form::kTable, "evaluation, table");
    printEvaluation(data, spline::Form::kNet, "evaluation, net");
    printTick(data);
  }
}

}  // namespace hapticd::bench
