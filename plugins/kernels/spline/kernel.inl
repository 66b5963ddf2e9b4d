// Included by one translation unit an instruction set. It must stay free of library headers: an inline function of a
// library, compiled here with AVX2, could be the copy that the linker keeps for everybody.
namespace {

typedef double V4 __attribute__((vector_size(32)));

inline constexpr int kOrders = 16;  // kMaxDegree + 1

inline V4 load(const Quad* q) {
  return *reinterpret_cast<const V4*>(q);
}
inline V4 splat(double a) {
  return V4{a, a, a, a};
}
inline void store3(double* out, V4 a) {
  out[0] = a[0];
  out[1] = a[1];
  out[2] = a[2];
}

/// Values and derivatives of the degree + 1 basis functions of a span.
struct Basis {
  double N[3][kOrders];
};

/// Piegl & Tiller A2.3 for up to two derivatives. `knots` points at the low end of the span.
template <int kOrder>
inline void evaluateBasis(const double* knots, int p, double t, Basis& basis) {
  double* N = basis.N[0];
  double last[kOrders], lower[kOrders] = {};  // N_{r,p-1} and N_{r,p-2}, over their knot differences
  N[0] = 1;
  for (int j = 1; j <= p; ++j) {
    double saved = 0;
    for (int r = 0; r < j; ++r) {
      const double part = N[r] / (knots[r + 1] - knots[r + 1 - j]);
      N[r] = saved + (knots[r + 1] - t) * part;
      saved = (t - knots[r + 1 - j]) * part;
      if (j == p) last[r] = part;
      if (kOrder > 1 && j == p - 1) lower[r] = part;
    }
    N[j] = saved;
  }
  for (int r = 0; r <= p; ++r) {
    basis.N[1][r] = p * ((r > 0 ? last[r - 1] : 0) - (r < p ? last[r] : 0));
  }
  if constexpr (kOrder > 1) {
    double slope[kOrders];  // derivative of N_{r,p-1}, over its knot difference
    for (int r = 0; r < p; ++r) {
      const double rise = (p - 1) * ((r > 0 ? lower[r - 1] : 0) - (r < p - 1 ? lower[r] : 0));
      slope[r] = rise / (knots[r + 1] - knots[r + 1 - p]);
    }
    for (int r = 0; r <= p; ++r) {
      basis.N[2][r] = p * ((r > 0 ? slope[r - 1] : 0) - (r < p ? slope[r] : 0));
    }
  }
}

/// S and derivatives of the numerator (x, y, z) and of the weight (lane 3), about a local origin.
struct Sums {
  V4 S, Su, Sv, Suu, Suv, Svv;
};

/// The control point with the largest share of the surface point. About this origin the numerator keeps all its
/// digits: far from the model's origin, next to a pole, and beside a weight that outweighs all others.
template <bool kRational>
inline V4 dominantPoint(const NetWindow& net, const Basis& bu, const Basis& bv) {
  const Quad* best = net.points;
  double most = -1;
  for (int i = 0; i <= net.degree_u; ++i) {
    for (int j = 0; j <= net.degree_v; ++j) {
      const Quad* q = net.points + i * net.stride + j;
      const double share = bu.N[0][i] * bv.N[0][j] * (kRational ? q->w : 1);
      if (share > most) most = share, best = q;
    }
  }
  return V4{best->x, best->y, best->z, 0};
}

template <bool kRational, int kOrder>
inline Sums contract(const NetWindow& net, const Basis& bu, const Basis& bv, const V4& origin) {
  const V4 zero = splat(0);
  Sums sums{zero, zero, zero, zero, zero, zero};
  for (int i = 0; i <= net.degree_u; ++i) {
    const Quad* row = net.points + i * net.stride;
    V4 r = zero, rv = zero, rvv = zero;
    for (int j = 0; j <= net.degree_v; ++j) {
      V4 q = load(row + j) - origin;
      if (kRational) {
        const double w = q[3];
        q[3] = 1;
        q *= w;
      }
      r += bv.N[0][j] * q;
      rv += bv.N[1][j] * q;
      if (kOrder > 1) rvv += bv.N[2][j] * q;
    }
    sums.S += bu.N[0][i] * r;
    sums.Su += bu.N[1][i] * r;
    sums.Sv += bu.N[0][i] * rv;
    if (kOrder > 1) {
      sums.Suu += bu.N[2][i] * r;
      sums.Suv += bu.N[1][i] * rv;
      sums.Svv += bu.N[0][i] * rvv;
    }
  }
  return sums;
}

/// Piegl & Tiller A4.4 written out: derivatives of the quotient of numerator and weight.
template <int kOrder>
inline void divideByWeight(Sums& a) {
  const V4 reciprocal = splat(1 / a.S[3]);
  const double wu = a.Su[3], wv = a.Sv[3];
  a.S *= reciprocal;
  a.Su = (a.Su - wu * a.S) * reciprocal;
  a.Sv = (a.Sv - wv * a.S) * reciprocal;
  if constexpr (kOrder > 1) {
    const double wuu = a.Suu[3], wuv = a.Suv[3], wvv = a.Svv[3];
    a.Suu = (a.Suu - 2 * wu * a.Su - wuu * a.S) * reciprocal;
    a.Suv = (a.Suv - wu * a.Sv - wv * a.Su - wuv * a.S) * reciprocal;
    a.Svv = (a.Svv - 2 * wv * a.Sv - wvv * a.S) * reciprocal;
  }
}

template <int kOrder>
inline void storeSums(const Sums& a, const V4& origin, double* out) {
  store3(out, a.S + origin);
  store3(out + 3, a.Su);
  store3(out + 6, a.Sv);
  if constexpr (kOrder > 1) {
    store3(out + 9, a.Suu);
    store3(out + 12, a.Suv);
    store3(out + 15, a.Svv);
  }
}

template <bool kRational, int kOrder>
void evaluateNet(const NetWindow& net, double u, double v, double* out) noexcept {
  Basis bu, bv;
  evaluateBasis<kOrder>(net.knots_u, net.degree_u, u, bu);
  evaluateBasis<kOrder>(net.knots_v, net.degree_v, v, bv);
  const V4 origin = dominantPoint<kRational>(net, bu, bv);
  Sums sums = contract<kRational, kOrder>(net, bu, bv, origin);
  if constexpr (kRational) divideByWeight<kOrder>(sums);
  storeSums<kOrder>(sums, origin, out);
}

constexpr KernelSet kKernels = {
    {{evaluateNet<false, 1>, evaluateNet<false, 2>}, {evaluateNet<true, 1>, evaluateNet<true, 2>}}};

}  // namespace
