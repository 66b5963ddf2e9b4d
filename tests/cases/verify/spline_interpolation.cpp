// SPDX-License-Identifier: MIT

#include "kernels/spline/basis.hpp"
#include "kernels/spline/interpolation.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

constexpr double kResidual = 1e-12;  ///< relative distance of the curve from the data, as the cases describe it

Eigen::MatrixXd readRows(const Json& rows) {
  Eigen::MatrixXd result(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(rows[0].size()));
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    for (Eigen::Index k = 0; k < result.cols(); ++k) {
      result(i, k) = number(rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)]);
    }
  }
  return result;
}

Eigen::RowVectorXd valueAt(const spline::CurveFit& fit, double t) {
  const int span = spline::findSpan(fit.knots, fit.degree, t);
  std::array<double, spline::kMaxDegree + 1> N;
  spline::basisFunctions(fit.knots, fit.degree, span, t, N);
  Eigen::RowVectorXd value = Eigen::RowVectorXd::Zero(fit.control.cols());
  for (int k = 0; k <= fit.degree; ++k) {
    value += N[static_cast<std::size_t>(k)] * fit.control.row(span - fit.degree + k);
  }
  return value;
}

/// Coordinates of different units: each is compared relative to the largest of its own column.
void splineInterpolation(const Case& c, Check& check) {
  const Eigen::MatrixXd data = readRows(c.input["data"]);
  const spline::CurveFit fit = spline::interpolateCurve(data, c.input["degree"].get<int>());
  const double relative = number(c.tol["rel"]);
  check.isTrue("number of parameters", fit.parameters.size() == c.expect["params"].size());
  check.isTrue("number of knots", fit.knots.size() == c.expect["knots"].size());
  check.nearVector("params", fit.parameters, c.expect["params"], relative);
  check.nearVector("knots", fit.knots, c.expect["knots"], relative);
  const Json& control = c.expect["control"];
  for (Eigen::Index i = 0; i < fit.control.rows(); ++i) {
    const Eigen::RowVectorXd value = valueAt(fit, fit.parameters[static_cast<std::size_t>(i)]);
    for (Eigen::Index k = 0; k < fit.control.cols(); ++k) {
      const double scale = data.col(k).cwiseAbs().maxCoeff();
      check.near("control", fit.control(i, k), control[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)],
                 relative * scale);
      check.near("residual", value[k], data(i, k), kResidual * scale);
    }
  }
}

}  // namespace
HAPTICD_VERIFY(spline_interpolation, splineInterpolation)
}  // namespace hapticd::verify
