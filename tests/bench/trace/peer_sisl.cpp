// SPDX-License-Identifier: MIT
// The solver of SISL, as Debian packages it. Lengths are in millimetres, as its tolerances expect.
#include <sisl.h>

#include "bench.hpp"

namespace hapticd::bench {
namespace {

constexpr double kMillimetre = 1e3;
constexpr double kTolerance = 1e-9;  // [mm]
constexpr int kPolynomial = 1, kRational = 2;

class Sisl : public Solver {
 public:
  explicit Sisl(const spline::SurfaceData& data) {
    const int count_u = data.count(0), count_v = data.count(1);
    std::vector<double> coefficients;  // u runs fastest; homogeneous if the surface is rational
    for (int j = 0; j < count_v; ++j) {
      for (int i = 0; i < count_u; ++i) {
        const auto at = static_cast<std::size_t>(i * count_v + j);
        const double w = data.weights.empty() ? 1 : data.weights[at];
        for (int c = 0; c < 3; ++c) coefficients.push_back(w * kMillimetre * data.points[at][c]);
        if (!data.weights.empty()) coefficients.push_back(w);
      }
    }
    auto knots = data.knots;
    constexpr int kCopy = 1;
    surface_ = newSurf(count_u, count_v, data.degree[0] + 1, data.degree[1] + 1, knots[0].data(), knots[1].data(),
                       coefficients.data(), data.weights.empty() ? kPolynomial : kRational, 3, kCopy);
    low_ = {data.domain(0)[0], data.domain(1)[0]};
    high_ = {data.domain(0)[1], data.domain(1)[1]};
  }
  ~Sisl() override { freeSurf(surface_); }
  Sisl(const Sisl&) = delete;
  Sisl& operator=(const Sisl&) = delete;
  std::string name() const override { return "SISL s1775"; }
  void start(double u, double v) override { uv_ = {u, v}; }
  Eigen::Vector3d step(const Eigen::Vector3d& probe) override {
    Eigen::Vector3d point = kMillimetre * probe;
    std::array<double, 2> found{};
    int status = 0, left_u = 0, left_v = 0;
    s1775(surface_, point.data(), 3, kTolerance, low_.data(), high_.data(), uv_.data(), found.data(), &status);
    if (status < 0) return Eigen::Vector3d::Constant(NAN);
    uv_ = found;
    std::array<double, 12> derivatives{}, normal{};
    s1421(surface_, 0, uv_.data(), &left_u, &left_v, derivatives.data(), normal.data(), &status);
    return Eigen::Vector3d(derivatives[0], derivatives[1], derivatives[2]) / kMillimetre;
  }

 private:
  SISLSurf* surface_ = nullptr;
  std::array<double, 2> low_{}, high_{}, uv_{};
};

}  // namespace

std::vector<std::unique_ptr<Solver>> sislSolvers(const spline::SurfaceData& data) {
  std::vector<std::unique_ptr<Solver>> solvers;
  solvers.push_back(std::make_unique<Sisl>(data));
  return solvers;
}

}  // namespace hapticd::bench
