// SPDX-License-Identifier: MIT
#include "kernels/medial/influence.hpp"

#include <algorithm>

namespace hapticd::medial {

Influence influence(std::span<const double> basis, int span, int p_prime, PointSelection choice) noexcept {
  const int degree = static_cast<int>(basis.size()) - 1;
  const int count = std::clamp(p_prime, 1, degree + 1);
  const auto squares = [&](int start) {
    double sum = 0;
    for (int i = start; i < start + count; ++i)
      sum += basis[static_cast<std::size_t>(i)] * basis[static_cast<std::size_t>(i)];
    return sum;
  };
  int start = (degree + 1 - count) / 2;
  double sum = squares(start);
  for (int s = 0; choice == PointSelection::kLargest && s + count <= degree + 1; ++s) {
    if (squares(s) > sum) {
      start = s;
      sum = squares(s);
    }
  }
  Influence result;
  result.first = span - degree + start;
  result.count = count;
  for (int i = 0; i < count; ++i) {
    const double b = basis[static_cast<std::size_t>(start + i)];
    result.basis[static_cast<std::size_t>(i)] = b;
    result.alpha[static_cast<std::size_t>(i)] = sum > 0 ? b / sum : 0;
  }
  return result;
}

}  // namespace hapticd::medial
