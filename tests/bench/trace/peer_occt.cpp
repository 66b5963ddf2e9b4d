// SPDX-License-Identifier: MIT
// Solvers of Open CASCADE, as Debian packages it. Lengths are in millimetres, as CAD kernels and their tolerances
// expect.
#include <Extrema_GenLocateExtPS.hxx>
#include <Extrema_POnSurf.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>

#include "bench.hpp"

namespace hapticd::bench {
namespace {

constexpr double kMillimetre = 1e3;
constexpr double kTolerance = 1e-6;  // [mm]
constexpr double kParameterTolerance = 1e-10;

gp_Pnt toPoint(const Eigen::Vector3d& p) {
  return {kMillimetre * p.x(), kMillimetre * p.y(), kMillimetre * p.z()};
}
Eigen::Vector3d fromPoint(const gp_Pnt& p) {
  return Eigen::Vector3d(p.X(), p.Y(), p.Z()) / kMillimetre;
}

struct Knots {
  std::vector<double> values;
  std::vector<int> times;
  explicit Knots(const std::vector<double>& knots) {
    for (double knot : knots) {
      if (values.empty() || knot != values.back()) values.push_back(knot), times.push_back(0);
      ++times.back();
    }
  }
  int count() const { return static_cast<int>(values.size()); }
};

Handle(Geom_BSplineSurface) convert(const spline::SurfaceData& data) {
  const int count_u = data.count(0), count_v = data.count(1);
  TColgp_Array2OfPnt poles(1, count_u, 1, count_v);
  TColStd_Array2OfReal weights(1, count_u, 1, count_v);
  for (int i = 0; i < count_u; ++i) {
    for (int j = 0; j < count_v; ++j) {
      const auto at = static_cast<std::size_t>(i * count_v + j);
      poles.SetValue(i + 1, j + 1, toPoint(data.points[at]));
      weights.SetValue(i + 1, j + 1, data.weights.empty() ? 1 : data.weights[at]);
    }
  }
  const Knots u(data.knots[0]), v(data.knots[1]);
  TColStd_Array1OfReal knots_u(1, u.count()), knots_v(1, v.count());
  TColStd_Array1OfInteger times_u(1, u.count()), times_v(1, v.count());
  for (int i = 0; i < u.count(); ++i) {
    knots_u.SetValue(i + 1, u.values[static_cast<std::size_t>(i)]);
    times_u.SetValue(i + 1, u.times[static_cast<std::size_t>(i)]);
  }
  for (int i = 0; i < v.count(); ++i) {
    knots_v.SetValue(i + 1, v.values[static_cast<std::size_t>(i)]);
    times_v.SetValue(i + 1, v.times[static_cast<std::size_t>(i)]);
  }
  if (data.weights.empty()) {
    return new Geom_BSplineSurface(poles, knots_u, knots_v, times_u, times_v, data.degree[0], data.degree[1]);
  }
  return new Geom_BSplineSurface(poles, weights, knots_u, knots_v, times_u, times_v, data.degree[0], data.degree[1]);
}

class NextValue : public Solver {
 public:
  explicit NextValue(const spline::SurfaceData& data) : surface_(new ShapeAnalysis_Surface(convert(data))) {}
  std::string name() const override { return "OCCT NextValueOfUV"; }
  void start(double u, double v) override { uv_ = gp_Pnt2d(u, v); }
  Eigen::Vector3d step(const Eigen::Vector3d& probe) override {
    uv_ = surface_->NextValueOfUV(uv_, toPoint(probe), kTolerance);
    return fromPoint(surface_->Value(uv_));
  }

 private:
  Handle(ShapeAnalysis_Surface) surface_;
  gp_Pnt2d uv_;
};

class GenLocate : public Solver {
 public:
  explicit GenLocate(const spline::SurfaceData& data)
      : adaptor_(convert(data)), extrema_(adaptor_, kParameterTolerance, kParameterTolerance) {}
  std::string name() const override { return "OCCT GenLocateExtPS"; }
  void start(double u, double v) override { u_ = u, v_ = v; }
  Eigen::Vector3d step(const Eigen::Vector3d& probe) override {
    extrema_.Perform(toPoint(probe), u_, v_);
    if (!extrema_.IsDone()) return Eigen::Vector3d::Constant(NAN);
    extrema_.Point().Parameter(u_, v_);
    return fromPoint(extrema_.Point().Value());
  }

 private:
  GeomAdaptor_Surface adaptor_;
  Extrema_GenLocateExtPS extrema_;
  double u_ = 0, v_ = 0;
};

}  // namespace

std::vector<std::unique_ptr<Solver>> occtSolvers(const spline::SurfaceData& data) {
  std::vector<std::unique_ptr<Solver>> solvers;
  solvers.push_back(std::make_unique<NextValue>(data));
  solvers.push_back(std::make_unique<GenLocate>(data));
  return solvers;
}

}  // namespace hapticd::bench
