// SPDX-License-Identifier: MIT
/// The operator of the evaluation: a person who strokes a model with a finger and pushes on it, as a spring and damper
/// pulled to a point behind the surface. Sees the model 150 ms late.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <random>

#include "hapticd/shape.h"
#include "subjects.hpp"

namespace hapticd::table1 {

/// One protocol for all rows. What is no measurement is an assumption, chosen once: docs/table1.md says which.
struct Protocol {
  double rate = 1500;                      ///< [Hz] of the servo (paper)
  double stiffness = 300;                  ///< [N/m] of the hand
  double force = 9, spread = 0.5;          ///< [N] mean push, and its standard deviation over the mean
  double spread_rate = 0.7;                ///< [Hz] how fast it wanders
  double most = 2;                         ///< standard deviations that it wanders at most
  double tremor = 0.03, tremor_rate = 10;  ///< of the push, [Hz]
  double visual_delay = 0.15;              ///< [s]
  double touch_every = 6;                  ///< [s] the finger is lifted and comes down again
  double lift = 0.03, touch_speed = 0.1;   ///< [m], [m/s]
  double room_used = 0.7;                  ///< of the way to where the other side of the model is nearer
  double seconds = 60;                     ///< of each row
  int window = 15;                         ///< n of Eq. 5 (paper)
  unsigned seed = 1;
};

/// What the hand wants in one tick, world frame.
struct Wish {
  Eigen::Vector3d position{0, 0, 0}, velocity{0, 0, 0};
};

class Operator {
 public:
  Operator(const Protocol& protocol, std::function<Aim(double)> route);

  /// What it wants at time t [s], a tick of dt after the last, of a model that is at `pose` now.
  Wish wish(double t, double dt, const hsp_pose& pose);

 private:
  double push(double t, double dt);
  double outward(double t, double depth) const;

  Protocol protocol_;
  std::function<Aim(double)> route_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double wander_ = 0;
  std::vector<hsp_pose> seen_;  ///< a ring of the poses of the last `visual_delay`
  size_t next_ = 0;
  Eigen::Vector3d last_{0, 0, 0};
  bool started_ = false;
};

}  // namespace hapticd::table1
