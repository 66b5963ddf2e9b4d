// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "example_chain.hpp"
#include "kinematics/chain_dynamics.hpp"
#include "kinematics/delta.hpp"
#include "kinematics/phantom_dynamics.hpp"
#include "numeric.hpp"

namespace hapticd::kinematics {
namespace {

/// c(q, qd) from the mass matrix alone: c_i = sum_jk (dM_ij/dq_k - 1/2 dM_jk/dq_i) qd_j qd_k (Lagrange).
template <class MassAt>
JointVector lagrange(const MassAt& mass, const JointVector& q, const JointVector& qd) {
  constexpr double kStep = 1e-4;
  const auto n = q.size();
  JointVector c = JointVector::Zero(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    JointVector ahead = q, behind = q;
    ahead[k] += kStep, behind[k] -= kStep;
    const MassMatrix slope = (mass(ahead) - mass(behind)) / (2 * kStep);
    c += slope * qd * qd[k];
    c[k] -= 0.5 * qd.dot(slope * qd);
  }
  return c;
}

TEST(DeltaMotion, TheTipSwingsAsItsJacobianTurns) {
  DeltaGeometry tilted;
  tilted.base.orientation = Eigen::Quaterniond(0.9, 0.3, -0.2, 0.1);
  const Delta arm(tilted);
  RandomJoints random(arm);
  int reached = 0;
  for (int n = 0; n < 200; ++n) {
    constexpr double kStep = 1e-5;  // s
    const JointVector q = random.next();
    JointVector qd(3);
    for (int i = 0; i < 3; ++i) qd[i] = random.uniform(-2, 2);
    DeltaMotion now, ahead, behind;
    Pose tip;
    if (!arm.motion(q, qd, now) || now.J.norm() > 1) continue;  // where the rods are stretched out J has no bound
    if (!arm.motion(q + kStep * qd, qd, ahead) || !arm.motion(q - kStep * qd, qd, behind)) continue;
    ++reached;
    ASSERT_TRUE(arm.forward(q, tip));
    EXPECT_LT((now.tip - tip.position).norm(), 1e-12);
    const Eigen::Vector3d swing = (ahead.J - behind.J) * qd / (2 * kStep);
    EXPECT_LT((now.swing - swing).norm(), 1e-6 * (1 + swing.norm()));
  }
  EXPECT_GT(reached, 20);
}

TEST(ChainDynamics, KineticEnergyIsThatOfTheLinks) {
  for (const bool slider : {false, true}) {
    const Chain chain(exampleChain(slider));
    RandomJoints random(chain);
    for (int n = 0; n < 50; ++n) {
      const JointVector q = random.next();
      JointVector qd(7);
      for (int i = 0; i < 7; ++i) qd[i] = random.uniform(-2, 2);
      ChainFrames at;
      chain.frames(q, at);
      MassMatrix M;
      JointVector c;
      chainDynamics(chain, at, qd, M, c);
      double energy = 0;
      for (int i = 0; i < 7; ++i) {
        const ChainLink& link = chain.links()[static_cast<size_t>(i)];
        const auto k = static_cast<size_t>(i + 1);
        const Wrench v = chain.jacobianAt(at, at.o[k] + at.R[k] * link.center, i + 1) * qd;
        const Eigen::Vector3d w = at.R[k].transpose() * v.tail<3>();
        energy += 0.5 * link.mass * v.head<3>().squaredNorm() + 0.5 * w.dot(link.inertia * w);
      }
      EXPECT_NEAR(0.5 * qd.dot(M * qd), energy, 1e-12 * energy);
      EXPECT_EQ((M - M.transpose()).norm(), 0);
    }
  }
}

TEST(ChainDynamics, VelocityTorquesFollowFromTheMassMatrix) {
  for (const bool slider : {false, true}) {
    const Chain chain(exampleChain(slider));
    RandomJoints random(chain);
    const auto mass = [&](const JointVector& q) {
      ChainFrames at;
      chain.frames(q, at);
      MassMatrix M;
      JointVector c;
      chainDynamics(chain, at, JointVector::Zero(7), M, c);
      return M;
    };
    for (int n = 0; n < 50; ++n) {
      const JointVector q = random.next();
      JointVector qd(7), c;
      for (int i = 0; i < 7; ++i) qd[i] = random.uniform(-2, 2);
      ChainFrames at;
      chain.frames(q, at);
      MassMatrix M;
      chainDynamics(chain, at, qd, M, c);
      EXPECT_LT((c - lagrange(mass, q, qd)).norm(), 1e-6 * (1 + c.norm()));
    }
  }
}

TEST(ChainDynamics, WeightIsTheSlopeOfThePotentialEnergy) {
  const Chain chain(exampleChain(true));
  RandomJoints random(chain);
  const Eigen::Vector3d g(1, -9, 2);
  const auto potential = [&](const JointVector& q) {
    ChainFrames at;
    chain.frames(q, at);
    double energy = 0;
    for (size_t i = 0; i < 7; ++i)
      energy -= chain.links()[i].mass * g.dot(at.o[i + 1] + at.R[i + 1] * chain.links()[i].center);
    return energy;
  };
  for (int n = 0; n < 50; ++n) {
    const JointVector q = random.next();
    JointVector tau;
    chain.gravity(q, g, tau);
    for (int i = 0; i < 7; ++i) {
      JointVector ahead = q, behind = q;
      ahead[i] += 1e-5, behind[i] -= 1e-5;
      EXPECT_NEAR(tau[i], (potential(ahead) - potential(behind)) / 2e-5, 1e-7);
    }
  }
}

TEST(PhantomDynamics, HasThePublishedMassMatrix) {
  PhantomInertia inertia;
  inertia.rotor.setZero();
  const PhantomDynamics dynamics(PhantomGeometry{}, inertia);
  Eigen::Matrix3d M;
  Eigen::Vector3d c;
  dynamics.evaluate(Eigen::Vector3d(1.0, 0.0, 0.0), Eigen::Vector3d::Zero(), M, c);
  // At q2 = q3 = 0 by hand from Cavusoglu, Feygin & Tendick: Iayy + Idfyy + Ibase + Ibeyy + Icyy + l1^2 (ma + mc / 4)
  const double m11 = 0.001843e-4 + 0.629e-4 + 11.87e-4 + 10.06e-4 + 0.959e-4 + 0.215 * 0.215 * (0.0202 + 0.0249 / 4);
  EXPECT_NEAR(M(0, 0), m11, 1e-12);
  EXPECT_NEAR(M(1, 1), 11.09e-4 + 0.959e-4 + 0.215 * 0.215 * (0.0202 + 0.0249 / 4), 1e-12);
  EXPECT_NEAR(M(2, 2), 0.4864e-4 + 7.11e-4 + 0.25 * 0.17 * 0.17 * 0.0202 + 0.0325 * 0.0325 * 0.0249, 1e-12);
  EXPECT_NEAR(M(1, 2), 0, 1e-15);
  dynamics.evaluate(Eigen::Vector3d(0, 0.5, 0.2), Eigen::Vector3d::Zero(), M, c);
  EXPECT_NEAR(M(1, 2), -0.5 * 0.215 * (0.17 * 0.0202 + 0.0325 * 0.0249) * std::sin(0.3), 1e-12);
}

TEST(PhantomDynamics, VelocityTorquesFollowFromTheMassMatrix) {
  const PhantomDynamics dynamics(PhantomGeometry{}, PhantomInertia{});
  const Phantom arm;
  RandomJoints random(arm);
  const auto mass = [&](const JointVector& q) {
    Eigen::Matrix3d M;
    Eigen::Vector3d c;
    dynamics.evaluate(q.head<3>(), Eigen::Vector3d::Zero(), M, c);
    return MassMatrix(M);
  };
  for (int n = 0; n < 200; ++n) {
    const Eigen::Vector3d q = random.next(), qd = random.vector(5);
    Eigen::Matrix3d M;
    Eigen::Vector3d c;
    dynamics.evaluate(q, qd, M, c);
    EXPECT_LT((c - lagrange(mass, q, qd)).norm(), 1e-9 * (1 + c.norm()));
    EXPECT_TRUE(Eigen::LLT<Eigen::Matrix3d>(M).info() == Eigen::Success) << "mass must be positive";
  }
}

}  // namespace
}  // namespace hapticd::kinematics
