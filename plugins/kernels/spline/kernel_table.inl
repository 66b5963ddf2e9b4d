// Evaluation from power-basis tables. See kernel_common.inl for the rules of this file.
namespace {

inline constexpr int kMaxTableSize = 16;  // kMaxDegree + 1

/// A polynomial and its derivatives (f'' halved), by Horner's rule.
struct Row {
  V4 f, g, h;
};

/// `count` coefficients from coefficient(0) on. The derivatives ride along one step behind the value.
template <int kOrder, class Coefficient>
inline Row horner(int count, double t, Coefficient coefficient) {
  const V4 x = splat(t);
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

/// kSizeU, kSizeV 0: known at run time only.
template <int kSizeU, int kSizeV, bool kRational, int kOrder>
void evaluateTable(const TableCell& cell, double s, double t, double* out) noexcept {
  const int size_u = kSizeU > 0 ? kSizeU : cell.size_u, size_v = kSizeV > 0 ? kSizeV : cell.size_v;
  const Quad* c = cell.data + 1;
  Row rows[kSizeU > 0 ? kSizeU : kMaxTableSize];
#pragma GCC unroll 6
  for (int i = 0; i < size_u; ++i) {
    rows[i] = horner<kOrder>(size_v, t, [=](int j) { return load(c + i * size_v + j); });
  }
  const Row f = horner<kOrder>(size_u, s, [&](int i) { return rows[i].f; });
  const Row g = horner<kOrder - 1>(size_u, s, [&](int i) { return rows[i].g; });
  Sums sums{f.f, f.g, g.f, f.h + f.h, g.g, splat(0)};
  if constexpr (kOrder > 1) {
    const Row h = horner<0>(size_u, s, [&](int i) { return rows[i].h; });
    sums.Svv = h.f + h.f;
  }
  if constexpr (kRational) divideByWeight<kOrder>(sums);
  storeSums<kOrder>(sums, load(cell.data), out);
}

}  // namespace
