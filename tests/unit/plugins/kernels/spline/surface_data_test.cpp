// SPDX-License-Identifier: MIT
#include "kernels/spline/surface_data.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>

#include "kernels/spline/refinement.hpp"
#include "kernels/spline/surface.hpp"
#include "samples.hpp"

namespace hapticd::spline {
namespace {

struct Fault {
  const char* message;  ///< what the message must contain
  std::function<void(SurfaceData&)> make;
};

const Fault kFaults[] = {
    {"surface 'lid': knots[u]: the degree is 0; expected 1 to 15", [](SurfaceData& d) { d.degree[0] = 0; }},
    {"knots[v]: the degree is 16", [](SurfaceData& d) { d.degree[1] = 16; }},
    {"knots[v]: the degree is -3", [](SurfaceData& d) { d.degree[1] = -3; }},
    {"knots[u]: 0 control points; degree 3 needs at least 4", [](SurfaceData& d) { d.knots[0].clear(); }},
    {"knots[u][5]: 0.1", [](SurfaceData& d) { d.knots[0] = {0, 0, 0, 0, .2, .1, 1, 1, 1, 1}; }},
    {"knots[v][3]: nan is not a parameter", [](SurfaceData& d) { d.knots[1][3] = std::nan(""); }},
    {"knots[v][9]: inf", [](SurfaceData& d) { d.knots[1][9] = std::numeric_limits<double>::infinity(); }},
    {"knots[u]: the domain from knot 3 to knot 6 is empty", [](SurfaceData& d) { d.knots[0].assign(10, 0.5); }},
    {"occurs more than 4 times",
     [](SurfaceData& d) {
       d.knots[0] = {0, 0, 0, 0, .5, .5, .5, .5, .5, 1, 1, 1, 1};
       d.points.assign(9 * 6, Eigen::Vector3d::Zero());
     }},
    {"points: 35 points; knots and degrees state 6 x 6 = 36", [](SurfaceData& d) { d.points.pop_back(); }},
    {"points[7]: a coordinate is not a finite number", [](SurfaceData& d) { d.points[7].y() = std::nan(""); }},
    {"weights: 3 weights for 36 points", [](SurfaceData& d) { d.weights = {1, 1, 1}; }},
    {"weights[2]: 0 is not a weight", [](SurfaceData& d) { d.weights.assign(36, 1), d.weights[2] = 0; }},
    {"weights[2]: -1 is not a weight", [](SurfaceData& d) { d.weights.assign(36, 1), d.weights[2] = -1; }},
    {"weights[35]: nan", [](SurfaceData& d) { d.weights.assign(36, 1), d.weights[35] = std::nan(""); }},
    {"expected a ratio of at most 1e100", [](SurfaceData& d) { d.weights.assign(36, 1e-200), d.weights[35] = 1e200; }},
    {"expected equal knots or a span of at least 1e-100",
     [](SurfaceData& d) { d.knots[0] = {0, 0, 0, 0, 1e-200, .5, 1, 1, 1, 1}; }},
};

TEST(SurfaceData, EveryFaultIsNamedWithItsPlace) {
  for (const Fault& fault : kFaults) {
    SurfaceData data = samples::sheet({3, 3}, {6, 6}, 0, 1);
    data.name = "lid";
    fault.make(data);
    try {
      Surface surface(data);
      ADD_FAILURE() << "accepted: " << fault.message;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(fault.message), std::string::npos) << error.what();
    }
  }
}

double oddNumber(std::mt19937& random) {
  constexpr double kOdd[] = {0,
                             -0.0,
                             1,
                             -1,
                             0.5,
                             1e-320,
                             1e-100,
                             1e100,
                             1e308,
                             -1e308,
                             5e-324,
                             1e-12,
                             1e-9,
                             1e9,
                             std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()};
  return kOdd[random() % std::size(kOdd)];
}

/// One random wrong turn.
void damage(SurfaceData& data, std::mt19937& random) {
  auto& knots = data.knots[random() % 2];
  switch (random() % 9) {
    case 0:
      data.degree[random() % 2] = static_cast<int>(random() % 40) - 10;
      break;
    case 1:
      if (!knots.empty()) knots[random() % knots.size()] = oddNumber(random);
      break;
    case 2:
      if (!knots.empty()) knots.erase(knots.begin() + static_cast<std::ptrdiff_t>(random() % knots.size()));
      break;
    case 3:
      knots.insert(knots.begin(), oddNumber(random));
      break;
    case 4:
      if (!data.points.empty()) data.points[random() % data.points.size()][random() % 3] = oddNumber(random);
      break;
    case 5:
      if (!data.points.empty()) data.points.pop_back();
      break;
    case 6:
      data.weights.resize(data.points.size(), 1);
      break;
    case 7:
      if (!data.weights.empty()) data.weights[random() % data.weights.size()] = oddNumber(random);
      break;
    default:
      if (knots.size() > 2) knots[random() % knots.size()] = knots[random() % knots.size()];
      break;
  }
}

TEST(SurfaceData, WhateverIsAcceptedCanBeSplitAndEvaluatedWithoutNaN) {
  std::mt19937 random(12345);
  int accepted = 0, refused = 0;
  for (int round = 0; round < 20000; ++round) {
    const std::array<int, 2> degree{1 + static_cast<int>(random() % 4), 1 + static_cast<int>(random() % 4)};
    SurfaceData data = samples::sheet(degree, {degree[0] + 2, degree[1] + 3}, random() % 2 == 0 ? 0 : 2, random());
    for (unsigned i = random() % 4 + 1; i > 0; --i) damage(data, random);
    try {
      const Surface surface(data, random() % 2 == 0 ? Form::kTable : Form::kNet);
      SurfacePoint E;
      const auto u = surface.domain(0), v = surface.domain(1);
      surface.evaluate2(u[0] + (u[1] - u[0]) * 0.3, v[0] + (v[1] - v[0]) * 0.6, E);
      ASSERT_TRUE(E.S.allFinite()) << round;
      for (const SurfaceData& part : splitAtCreases(data)) validate(part);
      for (const SurfaceData& piece : bezierPieces(data)) validate(piece);
      ++accepted;
    } catch (const std::invalid_argument& error) {
      ASSERT_GT(std::string(error.what()).size(), 20u);
      ++refused;
    }
  }
  EXPECT_GT(accepted, 1000);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace hapticd::spline
