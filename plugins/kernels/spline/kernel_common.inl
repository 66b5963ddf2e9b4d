// Included inside a namespace by one translation unit per instruction set. It must not include library headers: the
// linker might keep an inline library function that was compiled here with AVX2, and use it on processors without AVX2.
namespace {

typedef double V4 __attribute__((vector_size(32)));

inline V4 load(const Quad* q) {
  return *reinterpret_cast<const V4*>(q);
}
/// Loads four doubles from an address of any alignment of doubles.
inline V4 load(const double* from) {
  typedef double Anywhere __attribute__((vector_size(32), aligned(8), may_alias));
  return *reinterpret_cast<const Anywhere*>(from);
}
inline V4 splat(double a) {
  return V4{a, a, a, a};
}
/// Stores to an address of any alignment of doubles.
inline void store(double* out, V4 a) {
  typedef double Anywhere __attribute__((vector_size(32), aligned(8), may_alias));
  *reinterpret_cast<Anywhere*>(out) = a;
}

/// S and its derivatives before the division by the weight: numerator (x, y, z) and weight (lane 3), relative to a
/// local origin.
struct Sums {
  V4 S, Su, Sv, Suu, Suv, Svv;
};

/// Computes the derivatives of the quotient of numerator and weight (Piegl & Tiller A4.4, written out). One division
/// gives the reciprocal of the weight; all other steps are multiplications.
template <int kOrder>
inline void divideByWeight(Sums& a) {
  const V4 reciprocal = splat(1 / a.S[3]);
  const V4 wu = splat(a.Su[3]) * reciprocal, wv = splat(a.Sv[3]) * reciprocal;
  a.S *= reciprocal;
  a.Su = a.Su * reciprocal - wu * a.S;
  a.Sv = a.Sv * reciprocal - wv * a.S;
  if constexpr (kOrder > 1) {
    const V4 wuu = splat(a.Suu[3]) * reciprocal, wuv = splat(a.Suv[3]) * reciprocal, wvv = splat(a.Svv[3]) * reciprocal;
    a.Suu = a.Suu * reciprocal - 2 * wu * a.Su - wuu * a.S;
    a.Suv = a.Suv * reciprocal - wu * a.Sv - wv * a.Su - wuv * a.S;
    a.Svv = a.Svv * reciprocal - 2 * wv * a.Sv - wvv * a.S;
  }
}

template <int kOrder>
inline void storeSums(const Sums& a, V4 origin, double* out) {
  store(out, a.S + origin);
  store(out + kOutStride, a.Su);
  store(out + 2 * kOutStride, a.Sv);
  if constexpr (kOrder > 1) {
    store(out + 3 * kOutStride, a.Suu);
    store(out + 4 * kOutStride, a.Suv);
    store(out + 5 * kOutStride, a.Svv);
  }
}

}  // namespace
