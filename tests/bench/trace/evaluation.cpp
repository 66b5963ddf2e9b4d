// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>

#include "bench.hpp"

namespace hapticd::bench {
namespace {

using spline::Form;
using spline::Instructions;
using spline::Surface;
using spline::SurfacePoint;

constexpr int kEvaluations = 20000;
constexpr int kRounds = 25;

template <int kOrder>
void evaluate(const Surface& surface, double u, double v, SurfacePoint& E) {
  if constexpr (kOrder == 1) {
    surface.evaluate1(u, v, E);
  } else {
    surface.evaluate2(u, v, E);
  }
}

/// Returns the time [ns] of an evaluation that must wait for the one before. The next parameters depend on the last
/// result, but so little that they hardly change.
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

void printRow(const std::string& name, const char* method, const Surface& surface) {
  std::printf("| %s | %s | %.1f | %.1f | %.1f | %.1f | %.1f |\n", name.c_str(), method, latency<1>(surface),
              throughput<1>(surface), latency<2>(surface), throughput<2>(surface),
              static_cast<double>(surface.bytes()) / 1e3);
}

}  // namespace

void printEvaluations() {
  std::printf(
      "\n## One evaluation, hot [ns]\n\nLatency: the next parameters wait for the result. Throughput: they do "
      "not.\n\n");
  std::printf(
      "| surface | form | S, Su, Sv: latency | throughput | and second derivatives: latency | throughput | kB |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (const auto& data : surfaces()) {
    printRow(data.name, "table", Surface(data, Form::kTable));
    printRow(data.name, "table, portable code", Surface(data, Form::kTable, Instructions::kPortable));
    printRow(data.name, "net", Surface(data, Form::kNet));
    printRow(data.name, "net, portable code", Surface(data, Form::kNet, Instructions::kPortable));
  }
}

}  // namespace hapticd::bench
