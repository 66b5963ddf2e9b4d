// SPDX-License-Identifier: MIT
/// A rigid arm under the torques of its motors and the force of a hand, integrated in small steps.
///
/// The integrator is linearly implicit Euler. Springs, dampers, friction and end stops enter with their derivatives, so
/// a step is stable for any stiffness of the hand and of the stops. Mass, Coriolis and motor torques enter explicitly.
/// The error is of the order of the step, and it removes energy.
#pragma once
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "simulated/settings.hpp"

namespace hapticd::simulated {

inline constexpr double kMaxJointRate = 500;  ///< [rad/s] bound that keeps every state finite; no motor reaches it

/// The state of a simulated arm with any mechanism, and its steps.
class Plant {
 public:
  explicit Plant(const JointSettings& joints) : joints_(joints) {}
  virtual ~Plant() = default;

  /// [main] Puts the arm to rest at q, with its motors off.
  virtual void reset(const JointVector& q) = 0;
  /// [rt] Advances by h seconds.
  virtual void step(double h, const Drive& drive, const HandCoupling& pull) noexcept = 0;
  virtual JointVector position() const noexcept = 0;         ///< [rt] [rad]
  virtual JointVector velocity() const noexcept = 0;         ///< [rt] [rad/s]
  virtual Eigen::Vector3d tip() const noexcept = 0;          ///< [rt] [m] device frame, at most one step old
  virtual Eigen::Vector3d tipVelocity() const noexcept = 0;  ///< [rt] [m/s]
  virtual Eigen::Vector3d handForce() const noexcept = 0;    ///< [rt] [N] force of the hand on the tip
  /// [rt] Torque [N m] from the motors to the links, minus friction: the reading of a load cell behind the gear.
  virtual JointVector transmitted() const noexcept = 0;

 protected:
  JointSettings joints_;
};

/// A simulated arm with one kind of mechanism. A class Mechanism has the types Vector (n) and Matrix (n x n), and
///   void evaluate(q, qd)                      computes the members below
///   Matrix M; Vector bias;                    mass matrix with the hand's mass; Coriolis and weight torques
///   TipJacobian J; Eigen::Vector3d tip;       Jacobian (3 x n) and position of the point that the hand holds
///   template <class Add> void stops(q, Add)   calls Add(row, excess) if row * q exceeds a limit by excess
template <class Mechanism>
class PlantOf final : public Plant {
 public:
  using Vector = typename Mechanism::Vector;
  using Matrix = typename Mechanism::Matrix;

  PlantOf(const JointSettings& joints, const Mechanism& mechanism) : Plant(joints), mechanism_(mechanism) {}

  void reset(const JointVector& q) override {
    q_ = q;
    qd_ = Vector::Zero(q.size());
    motor_ = Vector::Zero(q.size());
    transmitted_ = Vector::Zero(q.size());
    drive_stiffness_ = drive_damping_ = Vector::Zero(q.size());
    hand_force_.setZero();
    mechanism_.evaluate(q_, qd_);
  }

  void step(double h, const Drive& drive, const HandCoupling& pull) noexcept override {
    mechanism_.evaluate(q_, qd_);
    const Eigen::Vector3d tip_velocity = mechanism_.J * qd_;
    const Eigen::Vector3d force =
        pull.stiffness * (pull.target - mechanism_.tip) + pull.damping * (pull.velocity - tip_velocity) + pull.force;
    hand_force_ = force;
    // lazyProduct(): the code for large matrices is not instantiated; the bits are the same for so few joints
    A_.noalias() = mechanism_.J.transpose().lazyProduct(mechanism_.J);
    K_ = pull.stiffness * A_;
    D_ = pull.damping * A_;
    tau_ = mechanism_.J.transpose() * force - mechanism_.bias;
    drive_stiffness_.setZero();
    drive_damping_.setZero();
    addMotors(h, drive);
    addFriction();
    addStops();
    A_ = mechanism_.M + h * D_ + (h * h) * K_;
    tau_ -= h * (K_ * qd_);
    const Vector before = qd_;
    qd_ += h * A_.ldlt().solve(tau_);
    qd_ = qd_.cwiseMax(-kMaxJointRate).cwiseMin(kMaxJointRate);
    // The torque on the links at the end of the step, with the derivatives that the step used.
    transmitted_ -= drive_damping_.cwiseProduct(qd_ - before) + h * drive_stiffness_.cwiseProduct(qd_);
    q_ += h * qd_;
  }

  JointVector position() const noexcept override { return q_; }
  JointVector velocity() const noexcept override { return qd_; }
  JointVector transmitted() const noexcept override { return transmitted_; }
  Eigen::Vector3d tip() const noexcept override { return mechanism_.tip; }
  Eigen::Vector3d tipVelocity() const noexcept override { return mechanism_.J * qd_; }
  Eigen::Vector3d handForce() const noexcept override { return hand_force_; }

 private:
  void addMotors(double h, const Drive& drive) noexcept {
    const double keep = joints_.motor_lag > 0 ? std::exp(-h / joints_.motor_lag) : 0;
    for (Eigen::Index i = 0; i < q_.size(); ++i) {
      double wanted = drive.torque[i];
      if (drive.position_mode && joints_.stiffness.size() > 0) {
        wanted += joints_.stiffness[i] * (drive.reference[i] - q_[i]) +
                  joints_.rate_damping[i] * (drive.reference_rate[i] - qd_[i]);
        if (std::abs(wanted) < joints_.max_torque[i]) {  // a saturated motor has constant torque: no derivatives
          drive_stiffness_[i] += joints_.stiffness[i];
          drive_damping_[i] += joints_.rate_damping[i];
          K_(i, i) += joints_.stiffness[i];
          D_(i, i) += joints_.rate_damping[i];
        }
      }
      wanted = std::clamp(wanted, -joints_.max_torque[i], joints_.max_torque[i]);
      motor_[i] = wanted + keep * (motor_[i] - wanted);
      transmitted_[i] = motor_[i];
      tau_[i] += motor_[i];
    }
  }

  void addFriction() noexcept {
    for (Eigen::Index i = 0; i < q_.size(); ++i) {
      const double shape = std::tanh(qd_[i] / joints_.friction_speed);
      const double lost = joints_.damping[i] * qd_[i] + joints_.friction[i] * shape;
      const double slope = joints_.damping[i] + joints_.friction[i] / joints_.friction_speed * (1 - shape * shape);
      drive_damping_[i] += slope;
      D_(i, i) += slope;
      transmitted_[i] -= lost;
      tau_[i] -= lost;
    }
  }

  void addStops() noexcept {
    mechanism_.stops(q_, [&](const Vector& row, double excess) {
      const double rate = row.dot(qd_);
      tau_ -= row * (joints_.stop_stiffness * excess + joints_.stop_damping * rate);
      K_ += joints_.stop_stiffness * row * row.transpose();
      D_ += joints_.stop_damping * row * row.transpose();
    });
  }

  Mechanism mechanism_;
  Vector q_, qd_, motor_, transmitted_, tau_;
  Vector drive_stiffness_, drive_damping_;  ///< parts of K_ and D_ due to motors and friction
  Matrix A_, K_, D_;
  Eigen::Vector3d hand_force_{0, 0, 0};
};

}  // namespace hapticd::simulated
