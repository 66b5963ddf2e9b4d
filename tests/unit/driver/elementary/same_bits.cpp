// SPDX-License-Identifier: MIT
/// Prints a number for what the mathematics of arms and shapes give, to the last bit: built in several ways, it must be
/// the same. The build compiles it with the libraries that ship, and the script same_bits in other ways.
#include <Eigen/Geometry>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "kernels/dynamics/pendulum.hpp"
#include "kernels/dynamics/torsion_spring.hpp"
#include "kernels/spline/surface.hpp"
#include "kinematics/phantom.hpp"

namespace {

uint64_t sum = 0xcbf29ce484222325;

void book(double value) {
  sum = (sum ^ std::bit_cast<uint64_t>(value)) * 0x100000001b3;
}

/// Sines, arcs and exponents, by the names of C.
void elementary() {
  for (int i = 0; i < 200'000; ++i) {
    const double x = (i - 100'000) * 1.7320508e-3;
    for (const double value :
         {std::sin(x), std::cos(x), std::atan2(x, 1.5), std::exp(x * 0.1), std::tanh(x), std::hypot(x, 3.0),
          std::expm1(-x * x), std::pow(std::fabs(x), 1.37), std::acos(std::sin(x)), std::log(x * x + 0.1)})
      book(value);
  }
}

void arm() {
  const hapticd::kinematics::Phantom arm;
  for (int i = 0; i < 50'000; ++i) {
    const Eigen::Vector3d q(std::sin(i * 0.01), 0.5 * std::sin(i * 0.017), 0.7 * std::cos(i * 0.013));
    const Eigen::Vector3d p = arm.position(q);
    const Eigen::Matrix3d J = arm.positionJacobian(q);
    const Eigen::Vector3d tau = J.transpose() * Eigen::Vector3d(1, 2, 3);
    for (int k = 0; k < 3; ++k) book(p[k]), book(tau[k]);
    hapticd::kinematics::JointVector back = q;
    book(arm.inverse(p, back) ? back[1] : 0);
  }
}

void pendulum() {
  hapticd::dynamics::PendulumLaw law;
  hapticd::dynamics::PendulumState state{1.5, 0};
  for (int i = 0; i < 50'000; ++i) {
    law.damping = i % 5000 * 1e-4;
    state = hapticd::dynamics::advance(law, state, 0.1 * std::sin(i * 1e-3), 1e-3);
    book(state.angle), book(state.rate);
  }
}

void spring() {
  hapticd::dynamics::PendulumLaw law;
  hapticd::dynamics::PendulumState state{1.5, 0};
  for (int i = 0; i < 50'000; ++i) {
    law.damping = i % 5000 * 1e-4;
    law.gravity = i % 2 == 0 ? 9.81 : 0;
    state = hapticd::dynamics::advance(law, {i % 300 + 1.0, 0.4}, state, 0.1 * std::sin(i * 1e-3), 1e-3);
    book(state.angle), book(state.rate);
  }
}

void surface() {
  hapticd::spline::SurfaceData data;
  data.name = "patch";
  data.degree = {3, 2};
  data.knots = {std::vector<double>{0, 0, 0, 0, 0.5, 1, 1, 1, 1}, std::vector<double>{0, 0, 0, 1, 1, 1}};
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 3; ++j) {
      data.points.push_back({0.02 * i, 0.03 * j, 0.01 * std::sin(i + 2 * j)});
      data.weights.push_back(1 + 0.2 * ((i + j) % 2));
    }
  for (const auto form : {hapticd::spline::Form::kTable, hapticd::spline::Form::kNet}) {
    const hapticd::spline::Surface patch(data, form, hapticd::spline::Instructions::kPortable);
    hapticd::spline::SurfacePoint at;
    for (int i = 0; i < 20'000; ++i) {
      patch.evaluate2(std::fmod(i * 0.0137, 1.0), std::fmod(i * 0.0071, 1.0), at);
      for (const Eigen::Vector3d& v : {at.S, at.Su, at.Sv, at.Suu, at.Suv, at.Svv})
        for (int k = 0; k < 3; ++k) book(v[k]);
    }
  }
}

}  // namespace

int main() {
  const auto tell = [](const char* what) {
    std::printf("%-12s %016llx\n", what, static_cast<unsigned long long>(sum));
  };
  elementary(), tell("elementary");
  arm(), tell("arm");
  pendulum(), tell("pendulum");
  spring(), tell("spring");
  surface(), tell("surface");
}
