// SPDX-License-Identifier: MIT
/// The operator of the evaluation: a simulated person who strokes a model with a finger and pushes on it. A spring and
/// a damper pull the finger to a target point behind the surface. The person sees the model 150 ms late.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <random>

#include "hapticd/shape.h"
#include "subjects.hpp"

namespace hapticd::table1 {

/// The protocol, the same for all rows. Numbers that were not measured are assumptions, which were chosen once;
/// driver/docs/reports/table1.md lists them.
struct Protocol {
  double rate = 1500;                      ///< [Hz] rate of the servo (paper)
  double stiffness = 300;                  ///< [N/m] stiffness of the hand
  double force = 9, spread = 0.5;          ///< [N] mean push; its standard deviation, divided by the mean
  double spread_rate = 0.7;                ///< [Hz] corner frequency of the variation of the push
  double most = 2;                         ///< largest variation of the push, in standard deviations
  double tremor = 0.03, tremor_rate = 10;  ///< share of the push, and its frequency [Hz]
  double visual_delay = 0.15;              ///< [s]
  double touch_every = 6;                  ///< [s] period after which the finger is lifted and comes down again
  double lift = 0.03, touch_speed = 0.1;   ///< [m] height of a lift; [m/s] speed of coming down
  double room_used = 0.7;                  ///< largest depth of the target point, as a share of Aim::room
  double seconds = 60;                     ///< [s] simulated time of each row
  int window = 15;                         ///< n of Eq. 5 (paper)
  unsigned seed = 1;
};

/// Target of the hand in one tick, in the world frame [m, m/s].
struct Wish {
  Eigen::Vector3d position{0, 0, 0}, velocity{0, 0, 0};
};

class Operator {
 public:
  Operator(const Protocol& protocol, std::function<Aim(double)> route);

  /// Returns the target at time t [s]. @param dt [s] length of the tick @param pose present pose of the model, which
  /// the operator sees only later
  Wish wish(double t, double dt, const hsp_pose& pose);

 private:
  double push(double t, double dt);
  double outward(double t, double depth) const;

  Protocol protocol_;
  std::function<Aim(double)> route_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double wander_ = 0;
  std::vector<hsp_pose> seen_;  ///< ring buffer of the poses during the last `visual_delay`
  size_t next_ = 0;
  Eigen::Vector3d last_{0, 0, 0};
  bool started_ = false;
};

}  // namespace hapticd::table1
