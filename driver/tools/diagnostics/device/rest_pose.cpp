// SPDX-License-Identifier: MIT
#include "diagnostics/device/rest_pose.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

#include "diagnostics/reading/given_values.hpp"

namespace hapticd::diagnostics {
namespace {

using document::Node;
using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Link {
  double a, alpha, d, theta;
  double low = -M_PI / 2, high = M_PI / 2;  // [rad]; without limits, half of a joint's usual range
};

/// The links of an arm in standard Denavit-Hartenberg parameters. Errors are ignored, because they were reported
/// before.
struct Links {
  std::vector<Link> rows;
  Eigen::Isometry3d base = Eigen::Isometry3d::Identity();
  Vector3d tool = Vector3d::Zero();
};

Links linksOf(const Node& arm) {
  Links links;
  links.base.translation() = vectorBelow(arm, "origin");
  if (const std::vector<double> q = numbersOf(arm.find("base_orientation"), 4); !q.empty())
    links.base.rotate(Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized());
  links.tool = vectorBelow(arm, "tool_position");
  const Node *rows = arm.find("dh"), *limits = arm.find("limits");
  for (size_t i = 0; rows != nullptr && i < rows->items.size(); ++i) {
    const std::vector<double> row = numbersOf(&rows->items[i], 4);
    if (row.empty()) continue;
    Link link{row[0], row[1], row[2], row[3]};
    const bool given = limits != nullptr && i < limits->items.size();
    if (const std::vector<double> limit = numbersOf(given ? &limits->items[i] : nullptr, 2); !limit.empty())
      link.low = limit[0], link.high = limit[1];
    links.rows.push_back(link);
  }
  return links;
}

/// The place of the tip, and the singular values of its Jacobian, the largest first.
struct Motion {
  Vector3d tip, values = Vector3d::Zero();
  Matrix3d directions;
};

Motion motionAt(const Links& links, const std::vector<double>& q) {
  std::vector<Vector3d> axes, points;
  Eigen::Isometry3d frame = links.base;
  for (size_t i = 0; i < links.rows.size(); ++i) {
    const Link& link = links.rows[i];
    axes.emplace_back(frame.linear().col(2)), points.emplace_back(frame.translation());
    frame.rotate(Eigen::AngleAxisd(link.theta + q[i], Vector3d::UnitZ()));
    frame.translate(Vector3d(link.a, 0, link.d));
    frame.rotate(Eigen::AngleAxisd(link.alpha, Vector3d::UnitX()));
  }
  Motion motion;
  motion.tip = frame * links.tool;
  // The eigenvalues of J J^T, in ascending order, are the squares of the singular values of J.
  Matrix3d square = Matrix3d::Zero();
  for (size_t i = 0; i < q.size(); ++i) {
    const Vector3d column = axes[i].cross(motion.tip - points[i]);
    for (int axis = 0; axis < 3; ++axis) square.col(axis) += column[axis] * column;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> parts(square);
  for (int i = 0; i < 3; ++i) {
    motion.values[i] = std::sqrt(std::max(0.0, parts.eigenvalues()[2 - i]));
    motion.directions.col(i) = parts.eigenvectors().col(2 - i);
  }
  return motion;
}

/// A pose to choose from: how well the tip moves in its worst direction, and how far the pose is from the middle.
struct Candidate {
  std::vector<double> q;
  Motion motion;
  double away = 0;
};

std::vector<double> middleOf(const Links& links) {
  std::vector<double> q;
  for (const Link& link : links.rows) q.push_back((link.low + link.high) / 2);
  return q;
}

/// Returns the poses to choose from: first the middle, then random poses, which are the same in every run.
std::vector<Candidate> candidatesFor(const Links& links) {
  constexpr int kPoses = 3000;
  constexpr double kInside = 0.8;  // share of the range between the stops
  std::mt19937_64 random(1);
  const std::vector<double> middle = middleOf(links);
  std::vector<Candidate> all{{middle, motionAt(links, middle)}};
  for (int pose = 0; pose < kPoses; ++pose) {
    Candidate one{middle, {}};
    for (size_t i = 0; i < middle.size(); ++i) {
      const double part = (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5) * kInside;
      const double joint = middle[i] + part * (links.rows[i].high - links.rows[i].low);
      one.q[i] = std::round(joint * 100) / 100;  // rounded as in the printed pose
      one.away += part * part;
    }
    one.motion = motionAt(links, one.q);
    all.push_back(std::move(one));
  }
  return all;
}

/// Returns the number of independent directions in which the tip can move at some pose.
int freedomOf(const std::vector<Candidate>& all) {
  constexpr double kMoves = 1e-3;  // share of the motion in the best direction
  Vector3d most = Vector3d::Zero();
  for (const Candidate& one : all) most = most.cwiseMax(one.motion.values);
  int freedom = 0;
  while (freedom < 3 && most[freedom] > kMoves * most[0]) ++freedom;
  return freedom;
}

/// Returns true if the tip of an arm with two directions stays in a plane whatever the joints are, and not on the
/// surface of a ball.
bool staysInPlane(const std::vector<Candidate>& all, const Motion& motion) {
  const Vector3d across = motion.directions.col(2);
  return std::all_of(all.begin(), all.end(),
                     [&](const Candidate& one) { return std::abs(across.dot(one.motion.tip - motion.tip)) < 1e-9; });
}

/// Returns z if the tip can move along z, otherwise y or x.
Vector3d pushOf(const Motion& motion, int freedom) {
  if (freedom == 3 || freedom == 0) return Vector3d::UnitZ();
  const auto moves = motion.directions.leftCols(freedom);
  for (const int axis : {2, 1, 0}) {
    const Vector3d along = moves * (moves.transpose() * Vector3d::Unit(axis));
    if (along.norm() > 0.5) return along.normalized();
  }
  return motion.directions.col(0);
}

}  // namespace

Vector3d vectorBelow(const Node& map, std::string_view key) {
  const std::vector<double> p = numbersOf(map.find(key), 3);
  return p.empty() ? Vector3d(0, 0, 0) : Vector3d(p[0], p[1], p[2]);
}

RestPose restPoseOf(const Node& arm) {
  const Links links = linksOf(arm);
  RestPose rest;
  if (links.rows.empty()) return rest;
  const std::vector<Candidate> all = candidatesFor(links);
  rest.freedom = freedomOf(all);
  const int last = std::max(rest.freedom - 1, 0);
  double best = 0;
  for (const Candidate& one : all) best = std::max(best, one.motion.values[last]);
  constexpr double kWellEnough = 0.2, kWell = 0.6;  // shares of the best pose's value
  const Candidate* chosen = &all.front();
  rest.middle = chosen->motion.values[last] >= kWellEnough * best;
  for (const Candidate& one : all) {
    const bool better = chosen == &all.front() || one.away < chosen->away;
    if (!rest.middle && one.motion.values[last] >= kWell * best && better) chosen = &one;
  }
  rest.joints = chosen->q;
  rest.tip = chosen->motion.tip;
  rest.push = pushOf(chosen->motion, rest.freedom);
  rest.flat = rest.freedom == 2 && staysInPlane(all, chosen->motion);
  return rest;
}

}  // namespace hapticd::diagnostics
