// Evaluation from power-basis tables. See kernel_common.inl for the rules of this file.
namespace {

inline constexpr int kMaxTableSize = 16;  // kMaxDegree + 1

/// A polynomial f and its derivatives g = f' and h = f'' / 2.
struct Row {
  V4 f, g, h;
};

/// The powers of a parameter that a cubic and its derivatives need.
struct Powers {
  V4 x, xx, twice_x, thrice_x, thrice_xx;
  explicit Powers(double t) : x(splat(t)), xx(x * x), twice_x(x + x), thrice_x(twice_x + x), thrice_xx(thrice_x * x) {}
};

/// Applies Horner's rule to `count` coefficients, of which coefficient(0) is the constant one. The
/// same loop computes the derivatives, one step behind.
template <int kOrder, class Coefficient>
inline Row horner(int count, V4 x, Coefficient coefficient) {
  Row row{coefficient(count - 1), splat(0), splat(0)};
#pragma GCC unroll 6
  for (int k = count - 2; k >= 0; --k) {
    const bool first = k == count - 2, second = k == count - 3;
    if constexpr (kOrder > 1) {
      if (second) row.h = row.g;
      if (!first && !second) row.h = row.h * x + row.g;
    }
    if constexpr (kOrder > 0) row.g = first ? row.f : row.g * x + row.f;
    row.f = row.f * x + coefficient(k);
  }
  return row;
}

/// Evaluates a cubic with as many multiplications as Horner's rule, but a dependency chain of only two thirds of the
/// length. It is used for the last step, which the processor cannot overlap with other work. (The rows before are
/// evaluated four at once; there it would only cost registers.)
template <int kOrder, class Coefficient>
inline Row cubic(const Powers& t, Coefficient coefficient) {
  const V4 a = coefficient(0), b = coefficient(1), c = coefficient(2), d = coefficient(3);
  Row row{(a + t.x * b) + t.xx * (c + t.x * d), splat(0), splat(0)};
  if constexpr (kOrder > 0) row.g = (b + t.twice_x * c) + t.thrice_xx * d;
  if constexpr (kOrder > 1) row.h = c + t.thrice_x * d;
  return row;
}

/// Evaluates a polynomial. Here and below, kSize is 0 if the size is known only at run time.
template <int kSize, int kOrder, class Coefficient>
inline Row polynomial(int size, const Powers& t, Coefficient coefficient) {
  if constexpr (kSize == 4) return cubic<kOrder>(t, coefficient);
  return horner<kOrder>(kSize > 0 ? kSize : size, t.x, coefficient);
}

/// Evaluates a curve: nothing depends on v.
template <int kSize, bool kRational, int kOrder>
inline void evaluateCurve(const double* cell, double s, double* out) noexcept {
  constexpr int kStride = tableStride(kRational);
  const double* c = cell + kStride;
  const Row f = polynomial<kSize, kOrder>(kSize, Powers(s), [=](int i) { return load(c + i * kStride); });
  Sums sums{f.f, f.g, splat(0), f.h + f.h, splat(0), splat(0)};
  if constexpr (kRational) divideByWeight<kOrder>(sums);
  storeSums<kOrder>(sums, load(cell), out);
}

template <int kSizeU, int kSizeV, bool kRational, int kOrder>
void evaluateTable(const double* cell, int run_size_u, int run_size_v, double s, double t, double* out) noexcept {
  if constexpr (kSizeV == 1) return evaluateCurve<kSizeU, kRational, kOrder>(cell, s, out);
  const int size_u = kSizeU > 0 ? kSizeU : run_size_u, size_v = kSizeV > 0 ? kSizeV : run_size_v;
  constexpr int kStride = tableStride(kRational);
  const double* c = cell + kStride;
  const Powers powers(s);
  const V4 x = splat(t);
  Row rows[kSizeU > 0 ? kSizeU : kMaxTableSize];
#pragma GCC unroll 6
  for (int i = 0; i < size_u; ++i) {
    rows[i] = horner<kOrder>(size_v, x, [=](int j) { return load(c + (i * size_v + j) * kStride); });
  }
  const Row f = polynomial<kSizeU, kOrder>(size_u, powers, [&](int i) { return rows[i].f; });
  const Row g = polynomial<kSizeU, kOrder - 1>(size_u, powers, [&](int i) { return rows[i].g; });
  Sums sums{f.f, f.g, g.f, f.h + f.h, g.g, splat(0)};
  if constexpr (kOrder > 1) {
    const Row h = polynomial<kSizeU, 0>(size_u, powers, [&](int i) { return rows[i].h; });
    sums.Svv = h.f + h.f;
  }
  if constexpr (kRational) divideByWeight<kOrder>(sums);
  storeSums<kOrder>(sums, load(cell), out);
}

}  // namespace
