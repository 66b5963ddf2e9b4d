// Included after spline/kernel_common.inl, under the same rules, by one translation unit per instruction set. Between
// the probe and the parameters of the next evaluation there is only one division, no square root, and no branch that
// the processor mispredicts. All safety tests run in parallel to that chain, on squares. Dot products with Su, Sv, Suu,
// Suv are computed four at once.
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
  V4 x, y, z;     // coordinates of Su, Sv, Suu, Suv
  V2 G1;          // G11, G12
  double G22;     // NaN if the tangents do not span a plane, so that no test passes
  double shrink;  // 1 / |Su x Sv|
  V2 bend[3];
};

/// Returns the inner products of a with b and of a with c.
inline V2 dots(V4 a, V4 b, V4 c) {
  const V4 ab = a * b, ac = a * c;
  const V4 even = __builtin_shufflevector(ab, ac, 0, 4, 2, 6), odd = __builtin_shufflevector(ab, ac, 1, 5, 3, 7);
  return low(even) + low(odd) + high(even);
}
inline V4 cross(V4 a, V4 b) {
  const V4 zxy = a * __builtin_shufflevector(b, b, 1, 2, 0, 3) - b * __builtin_shufflevector(a, a, 1, 2, 0, 3);
  return __builtin_shufflevector(zxy, zxy, 1, 2, 0, 3);
}

