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

/// Median of `work()` after `bytes` of other memory went through the caches and `prepare()` had a few microseconds.
template <class Prepare, class Work>
double cold(std::size_t bytes, Prepare prepare, Work work) {
  std::vector<char> other(bytes, 1);
  std::vector<double> times;
  for (int tick = 0; tick < kColdTicks; ++tick) {
    for (std::size_t i = 0; i < bytes; i += 64) other[i] = static_cast<char>(other[i] + 1);
    keep(other.data());
    prepare();
    for (int wait = 0; wait < 2000; ++wait) keep(wait);
    times.push_back(nanoseconds(1, work));
  }
  return median(times);
}

template <class Touch, class Work>
void printRow(const std::string& name, const char* what, Touch touch, Work work) {
  const auto nothing = [] {};
  std::printf("| %s | %s | %.0f | %.0f | %.0f | %.0f |\n", name.c_str(), what, cold(0, nothing, work),
              cold(kBeyondL2, nothing, work), cold(kBeyondL3, nothing, work), cold(kBeyondL3, touch, work));
}

void printEvaluation(const spline::SurfaceData& data, spline::Form form, const char* what) {
  const spline::Surface surface(data, form);
  spline::SurfacePoint E;
  surface.evaluate2(0.31, 0.42, E);
  printRow(
      data.name, what, [&] { surface.prefetch(E); },
      [&] {
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
  printRow(
      data.name, "tick", [&] { tracer.prefetch(); },
      [&] { keep(tracer.step(path.probe[i++ % path.probe.size()]).depth); });
}

}  // namespace

void printCold() {
  std::printf("\n## Cold caches [ns, the clock's own cost included]\n\n");
  std::printf(
      "Median of %d single calls after so much other memory was touched; prefetched: after that, the data of the\n"
      "last tick was asked for a few microseconds ahead, as a servo can while it waits. Code stays cold.\n\n",
      kColdTicks);
  std::printf(
      "| surface | call | hot | 4 MB later | 128 MB later | 128 MB later, prefetched |\n|---|---|---|---|---|---|\n");
  for (const auto& data : surfaces()) {
    printEvaluation(data, spline::Form::kTable, "evaluation, table");
    printEvaluation(data, spline::Form::kNet, "evaluation, net");
    printTick(data);
  }
}

}  // namespace hapticd::bench
