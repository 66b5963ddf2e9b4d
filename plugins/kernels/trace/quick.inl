// Included after spline/kernel_common.inl, and under its rules, by one translation unit an instruction set.
// No branch, no root and one division stand between a probe and the parameters to evaluate at; all tests of safety run
// beside that chain, on squares. Dot products with Su, Sv, Suu, Suv come four at once.
namespace {

typedef double V2 __attribute__((vector_size(16)));
typedef double AnywhereV2 __attribute__((vector_size(16), aligned(8), may_alias));
typedef double AnywhereV4 __attribute__((vector_size(32), aligned(8), may_alias));

constexpr int kSu = kOutStride, kSv = 2 * kOutStride, kSuu = 3 * kOutStride, kSuv = 4 * kOutStride,
              kSvv = 5 * kOutStride;

inline V4 get(const double* a) {
  return *reinterpret_cast<const AnywhereV4*>(a);
}
inline V2 get2(const double* a) {
  return *reinterpret_cast<const AnywhereV2*>(a);
}
inline void store2(double* out, V2 a) {
  *reinterpret_cast<AnywhereV2*>(out) = a;
}
inline V2 both(double a) {
  return V2{a, a};
}
inline V2 low(V4 a) {
  return __builtin_shufflevector(a, a, 0, 1);
}
inline V2 high(V4 a) {
  return __builtin_shufflevector(a, a, 2, 3);
}
inline V2 swapped(V2 a) {
  return __builtin_shufflevector(a, a, 1, 0);
}

struct Forms {
  V4 x, y, z;  // of Su, Sv, Suu, Suv
  V2 G1;       // G11, G12
  double G22;  // not-a-number where the tangents span no plane: then no test passes
  V2 bend[3];
};

/// First and second fundamental quantities of an evaluated point.
inline Forms makeForms(const double* E) {
  constexpr double kShear2 = 1e-8;  // least squared sine of the angle of the tangents
  const V4 Su = get(E + kSu), Sv = get(E + kSv), Suu = get(E + kSuu), Suv = get(E + kSuv);
  const V4 xz = __builtin_shufflevector(Su, Sv, 0, 4, 2, 6), y = __builtin_shufflevector(Su, Sv, 1, 5, 3, 7);
  const V4 xz2 = __builtin_shufflevector(Suu, Suv, 0, 4, 2, 6), y2 = __builtin_shufflevector(Suu, Suv, 1, 5, 3, 7);
  Forms F;
  F.x = __builtin_shufflevector(xz, xz2, 0, 1, 4, 5);
  F.y = __builtin_shufflevector(y, y2, 0, 1, 4, 5);
  F.z = __builtin_shufflevector(xz, xz2, 2, 3, 6, 7);
  const V4 along_u = splat(E[kSu]) * F.x + splat(E[kSu + 1]) * F.y + splat(E[kSu + 2]) * F.z;
  const V4 along_v = splat(E[kSv]) * F.x + splat(E[kSv + 1]) * F.y + splat(E[kSv + 2]) * F.z;
  const V2 vv = both(E[kSvv]) * low(F.x) + both(E[kSvv + 1]) * low(F.y) + both(E[kSvv + 2]) * low(F.z);
  F.G1 = low(along_u);
  F.G22 = along_v[1];
  const bool regular = F.G1[0] * F.G22 - F.G1[1] * F.G1[1] > kShear2 * F.G1[0] * F.G22;
  if (!regular) [[unlikely]]
    F.G22 = __builtin_nan("");
  // The second-order part of (S(d) - p) . (Su(d), Sv(d)) on the quadratic surface about this point:
  // du^2 (3/2 a0, a1 + b0/2) + du dv (2 a1 + b0, 2 b1 + c1) + dv^2 (b1 + c0/2, 3/2 c1).
  const double a0 = along_u[2], a1 = along_u[3], b0 = along_v[2], b1 = along_v[3];  // Su, Sv on Suu, Suv
  F.bend[0] = V2{1.5 * a0, a1 + 0.5 * b0};
  F.bend[1] = 2 * V2{a1, b1} + V2{b0, vv[0]};
  F.bend[2] = V2{0.5, 1.5} * vv + V2{b1, 0};
  return F;
}

inline void keep(const Forms& F, QuickForms& out) {
  store(out.tangents[0], F.x);
  store(out.tangents[1], F.y);
  store(out.tangents[2], F.z);
  store2(out.G, F.G1);
  out.G[2] = F.G22;
  for (int i = 0; i < 3; ++i) store2(out.bend[i], F.bend[i]);
}

inline Forms kept(const QuickForms& in) {
  return {get(in.tangents[0]),
          get(in.tangents[1]),
          get(in.tangents[2]),
          get2(in.G),
          in.G[2],
          {get2(in.bend[0]), get2(in.bend[1]), get2(in.bend[2])}};
}

struct Step {
  V2 d;              // in the parameters
  double distance2;  // from the point to the probe
  double length2;    // of the step in space, unbent
  double bend2;      // of its bend
  bool good;         // the quadratic model is convex and to be trusted so far; if not, the rest may be anything
};

/// Newton's step on |S - p|^2. Bent by what the second derivatives say of the gradient at its end, it converges with
/// third order where the probe is near; the inverse of the Hessian serves twice.
template <bool kBent>
inline Step stepFrom(const double* E, const Forms& F, const double* p) {
  constexpr double kCurvature = 0.05;  // least 1 + depth * curvature: nearer to a centre of curvature, others decide
  constexpr double kBend2 = 0.0625;    // greatest share of the bend in the step, squared
  const V4 x = splat(E[0]) - splat(p[0]), y = splat(E[1]) - splat(p[1]), z = splat(E[2]) - splat(p[2]);
  const V4 along = x * F.x + y * F.y + z * F.z;
  const V2 g = low(along);
  const V2 H1 = F.G1 + high(along);
  const double H22 = F.G22 + (x[0] * E[kSvv] + y[0] * E[kSvv + 1] + z[0] * E[kSvv + 2]);
  const V2 inverse = both(1 / (H1[0] * H22 - H1[1] * H1[1]));
  const V2 diagonal = {H22, H1[0]}, across = both(H1[1]);
  Step step;
  step.d = (swapped(g) * across - g * diagonal) * inverse;
  const V2 dd = step.d * step.d;
  const double d12 = step.d[0] * step.d[1], G12 = F.G1[1];
  step.distance2 = x[0] * x[0] + y[0] * y[0] + z[0] * z[0];
  step.length2 = F.G1[0] * dd[0] + F.G22 * dd[1] + 2 * G12 * d12;
  const V2 K1 = H1 - both(kCurvature) * F.G1;
  const double K22 = H22 - kCurvature * F.G22;
  step.good = (K1[0] > 0) & (K1[0] * K22 > K1[1] * K1[1]);
  if constexpr (kBent) {
    const V2 k = F.bend[0] * both(dd[0]) + F.bend[2] * both(dd[1]) + F.bend[1] * both(d12);
    const V2 bend = (swapped(k) * across - k * diagonal) * inverse;
    step.bend2 = F.G1[0] * bend[0] * bend[0] + 2 * G12 * bend[0] * bend[1] + F.G22 * bend[1] * bend[1];
    step.d += bend;
    // The next foot is no farther from the probe than this one, so it is at most twice the distance away.
    step.good &= (step.bend2 <= kBend2 * step.length2) & (step.length2 <= 4 * step.distance2);
  }
  return step;
}

/// Whether both components are true.
inline bool all(decltype(V2{} < V2{}) mask) {
  return (mask[0] & mask[1]) != 0;
}

inline bool inside(V2 uv, const QuickTask& task) {
  return all((uv > get2(task.lo)) & (uv < get2(task.hi)));
}

/// The foot at uv + d by Taylor expansion about the point.
inline void finish(const double* E, const double* p, V2 d, V2 uv, double residual2, const QuickFoot& foot) {
  const V4 du = splat(d[0]), dv = splat(d[1]), half = splat(0.5);
  const V4 Su = get(E + kSu), Sv = get(E + kSv), Suv = get(E + kSuv);
  const V4 Su_there = Su + du * get(E + kSuu) + dv * Suv, Sv_there = Sv + du * Suv + dv * get(E + kSvv);
  const V4 S = get(E) + du * half * (Su + Su_there) + dv * half * (Sv + Sv_there);
  store2(foot.uv, uv);
  store(foot.S, S);
  store(foot.S + kSu, Su_there);
  store(foot.S + kSv, Sv_there);
  const double x = S[0] - p[0], y = S[1] - p[1], z = S[2] - p[2];
  foot.distance[0] = __builtin_sqrt(x * x + y * y + z * z);
  foot.distance[1] = __builtin_sqrt(residual2);
}

QuickResult quickFoot(const QuickTask& task, const QuickPoint& at, const QuickFoot& foot) noexcept {
  double* E = at.E;
  const Step step = stepFrom<true>(E, kept(*at.forms), task.p);
  const V2 uv = get2(at.uv) + step.d;
  if (!(step.good & inside(uv, task))) return QuickResult::kNoStep;
  if (step.length2 <= task.tolerance2) {
    finish(E, task.p, step.d, uv, step.length2, foot);
    return QuickResult::kSameFoot;
  }
  task.evaluate(task.patch, uv[0], uv[1], E);
  const Forms F = makeForms(E);
  const Step next = stepFrom<false>(E, F, task.p);
  if (!(next.distance2 <= step.distance2)) return QuickResult::kFarther;
  keep(F, *at.forms);
  store2(at.uv, uv);
  const V2 there = uv + next.d;
  // Newton squares the error. After this step, about length * (length / last length)^2 is left of what grows with the
  // distance, and last bend * (length / last length)^2 of the rest. A tenth of the tolerance may be.
  const double now = next.length2, last = step.length2, enough = task.tolerance2;
  const bool converged =
      (now <= enough) | ((now < 0.01 * last) & (100 * (now + step.bend2) * now * now <= enough * last * last));
  if (!(converged & next.good & inside(there, task))) return QuickResult::kNearer;
  finish(E, task.p, next.d, there, now < enough ? now : enough, foot);
  return QuickResult::kFoot;
}

void formsOf(const double* E, QuickForms& forms) noexcept {
  keep(makeForms(E), forms);
}

constexpr QuickKernels kQuickKernels{formsOf, quickFoot};

}  // namespace
