// SPDX-License-Identifier: MIT
#include "kernels/spline/curve.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "exact.hpp"
#include "samples.hpp"

namespace hapticd::spline {
namespace {

CurveData wire(int degree, int count, double spread, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> noise(-1, 1);
  CurveData data;
  data.name = "wire";
  data.degree = degree;
  data.knots = samples::knots(degree, count, random);
  for (int i = 0; i < count; ++i) {
    data.points.emplace_back(0.1 * i, 0.1 * noise(random), 0.1 * noise(random));
    if (spread > 0) data.weights.push_back(std::pow(spread, noise(random)));
  }
  return data;
}

constexpr std::array kPlaces{0.0, 0.123, 0.5, 0.987, 1.0};

/// Returns the exact point and derivatives of a wire at each of kPlaces. They are kept, since both forms are compared
/// with them.
const auto& truthOf(int degree, double spread) {
  static std::map<std::pair<int, double>, std::vector<std::array<Eigen::Vector3d, 3>>> known;
  auto& truth = known[{degree, spread}];
  if (truth.empty())
    for (const double u : kPlaces)
      truth.push_back(exact::curve(wire(degree, degree + 4, spread, static_cast<unsigned>(degree)), u));
  return truth;
}

TEST(Curve, AgreesWithExactArithmeticForEveryDegreeAndWeight) {
  for (int degree = 1; degree <= kMaxDegree; ++degree) {
    for (double spread : {0.0, 3.0, 1e9}) {
      const CurveData data = wire(degree, degree + 4, spread, static_cast<unsigned>(degree));
      for (std::size_t i = 0; i < kPlaces.size(); ++i) {
        const double u = kPlaces[i];
        const auto& truth = truthOf(degree, spread)[i];
        for (Instructions instructions : {Instructions::kFastest, Instructions::kPortable}) {
          const Curve curve(data, Form::kNet, instructions);
          CurvePoint E;
          curve.evaluate2(u, E);
          EXPECT_LT((E.C - truth[0]).norm(), 1e-14);
          EXPECT_LT((E.C1 - truth[1]).norm(), 1e-10 * truth[1].norm()) << degree << ' ' << spread << ' ' << u;
          EXPECT_LE((E.C2 - truth[2]).norm(), 1e-9 * (truth[2].norm() + truth[1].norm()));
          CurvePoint first;
          curve.evaluate1(u, first);
          EXPECT_LT((first.C1 - E.C1).norm(), 1e-13 * E.C1.norm());
        }
      }
    }
  }
}

TEST(Curve, InTableFormAgreesWithExactArithmeticForEveryDegree) {
  int tables = 0;
  for (int degree = 1; degree <= kMaxDegree; ++degree) {
    for (double spread : {0.0, 3.0, 1e9}) {
      const CurveData data = wire(degree, degree + 4, spread, static_cast<unsigned>(degree));
      for (Instructions instructions : {Instructions::kFastest, Instructions::kPortable}) {
        const Curve curve(data, Form::kTable, instructions);
        tables += curve.form() == Form::kTable;
        EXPECT_TRUE(curve.form() == Form::kTable || spread > 0 || degree > 5) << degree;
        for (std::size_t i = 0; i < kPlaces.size(); ++i) {
          const double u = kPlaces[i];
          const auto& truth = truthOf(degree, spread)[i];
          CurvePoint E, first;
          curve.evaluate2(u, E);
          EXPECT_LT((E.C - truth[0]).norm(), 1e-14) << degree << ' ' << spread << ' ' << u;
          EXPECT_LT((E.C1 - truth[1]).norm(), 1e-10 * truth[1].norm()) << degree << ' ' << spread << ' ' << u;
          EXPECT_LE((E.C2 - truth[2]).norm(), 1e-9 * (truth[2].norm() + truth[1].norm()));
          curve.evaluate1(u, first);
          EXPECT_LT((first.C1 - E.C1).norm(), 1e-13 * E.C1.norm());
        }
      }
    }
  }
  EXPECT_GT(tables, 20);
}

TEST(Curve, KeepsNoKnotsInTableForm) {
  const CurveData data = wire(5, 9, 0, 4);
  EXPECT_LT(Curve(data, Form::kTable).bytes(), Curve(data, Form::kNet).bytes());
}

TEST(Curve, IsACircleWithTheRightCurvature) {
  CurveData data;
  data.degree = 2;
  data.knots = samples::circleKnots();
  for (int i = 0; i < 9; ++i) {
    data.points.emplace_back(samples::kCircle[i][0], samples::kCircle[i][1], 0);
    data.weights.push_back(samples::circleWeight(i));
  }
  const Curve curve(data);
  CurvePoint E;
  for (int i = 0; i <= 100; ++i) {
    curve.evaluate2(i / 100.0, E);
    const double speed = E.C1.norm();
    const double bend = std::abs(E.C1.x() * E.C2.y() - E.C1.y() * E.C2.x()) / (speed * speed * speed);
    EXPECT_NEAR(E.C.norm(), 1, 1e-15);
    EXPECT_NEAR(bend, 1, 1e-13);
  }
}

TEST(Curve, MovesParametersOutsideTheDomainToItsEnds) {
  const CurveData data = wire(3, 8, 0, 4);
  const Curve curve(data);
  CurvePoint E;
  curve.evaluate1(-3, E);
  EXPECT_EQ(E.C, data.points.front());
  curve.evaluate1(1e300, E);
  EXPECT_EQ(E.C, data.points.back());
  curve.evaluate1(std::nan(""), E);
  EXPECT_EQ(E.C, data.points.front());
}

TEST(Curve, SaysWhatIsWrongWithItsData) {
  CurveData data = wire(3, 8, 0, 4);
  data.knots[5] = 7;
  try {
    Curve curve(data);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("curve 'wire': knots[6]"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace hapticd::spline
