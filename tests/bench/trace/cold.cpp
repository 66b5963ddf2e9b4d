// SPDX-License-Identifier: MIT
#include <algorithm>
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

/// Returns the median time [ns] of `work()`. Before each call, `bytes` of other memory replace the contents of the
/// caches, and then `ahead()` is called, whose time does not count.
template <class Work, class Ahead>
double cold(std::size_t bytes, Work work, Ahead ahead) {
  std::vector<char> other(bytes, 1);
  std::vector<double> times;
  for (int tick = 0; tick < kColdTicks; ++tick) {
    for (std::size_t i = 0; i < bytes; i += 64) other[i] = static_cast<char>(other[i] + 1);
    keep(other.data());
    ahead();
    times.push_back(nanoseconds(1, work));
  }
  return median(times);
}

template <class Work, class Ahead>
void printRow(const std::string& name, const char* what, Work work, Ahead ahead) {
  std::printf("| %s | %s | %.0f | %.0f | %.0f |\n", name.c_str(), what, cold(0, work, ahead),
              cold(kBeyondL2, work, ahead), cold(kBeyondL3, work, ahead));
}
template <class Work>
void printRow(const std::string& name, const char* what, Work work) {
  printRow(name, what, work, [] {});
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

/// Prefetches `count` bytes.
void askFor(const void* begin, std::size_t count) {
  for (std::size_t i = 0; i < count; i += 64) __builtin_prefetch(static_cast<const char*>(begin) + i);
}

/// Waits 3 us, until prefetched memory has arrived.
void waitForMemory() {
  const auto begin = std::chrono::steady_clock::now();
  while (std::chrono::steady_clock::now() - begin < std::chrono::microseconds(3)) {
  }
}

/// Measures how much time a prefetch of the memory for the next tick saves, at several points in time.
void printAhead(const spline::SurfaceData& data) {
  const trace::Model model({data});
  trace::Tracer tracer(model);
  const Path path = contactPath(data, kStep, kDepth, kTicks);
  tracer.activate(0, path.uv[0][0], path.uv[0][1]);
  std::size_t i = 0;
  trace::Foot foot = tracer.step(path.probe[0]);
  const auto tick = [&] {
    foot = tracer.step(path.probe[++i % 2]);  // the two probes are near each other, so the cell is the same
    keep(foot.depth);
  };
  spline::SurfacePoint E;
  model.patch(0).surface.evaluate2(foot.u, foot.v, E);
  const spline::TableCell cell = model.patch(0).surface.cellOf(E);
  const auto ask = [&] {
    askFor(cell.coefficients, sizeof(spline::Quad) * static_cast<std::size_t>(cell.size[0] * cell.size[1]));
    askFor(&tracer, sizeof tracer);
  };
  printRow(data.name, "tick", tick);
  printRow(data.name, "that asks for its table at its end", [&] {
    tick();
    ask();
  });
  printRow(data.name, "that asks for its table at its beginning", [&] {
    ask();
    tick();
  });
  printRow(data.name, "whose table is asked for 3 us ahead", tick, [&] {
    ask();
    waitForMemory();
  });
  printRow(data.name, "after a tick at the same place just before", tick,
           [&] { keep(tracer.step(path.probe[i % 2]).depth); });
}

}  // namespace

void printCold() {
  std::printf("\n## Cold caches [ns, the clock's own cost included]\n\n");
  std::printf("Median of %d single calls after so much other memory was touched.\n\n", kColdTicks);
  std::printf("| surface | call | hot | 4 MB later | 128 MB later |\n|---|---|---|---|---|\n");
  for (const auto& data : surfaces()) {
    printEvaluation(data, spline::Form::kTable, "evaluation, table");
    printEvaluation(data, spline::Form::kNet, "evaluation, net");
    printTick(data);
  }
  std::printf(
      "\nA cold tick waits for code and page tables more than for its table. To ask for that at the end of a tick "
      "brings\n"
      "nothing: it is there then, and gone when the next one begins. At the beginning it brings at most a sixth where "
      "the\n"
      "address is at hand, as here; in the tracer, which finds the address in memory as cold, nothing could be "
      "measured.\n"
      "Asked for 3 us ahead it saves a quarter or more, and a tick just before saves nine tenths, but a servo that "
      "sleeps\n"
      "until its deadline has no such time. So the tracer touches nothing ahead; a servo that spins until its "
      "deadline\n"
      "could gain three microseconds.\n\n");
  std::printf("| surface | call | hot | 4 MB later | 128 MB later |\n|---|---|---|---|---|\n");
  printAhead(surfaces().front());
}

}  // namespace hapticd::bench
