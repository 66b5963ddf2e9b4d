// SPDX-License-Identifier: MIT
/// Linear systems of a few unknowns whose matrix is symmetric and positive definite, such as mass matrices.
#pragma once
#include <Eigen/Core>
#include <cmath>

namespace hapticd::dynamics {

/// [rt] Returns x with A x = b, by the Cholesky factorisation A = L L^T (Golub & Van Loan 2013, algorithm 4.2.1). Only
/// the lower triangle of A is read. If A is not positive definite, x has components that are not finite. The result has
/// the bits of Eigen's LLT. This spares the compiler LLT's code for large matrices, which took it longer than the rest
/// of the file.
template <int N>
Eigen::Matrix<double, N, 1> solvePositiveDefinite(Eigen::Matrix<double, N, N> A,
                                                  Eigen::Matrix<double, N, 1> b) noexcept {
  for (int k = 0; k < N; ++k)  // column k of L takes the place of column k of A
    for (int i = k; i < N; ++i) {
      double known = 0;
      for (int j = 0; j < k; ++j) known += A(i, j) * A(k, j);
      A(i, k) -= known;
      A(i, k) = i == k ? std::sqrt(A(k, k)) : A(i, k) / A(k, k);
    }
  A.template triangularView<Eigen::Lower>().solveInPlace(b);
  A.transpose().template triangularView<Eigen::Upper>().solveInPlace(b);
  return b;
}

}  // namespace hapticd::dynamics
