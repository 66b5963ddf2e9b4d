// Included, inside a namespace, by one translation unit an instruction set. Must stay free of library headers: an
// inline function of a library, compiled here with AVX2, could be the copy that the linker keeps for everybody.
namespace {

typedef double V4 __attribute__((vector_size(32)));

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

/// S and derivatives of the numerator (x, y, z) and of the weight (lane 3), about a local origin.
struct Sums {
  V4 S, Su, Sv, Suu, Suv, Svv;
};

/// Piegl & Tiller A4.4 written out: derivatives of the quotient of numerator and weight.
template <int kOrder>
inline void divideByWeight(Sums& a) {
  const V4 reciprocal = splat(1 / a.S[3]);
  const V4 wu = splat(a.Su[3]), wv = splat(a.Sv[3]);
  const V4 wuu = splat(a.Suu[3]), wuv = splat(a.Suv[3]), wvv = splat(a.Svv[3]);
  a.S *= reciprocal;
  a.Su = (a.Su - wu * a.S) * reciprocal;
  a.Sv = (a.Sv - wv * a.S) * reciprocal;
  if constexpr (kOrder > 1) {
    a.Suu = (a.Suu - 2 * wu * a.Su - wuu * a.S) * reciprocal;
    a.Suv = (a.Suv - wu * a.Sv - wv * a.Su - wuv * a.S) * reciprocal;
    a.Svv = (a.Svv - 2 * wv * a.Sv - wvv * a.S) * reciprocal;
  }
}

template <int kOrder>
inline void storeSums(const Sums& a, V4 origin, double* out) {
  store3(out, a.S + origin);
  store3(out + 3, a.Su);
  store3(out + 6, a.Sv);
  if constexpr (kOrder > 1) {
    store3(out + 9, a.Suu);
    store3(out + 12, a.Suv);
    store3(out + 15, a.Svv);
  }
}

}  // namespace
