// SPDX-License-Identifier: MIT
/// Measures whether single precision would be faster: the same table evaluation of one bicubic span in double and in
/// float.
#include <Eigen/Dense>
#include <cstdio>

#include "bench.hpp"

#if defined(__x86_64__)
#define HAPTICD_FAST [[gnu::noinline, gnu::target("avx2,fma")]]
#else
#define HAPTICD_FAST [[gnu::noinline]]
#endif

namespace hapticd::bench {
namespace {

constexpr int kSize = 4, kEvaluations = 20000, kRounds = 25;

/// Coefficients (x, y, z, 0) of u^i v^j about an origin in the middle of the span, in the layout of the production
/// table.
template <class T>
struct Span {
  typedef T Vector __attribute__((vector_size(4 * sizeof(T))));
  double origin[2];
  Vector place;
  Vector c[kSize][kSize];
};

template <class T>
struct Point {
  typename Span<T>::Vector S, Su, Sv;
};

template <class T>
HAPTICD_FAST void evaluate(const Span<T>& span, double u, double v, Point<T>& out) {
  using V = typename Span<T>::Vector;
  const T s = static_cast<T>(u - span.origin[0]), t = static_cast<T>(v - span.origin[1]);
  V f[kSize], g[kSize];
#pragma GCC unroll 4
  for (int i = 0; i < kSize; ++i) {
    const auto& c = span.c[i];
    f[i] = ((c[3] * t + c[2]) * t + c[1]) * t + c[0];
    g[i] = (c[3] * (3 * t) + 2 * c[2]) * t + c[1];
  }
  out.S = span.place + (((f[3] * s + f[2]) * s + f[1]) * s + f[0]);
  out.Su = (f[3] * (3 * s) + 2 * f[2]) * s + f[1];
  out.Sv = ((g[3] * s + g[2]) * s + g[1]) * s + g[0];
}

/// Returns the span that contains (u, v). Its coefficients are fitted to points of the surface.
template <class T>
Span<T> spanAt(const spline::Surface& surface, double u, double v) {
  Span<T> span{};
  Eigen::Matrix4d powers[2];
  Eigen::Vector4d at[2];
  const double where[2] = {u, v};
  for (int axis = 0; axis < 2; ++axis) {
    const auto breaks = surface.breaks(axis);
    const auto next = std::upper_bound(breaks.begin(), breaks.end(), where[axis]);
    const double lo = *(next - 1), hi = *next;
    span.origin[axis] = 0.5 * (lo + hi);
    for (int i = 0; i < kSize; ++i) {
      at[axis][i] = lo + (hi - lo) * (i + 0.5) / kSize;
      for (int k = 0; k < kSize; ++k) powers[axis](i, k) = std::pow(at[axis][i] - span.origin[axis], k);
    }
  }
  spline::SurfacePoint E;
  surface.evaluate1(span.origin[0], span.origin[1], E);
  const Eigen::Vector3d place = E.S;
  for (int k = 0; k < 3; ++k) {
    Eigen::Matrix4d values;
    for (int i = 0; i < kSize; ++i)
      for (int j = 0; j < kSize; ++j) {
        surface.evaluate1(at[0][i], at[1][j], E);
        values(i, j) = E.S[k] - place[k];
      }
    const Eigen::Matrix4d c = powers[0].inverse() * values * powers[1].inverse().transpose();
    for (int i = 0; i < kSize; ++i)
      for (int j = 0; j < kSize; ++j) span.c[i][j][k] = static_cast<T>(c(i, j));
    span.place[k] = static_cast<T>(place[k]);
  }
  return span;
}

template <class T>
void printRow(const spline::Surface& surface, const char* name) {
  const double u0 = 0.31, v0 = 0.42;
  const Span<T> span = spanAt<T>(surface, u0, v0);
  Point<T> out{};
  double latency = HUGE_VAL, throughput = HUGE_VAL, error = 0;
  for (int round = 0; round < kRounds; ++round) {
    double u = u0, v = v0;
    latency = std::min(latency, nanoseconds(kEvaluations, [&] {
                         for (int i = 0; i < kEvaluations; ++i) {
                           evaluate(span, u, v, out);
                           u = u0 + 1e-12 * static_cast<double>(out.Su[1]);
                           v = v0 + 1e-12 * static_cast<double>(out.S[2]);
                         }
                       }));
    keep(u + v);
    throughput = std::min(throughput, nanoseconds(kEvaluations, [&] {
                            for (int i = 0; i < kEvaluations; ++i) {
                              evaluate(span, u0 + 1e-7 * i, v0 - 1e-7 * i, out);
                              keep(out.S[0]);
                            }
                          }));
  }
  spline::SurfacePoint E;
  for (int i = 0; i < 100; ++i) {
    const double u = u0 + 1e-3 * i, v = v0 - 1e-3 * i;
    evaluate(span, u, v, out);
    surface.evaluate1(u, v, E);
    for (int k = 0; k < 3; ++k) error = std::max(error, std::abs(static_cast<double>(out.S[k]) - E.S[k]));
  }
  std::printf("| %s | %.1f | %.1f | %zu | %.1e |\n", name, latency, throughput, sizeof span.c, 1e3 * error);
}

}  // namespace

void printFloat() {
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return;
#endif
  std::printf(
      "\n## Single precision [ns]\n\nS, Su, Sv of one bicubic span, nothing looked up: the same code in both "
      "precisions. "
      "A probe is double, and\ncontact to 1 nm needs more digits than a float has, so the kernels have no such "
      "form.\n\n");
  std::printf("| | latency | throughput | bytes a span | error mm |\n|---|---|---|---|---|\n");
  const spline::Surface surface(surfaces()[0]);
  printRow<double>(surface, "double");
  printRow<float>(surface, "float");
}

}  // namespace hapticd::bench
