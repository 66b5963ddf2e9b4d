#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "bench.hpp"

namespace hapticd::bench {
namespace {

using spline::Form;
using spline::Instructions;
using spline::Surface;
using spline::SurfacePoint;

constexpr int kEvaluations = 20000;
constexpr int kRounds = 25;
constexpr int kColdTicks = 60;
constexpr std::size_t kBeyondL2 = 4u << 20, kBeyondL3 = 128u << 20;  // [bytes]

template <int kOrder>
void evaluate(const Surface& surface, double u, double v, SurfacePoint& E) {
  if constexpr (kOrder == 1) {
    surface.evaluate1(u, v, E);
  } else {
    surface.evaluate2(u, v, E);
  }
}

/// The next parameters depend on the last result, too little to leave the neighbourhood.
template <int kOrder>
double latency(const Surface& surface) {
  double best = HUGE_VAL;
  for (int round = 0; round < kRounds; ++round) {
    SurfacePoint E;
    double u = 0.31, v = 0.42;
    best = std::min(best, nanoseconds(kEvaluations, [&] {
                      for (int i = 0; i < kEvaluations; ++i) {
                        evaluate<kOrder>(surface, u, v, E);
                        u = 0.31 + 1e-12 * E.Su[1];
                        v = 0.42 + 1e-12 * E.S[2];
                      }
                    }));
    keep(u + v);
  }
  return best;
}

template <int kOrder>
double throughput(const Surface& surface) {
  double best = HUGE_VAL;
  for (int round = 0; round < kRounds; ++round) {
    SurfacePoint E;
    best = std::min(best, nanoseconds(kEvaluations, [&] {
                      for (int i = 0; i < kEvaluations; ++i) {
                        evaluate<kOrder>(surface, 0.31 + 1e-7 * i, 0.42 - 1e-7 * i, E);
                        keep(E.S[0]);
                      }
                    }));
  }
  return best;
}

/// Median of single evaluations after `bytes` of other memory went through the caches; with `prefetch`, the surface is
/// asked for ahead of time, as a servo loop can while it waits.
double cold(const Surface& surface, std::size_t bytes, bool prefetch) {
  std::vector<char> other(bytes, 1);
  std::vector<double> times;
  SurfacePoint E;
  surface.evaluate1(0.31, 0.42, E);
  for (int tick = 0; tick < kColdTicks; ++tick) {
    for (std::size_t i = 0; i < bytes; i += 64) other[i] = static_cast<char>(other[i] + 1);
    keep(other.data());
    if (prefetch) {
      surface.prefetch(E);
      for (int wait = 0; wait < 2000; ++wait) keep(wait);
    }
    times.push_back(nanoseconds(1, [&] {
      surface.evaluate1(0.31, 0.42, E);
      keep(E.S[0]);
    }));
  }
  std::nth_element(times.begin(), times.begin() + kColdTicks / 2, times.end());
  return times[kColdTicks / 2];
}

void printRow(const char* method, const Surface& surface) {
  std::printf("  %-22s %6.1f %6.1f   %6.1f %6.1f   %9zu\n", method, latency<1>(surface), throughput<1>(surface),
              latency<2>(surface), throughput<2>(surface), surface.bytes());
}

}  // namespace

void printEvaluations() {
  std::printf("One evaluation [ns], hot        first order     second order\n");
  std::printf("  %-22s %6s %6s   %6s %6s   %9s\n", "", "lat", "thr", "lat", "thr", "bytes");
  for (const auto& data : surfaces()) {
    std::printf("%s\n", data.name.c_str());
    printRow("table", Surface(data, Form::kTable));
    printRow("table, portable", Surface(data, Form::kTable, Instructions::kPortable));
    printRow("net", Surface(data, Form::kNet));
    printRow("net, portable", Surface(data, Form::kNet, Instructions::kPortable));
  }
  std::printf("\nOne evaluation [ns, clock read included], cold: median of %d\n", kColdTicks);
  std::printf("  %-16s %-6s %8s %12s %12s %18s\n", "", "", "hot", "4 MB later", "128 MB later", "same, prefetched");
  for (const auto& data : surfaces()) {
    for (Form form : {Form::kTable, Form::kNet}) {
      const Surface surface(data, form);
      std::printf("  %-16s %-6s %8.0f %12.0f %12.0f %18.0f\n", data.name.c_str(),
                  form == Form::kTable ? "table" : "net", cold(surface, 0, false), cold(surface, kBeyondL2, false),
                  cold(surface, kBeyondL3, false), cold(surface, kBeyondL3, true));
    }
  }
}

}  // namespace hapticd::bench
