// SPDX-License-Identifier: MIT
#include "motion.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace hapticd {
namespace {

using Eigen::Vector3d;

/// Nodes and weights of Gauss-Legendre quadrature on [-1, 1] with eight points. It is exact for a polynomial surface of
/// degree 3 by 3, and to 1e-9 for arcs of a quarter circle.
constexpr std::array<double, 4> kNodes = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                          0.9602898564975363};
constexpr std::array<double, 4> kWeights = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                            0.1012285362903763};

template <class Add>
void overSpan(double lo, double hi, const Add& add) {
  const double middle = (lo + hi) / 2, half = (hi - lo) / 2;
  for (size_t i = 0; i < kNodes.size(); ++i)
    for (const double side : {-1.0, 1.0}) add(middle + side * half * kNodes[i], half * kWeights[i]);
}

void addPatch(const trace::Patch& patch, dynamics::SolidIntegral& integral) {
  const auto us = patch.surface.breaks(0), vs = patch.surface.breaks(1);
  spline::SurfacePoint at;
  for (size_t i = 0; i + 1 < us.size(); ++i)
    for (size_t j = 0; j + 1 < vs.size(); ++j)
      overSpan(us[i], us[i + 1], [&](double u, double wu) {
        overSpan(vs[j], vs[j + 1], [&](double v, double wv) {
          patch.surface.evaluate1(u, v, at);
          integral.add(at.S, patch.sign * wu * wv * at.Su.cross(at.Sv));
        });
      });
}

}  // namespace

dynamics::MassProperties massProperties(const trace::Model& model, bool& bounded) {
  dynamics::SolidIntegral integral(model.bounds().center());
  for (int i = 0; i < model.patchCount(); ++i) addPatch(model.patch(i), integral);
  bounded = true;
  for (int shell = 0; shell < model.shellCount(); ++shell) bounded = bounded && model.closed(shell);
  return integral.propertiesIn(model.bounds(), bounded);
}

dynamics::RigidBodyLaw lawOf(const MotionParameters& given, const dynamics::MassProperties& shape) {
  dynamics::RigidBodyLaw law;
  law.mass = given.mass_;
  law.center = given.center_.size() == 3 ? Vector3d(given.center_.data()) : shape.center;
  const auto& numbers = given.inertia_;
  if (numbers.size() == 3) {
    law.inertia = Vector3d(numbers.data()).asDiagonal();
  } else if (numbers.size() == 9) {
    law.inertia = Eigen::Matrix3d(numbers.data());  // a matrix that is not symmetric is refused below
  } else if (numbers.empty()) {
    const Vector3d away = shape.center - law.center;
    law.inertia =
        given.mass_ * (shape.inertia + away.squaredNorm() * Eigen::Matrix3d::Identity() - away * away.transpose());
  } else {
    throw std::invalid_argument("inertia: " + std::to_string(numbers.size()) +
                                " numbers are given; expected three moments, or three rows of three");
  }
  dynamics::validateSolid(law.inertia);
  law.damping = given.drag_;
  law.angular_damping = given.angular_drag_;
  law.tether = given.tether_;
  law.joint = static_cast<dynamics::Joint>(given.joint_);
  law.pivot = Vector3d(given.pivot_.data());
  law.axis = Vector3d(given.axis_.data());
  law.angular_tether = given.angular_tether_;
  law.rest = given.rest_;
  if (given.limits_.size() == 2) law.limits = {given.limits_[0], given.limits_[1]};
  return law;
}

std::string jointText(const MotionParameters& parameters, const dynamics::RigidBody& body) {
  const bool hinge = parameters.joint_ == static_cast<int>(dynamics::Joint::kHinge);
  const char* unit = hinge ? " rad" : " m";
  const double spring = hinge ? parameters.angular_tether_ : parameters.tether_, inertia = body.jointInertia();
  std::ostringstream text;
  text.precision(4);
  text << (hinge ? "a hinge: " : "a slider: ") << inertia << (hinge ? " kg m^2 about its axis" : " kg");
  if (parameters.limits_.size() == 2)
    text << ", end stops at " << parameters.limits_[0] << " and " << parameters.limits_[1] << unit;
  if (spring > 0)
    text << ", a spring of " << spring << (hinge ? " N m/rad" : " N/m") << " that is relaxed at " << parameters.rest_
         << unit << ", on which it swings at " << std::sqrt(spring / inertia) / (2 * M_PI)
         << " Hz if neither drag, weight nor a hand acts";
  return text.str();
}

}  // namespace hapticd