/// Computes the first and second fundamental quantities of an evaluated point.
inline Forms makeForms(const double* E) {
  constexpr double kShear2 = 1e-8;  // least squared sine of the angle between the tangents
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
  const double area2 = F.G1[0] * F.G22 - F.G1[1] * F.G1[1];
  F.shrink = 1 / __builtin_sqrt(area2);  // started early, because it takes long; it is needed last
  const bool regular = area2 > kShear2 * F.G1[0] * F.G22;
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

inline void keep(const Forms& F, WarmStepState& out) {
  store(out.tangents[0], F.x);
  store(out.tangents[1], F.y);
  store(out.tangents[2], F.z);
  store2(out.G, F.G1);
  out.G[2] = F.G22;
  out.shrink = F.shrink;
  for (int i = 0; i < 3; ++i) store2(out.bend[i], F.bend[i]);
}

inline Forms kept(const WarmStepState& in) {
  return {get(in.tangents[0]),
          get(in.tangents[1]),
          get(in.tangents[2]),
          get2(in.G),
          in.G[2],
          in.shrink,
          {get2(in.bend[0]), get2(in.bend[1]), get2(in.bend[2])}};
}

struct Step {
  V2 d;   // step in the parameters
  V2 H1;  // H11, H12 of the Hessian
  double H22;
  double inverse;    // 1 / determinant of the Hessian
  double distance2;  // squared distance from the point to the probe
  double length2;    // squared length of the step in space
  bool good;         // the quadratic model is convex and can be trusted; if false, other members have no meaning
};

/// Returns H^-1 g. @param inverse 1 / determinant of H
inline V2 solve(V2 H1, double H22, double inverse, V2 g) {
  return (g * V2{H22, H1[0]} - swapped(g) * both(H1[1])) * both(inverse);
}

inline double lengthSquared(const Forms& F, V2 d) {
  const V2 dd = d * d;
  return F.G1[0] * dd[0] + F.G22 * dd[1] + 2 * F.G1[1] * (d[0] * d[1]);
}

/// Computes Newton's step for |S - p|^2.
inline Step stepFrom(const double* E, const Forms& F, const double* p) {
  constexpr double kCurvature = 0.05;  // least 1 + depth * curvature; below it, descend() takes over
  const V4 x = splat(E[0]) - splat(p[0]), y = splat(E[1]) - splat(p[1]), z = splat(E[2]) - splat(p[2]);
  const V4 along = x * F.x + y * F.y + z * F.z;
  Step step;
  step.H1 = F.G1 + high(along);
  step.H22 = F.G22 + (x[0] * E[kSvv] + y[0] * E[kSvv + 1] + z[0] * E[kSvv + 2]);
  step.inverse = 1 / (step.H1[0] * step.H22 - step.H1[1] * step.H1[1]);
  step.d = -solve(step.H1, step.H22, step.inverse, low(along));
  step.distance2 = x[0] * x[0] + y[0] * y[0] + z[0] * z[0];
  step.length2 = lengthSquared(F, step.d);
  const V2 K1 = step.H1 - both(kCurvature) * F.G1;
  const double K22 = step.H22 - kCurvature * F.G22;
  step.good = (K1[0] > 0) & (K1[0] * K22 > K1[1] * K1[1]);
  return step;
}

/// Corrects (bends) a step by the second-order part of the gradient at its end. Then the method converges with third
/// order if the probe is near. Returns the squared length of the correction.
inline double bendStep(const Forms& F, Step& step) {
  constexpr double kBend2 = 0.0625;  // largest squared ratio of the correction to the step
  const V2 dd = step.d * step.d;
  const V2 k = F.bend[0] * both(dd[0]) + F.bend[2] * both(dd[1]) + F.bend[1] * both(step.d[0] * step.d[1]);
  const V2 bend = -solve(step.H1, step.H22, step.inverse, k);
  const double bend2 = lengthSquared(F, bend);
  step.d += bend;
  step.good &= bend2 <= kBend2 * step.length2;
  return bend2;
}

/// True if both components are true.
inline bool all(decltype(V2{} < V2{}) mask) {
  return (mask[0] & mask[1]) != 0;
}

inline bool inside(V2 uv, const spline::TableCell& cell) {
  return all((uv > get2(cell.lo)) & (uv < get2(cell.end)));
}

/// Returns 1 / |n|, or 0 if the length of n has changed so much on the way that the end must be evaluated, as toward a
/// cusp. @param near 1 / |n| at a point
/// close by
inline double shrinkTo(V4 n, double near) {
  constexpr double kLittle = 1e-4;  // the error of the series below is less than the cube of this
  constexpr double kMost2 = 2;      // largest squared ratio of the lengths
  const double n2 = dots(n, n, n)[0], e = 1 - n2 * (near * near);
  if (!(e * e < kLittle * kLittle)) [[unlikely]]
    return n2 * (near * near) > 1 / kMost2 && n2 * (near * near) < kMost2 ? 1 / __builtin_sqrt(n2) : 0;
  return near + near * e * (0.5 + 0.375 * e);
}

/// Writes the foot at uv + d, by Taylor expansion about the point. Returns false if the tangents span no plane there.
inline bool finish(const double* E, const double* p, const WarmStepState& state, double shrink, V2 d, V2 uv,
                   double residual2, double* foot) {
  const V4 du = splat(d[0]), dv = splat(d[1]), half = splat(0.5);
  const V4 Su = get(E + kSu), Sv = get(E + kSv), Suv = get(E + kSuv);
  const V4 Su_there = Su + du * get(E + kSuu) + dv * Suv, Sv_there = Sv + du * Suv + dv * get(E + kSvv);
  const V4 S = get(E) + du * half * (Su + Su_there) + dv * half * (Sv + Sv_there);
  const V4 n = cross(Su_there, Sv_there), r = V4{p[0], p[1], p[2], 0} - S;
  const V2 of_r = dots(r, r, n);
  const double to_unit = state.sign * shrinkTo(n, shrink);
  store2(foot, uv);
  store(foot + kOutStride, S);
  store(foot + 2 * kOutStride, n * splat(to_unit));
  double* lengths = foot + 3 * kOutStride;
  lengths[0] = __builtin_sqrt(of_r[0]);
  lengths[1] = __builtin_sqrt(residual2);
  lengths[2] = of_r[1] * to_unit;
  return to_unit != 0;
}

WarmStepResult warmStep(const double* p, double tolerance2, double* uv, double* E, WarmStepState& state,
                        double* foot) noexcept {
  const Forms before = kept(state);
  Step step = stepFrom(E, before, p);
  // The correction takes as long as the step itself, so it is left out if the last ticks did not need it.
  const bool bent = !(step.length2 <= state.calm2);
  const double bend2 = bent ? bendStep(before, step) : 0;
  // The next foot is not farther from the probe than this point, so it is at most twice the distance away from this
  // point.
  step.good &= step.length2 <= 4 * step.distance2;
  const V2 target = get2(uv) + step.d;
  if (!step.good) [[unlikely]]
    return WarmStepResult::kNoStep;
  const spline::TableCell& cell = state.cell;
  const bool here = inside(target, cell);
  if (here & (step.length2 <= tolerance2)) [[unlikely]] {
    const bool regular = finish(E, p, state, state.shrink, step.d, target, step.length2, foot);
    return regular ? WarmStepResult::kSameFoot : WarmStepResult::kNoStep;
  }
  if (here && cell.kernel != nullptr) [[likely]] {
    cell.kernel(cell.coefficients, cell.size[0], cell.size[1], target[0] - cell.origin[0], target[1] - cell.origin[1],
                E);
  } else if (!state.evaluate(state, target[0], target[1], E)) {
    return WarmStepResult::kNoStep;
  }
  const Forms F = makeForms(E);
  const Step next = stepFrom(E, F, p);
  if (!(next.distance2 <= step.distance2)) [[unlikely]]
    return WarmStepResult::kFarther;
  keep(F, state);
  store2(uv, target);
  const V2 there = target + next.d;
  // Newton's method squares the error, so the ratio of the last two steps shows how much of the error remains: about
  // length * (length / last length)^2 of the part that grows with the probe's distance, and about last correction *
  // (length / last length)^2 of the rest. Together these may be a tenth of the tolerance.
  const double now = next.length2, last = step.length2, enough = tolerance2;
  const double missed = bent ? bend2 : now;
  state.calm2 = 100 * missed * missed * missed <= enough * last * last ? 4 * last : 0;
  // If the last step led into a pole, where a tangent vanishes, the two lengths cannot be compared.
  constexpr double kAlike2 = 16;  // largest ratio of the squared tangents before and after the step
  const bool alike = (kAlike2 * F.G1[0] > before.G1[0]) & (kAlike2 * F.G22 > before.G22);
  const bool converged =
      (now <= enough) | (alike & (now < 0.01 * last) & (100 * (now + bend2) * now * now <= enough * last * last));
  if (!(converged & next.good & inside(there, cell))) return WarmStepResult::kNearer;
  const bool regular = finish(E, p, state, F.shrink, next.d, there, now < enough ? now : enough, foot);
  return regular ? WarmStepResult::kFoot : WarmStepResult::kNearer;
}

void formsOf(const double* E, WarmStepState& forms) noexcept {
  keep(makeForms(E), forms);
}

constexpr WarmStepKernels kWarmStepKernels{formsOf, warmStep};

}  // namespace
