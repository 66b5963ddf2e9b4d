// Evaluation from control points: Cox-de Boor. See kernel_common.inl for the rules of this file.
namespace {

inline constexpr int kOrders = 16;  // kMaxDegree + 1

/// Values, first and second derivatives of the basis functions of a span.
struct Basis {
  double N[3][kOrders];
};

/// Computes derivatives of the basis functions of degree p. @param parts functions of degree p - 1, divided by their
/// knot differences (Piegl & Tiller 2.7)
inline void difference(int p, const double* parts, double* result) {
  result[0] = -p * parts[0];
  for (int r = 1; r < p; ++r) result[r] = p * (parts[r - 1] - parts[r]);
  result[p] = p * parts[p - 1];
}

/// Computes the basis functions and up to two derivatives (Piegl & Tiller A2.3). kDegree is 0 if the degree is known
/// only at run time.
template <int kDegree, int kOrder>
inline void evaluateBasis(const KnotWindow& window, double t, Basis& basis) {
  const int p = kDegree > 0 ? kDegree : window.degree;
  const double* knots = window.knots;
  const double* reciprocal = window.reciprocals;
  double* N = basis.N[0];
  double last[kOrders], lower[kOrders];  // N_{r,p-1} and N_{r,p-2}, divided by their knot differences
  N[0] = 1;
  if (p == 0) {
    basis.N[1][0] = basis.N[2][0] = 0;
    return;
  }
#pragma GCC unroll 5
  for (int j = 1; j <= p; ++j) {
    double saved = 0;
#pragma GCC unroll 5
    for (int r = 0; r < j; ++r) {
      const double part = N[r] * *reciprocal++;
      N[r] = saved + (knots[r + 1] - t) * part;
      saved = (t - knots[r + 1 - j]) * part;
      if (j == p) last[r] = part;
      if (kOrder > 1 && j == p - 1) lower[r] = part;
    }
    N[j] = saved;
  }
  difference(p, last, basis.N[1]);
  if constexpr (kOrder > 1) {
    if (p == 1) {
      basis.N[2][0] = basis.N[2][1] = 0;
      return;
    }
    double slope[kOrders];  // derivatives of N_{r,p-1}, divided by their knot differences
    difference(p - 1, lower, slope);
    const double* top = window.reciprocals + p * (p - 1) / 2;
    for (int r = 0; r < p; ++r) slope[r] *= top[r];
    difference(p, slope, basis.N[2]);
  }
}

/// Returns the corner of the control net that is used as local origin. Control points enter the sums as differences
/// from this origin, so that no digits are lost far from the model's origin and next to a collapsed side. A collapsed
/// side is the first or the last row, so the nearest corner is on it. The corner is known before the basis functions
/// are computed.
inline const Quad* nearestCorner(const NetWindow& net, int p, int q, double u, double v) {
  const int i = p > 0 && u - net.u.knots[0] > net.u.knots[1] - u ? p : 0;
  const int j = q > 0 && v - net.v.knots[0] > net.v.knots[1] - v ? q : 0;
  return net.points + i * net.stride + j;
}

/// Returns the control point with the largest share in the surface point. It is the local origin for Weights::kSevere:
/// if one weight is larger than all others together, the sums then contain only the other points.
inline const Quad* dominantPoint(const NetWindow& net, int p, int q, const Basis& bu, const Basis& bv) {
  const Quad* best = net.points;
  double most = -1;
  for (int i = 0; i <= p; ++i) {
    for (int j = 0; j <= q; ++j) {
      const Quad* point = net.points + i * net.stride + j;
      const double share = bu.N[0][i] * bv.N[0][j] * point->w;
      best = share > most ? point : best;
      most = share > most ? share : most;
    }
  }
  return best;
}

/// Sums the control points times their basis functions, and the derivatives.
template <int kDegreeU, int kDegreeV, bool kRational, int kOrder>
inline Sums contract(const NetWindow& net, int p, int q, const Basis& bu, const Basis& bv, V4 origin) {
  const V4 zero = splat(0);
  Sums sums{zero, zero, zero, zero, zero, zero};
#pragma GCC unroll 4
  for (int i = 0; i <= (kDegreeU > 0 ? kDegreeU : p); ++i) {
    const Quad* row = net.points + i * net.stride;
    V4 r = zero, rv = zero, rvv = zero;
#pragma GCC unroll 4
    for (int j = 0; j <= (kDegreeV > 0 ? kDegreeV : q); ++j) {
      V4 point = load(row + j) - origin;
      if constexpr (kRational) {
        const double w = point[3];
        point[3] = 1;
        point *= splat(w);
      }
      r += splat(bv.N[0][j]) * point;
      rv += splat(bv.N[1][j]) * point;
      if constexpr (kOrder > 1) rvv += splat(bv.N[2][j]) * point;
    }
    sums.S += splat(bu.N[0][i]) * r;
    sums.Su += splat(bu.N[1][i]) * r;
    sums.Sv += splat(bu.N[0][i]) * rv;
    if constexpr (kOrder > 1) {
      sums.Suu += splat(bu.N[2][i]) * r;
      sums.Suv += splat(bu.N[1][i]) * rv;
      sums.Svv += splat(bu.N[0][i]) * rvv;
    }
  }
  return sums;
}

template <int kDegreeU, int kDegreeV, Weights kWeights, int kOrder>
inline void evaluateNetOf(const NetWindow& net, double u, double v, double* out) {
  constexpr bool kRational = kWeights != Weights::kNone;
  const int p = kDegreeU > 0 ? kDegreeU : net.u.degree, q = kDegreeV > 0 ? kDegreeV : net.v.degree;
  Basis bu, bv;
  evaluateBasis<kDegreeU, kOrder>(net.u, u, bu);
  evaluateBasis<kDegreeV, kOrder>(net.v, v, bv);
  const Quad* at = kWeights == Weights::kSevere ? dominantPoint(net, p, q, bu, bv) : nearestCorner(net, p, q, u, v);
  const V4 origin{at->x, at->y, at->z, 0};
  Sums sums = contract<kDegreeU, kDegreeV, kRational, kOrder>(net, p, q, bu, bv, origin);
  if constexpr (kRational) divideByWeight<kOrder>(sums);
  storeSums<kOrder>(sums, origin, out);
}

/// Evaluates a net. The pairs of degrees that most models use are unrolled.
template <Weights kWeights, int kOrder>
void evaluateNet(const NetWindow& net, double u, double v, double* out) noexcept {
  if (net.u.degree == 3 && net.v.degree == 3) {
    evaluateNetOf<3, 3, kWeights, kOrder>(net, u, v, out);
  } else if (net.u.degree == 2 && net.v.degree == 2) {
    evaluateNetOf<2, 2, kWeights, kOrder>(net, u, v, out);
  } else {
    evaluateNetOf<0, 0, kWeights, kOrder>(net, u, v, out);
  }
}

}  // namespace
