// SPDX-License-Identifier: MIT
/// Stiffness from 1 to 1e6 N/m, mass from 1e-6 to 1e6 kg, steps from 0.1 to 10 ms, damping up to ten times critical:
/// no integrator gains energy anywhere.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "kernels/dynamics/oscillator.hpp"
#include "kernels/dynamics/rigid_body.hpp"

namespace hapticd::dynamics {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 1e-9;

template <class Check>
int overGrid(const Check& check) {
  int cases = 0;
  for (double k = 1; k < 2e6; k *= 10)
    for (double m = 1e-6; m < 2e6; m *= 10)
      for (const double dt : {1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2})
        for (const double zeta : {0.0, 0.1, 0.7, 1.0, 10.0}) {
          const bool bounded = check(k, m, dt, 2 * zeta * std::sqrt(k * m));
          EXPECT_TRUE(bounded) << "k " << k << " m " << m << " dt " << dt << " zeta " << zeta;
          cases += bounded ? 1 : 0;
        }
  return cases;
}

TEST(Grid, TheOscillatorStaysBoundedInEveryCase) {
  const int cases = overGrid([](double k, double m, double dt, double b) {
    const OscillatorStep step = oscillatorStep(m, b, k, dt);
    double x = 1e-3, v = 0;
    const double energy = k * x * x;
    for (int i = 0; i < 1000; ++i) {
      advance(step, x, v);
      if (!(k * x * x + m * v * v <= energy * (1 + kRounding))) return false;
    }
    return true;
  });
  std::printf("%d cases of the oscillator, all bounded\n", cases);
  EXPECT_EQ(cases, 7 * 13 * 7 * 5);
}

TEST(Grid, ABodyOnATetherStaysBoundedInEveryCase) {
  const int cases = overGrid([](double k, double m, double dt, double b) {
    RigidBodyLaw law;
    law.mass = m;
    law.inertia = m * 1e-2 * Vector3d(1, 2, 2.5).asDiagonal();
    law.tether = k;
    law.damping = b;
    law.angular_damping = b * 1e-2;
    RigidBody body(law, Vector3d::Zero(), Eigen::Quaterniond::Identity(), Vector3d::Zero());
    body.setVelocity({1e-3, -2e-3, 5e-3}, {1, 2, 3});
    const double energy = body.energy();
    for (int i = 0; i < 300; ++i) {
      body.step(Vector3d::Zero(), Vector3d::Zero(), dt);
      if (!(body.energy() <= energy * (1 + kRounding))) return false;
    }
    return true;
  });
  std::printf("%d cases of a turning body on a tether, all bounded\n", cases);
  EXPECT_EQ(cases, 7 * 13 * 7 * 5);
}

}  // namespace
}  // namespace hapticd::dynamics
