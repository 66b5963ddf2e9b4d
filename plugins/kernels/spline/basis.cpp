// SPDX-License-Identifier: MIT
#include "kernels/spline/basis.hpp"

#include <algorithm>

namespace hapticd::spline {

int findSpan(std::span<const double> knots, int degree, double t) noexcept {
  const auto first = knots.begin() + degree;
  const auto last = knots.end() - degree - 1;  // the knot that ends the domain
  auto above = std::upper_bound(first, last, t);
  if (above == last) above = std::lower_bound(first, last, *last);  // skips empty spans at the end
  if (above == first) above = std::upper_bound(first, last, *first);
  return static_cast<int>(above - knots.begin()) - 1;
}

void basisFunctions(std::span<const double> knots, int degree, int span, double t,
                    std::array<double, kMaxDegree + 1>& basis) noexcept {
  const double* local = knots.data() + span;
  basis[0] = 1;
  for (int j = 1; j <= degree; ++j) {
    double saved = 0;
    for (int r = 0; r < j; ++r) {
      const double part = basis[static_cast<std::size_t>(r)] / (local[r + 1] - local[r + 1 - j]);
      basis[static_cast<std::size_t>(r)] = saved + (local[r + 1] - t) * part;
      saved = (t - local[r + 1 - j]) * part;
    }
    basis[static_cast<std::size_t>(j)] = saved;
  }
}

}  // namespace hapticd::spline
