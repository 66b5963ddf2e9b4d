// SPDX-License-Identifier: MIT
/// Models with overlapping parts, such as a pot whose handle ends inside its body. Surfaces inside another part are not
/// felt, and at the joint the parts act together.
#include <algorithm>
#include <array>

#include "kernels/trace/faces.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Vector3d;

/// A part, approximated by the tangent plane at its nearest foot.
struct Wall {
  Vector3d normal;   ///< outward unit normal
  double depth = 0;  ///< [m] depth of the probe behind the plane
};

/// Returns the shortest motion of the probe that leads out of all walls at once: the projection onto the intersection
/// of their half-spaces (Zilles & Salisbury 1995), by Hildreth's method. The result is continuous in the walls, because
/// it is a fixed number of sweeps of continuous functions. So the force is continuous if the feet are. For walls that
/// face each other there may be no way out, or only one so long that the planes no longer approximate the surfaces. So
/// the motion is at most kLongestWay times the greatest depth. @param pushes becomes the contribution of each wall
Vector3d wayOut(const Wall* walls, int count, double deepest, double* pushes) noexcept {
  constexpr double kLongestWay = 2;  // multiple of the greatest depth; reached if walls meet at 60 degrees
  constexpr int kSweeps = 32;        // between walls that meet at 20 degrees, 10 % of the depth remains
  Vector3d way = Vector3d::Zero();
  std::fill_n(pushes, count, 0.0);
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (int i = 0; i < count; ++i) {
      const double push = std::max(0.0, pushes[i] + walls[i].depth - way.dot(walls[i].normal));
      way += (push - pushes[i]) * walls[i].normal;
      pushes[i] = push;
    }
  const double length = way.norm();
  if (length > kLongestWay * deepest) way *= kLongestWay * deepest / length;
  return way;
}

/// greatest gain of depth per motion of the probe; behind a bevelled edge it is at most sqrt(2)
constexpr double kSteepest = 1.5;

double behindPlane(const Foot& foot) noexcept {
  return foot.behind - foot.aside;  // beside a free edge the plane ends in a bevel of 45 degrees
}

}  // namespace

/// Computes the foot by which a part is felt. Returns false if the part has no foot, or if its plane is certainly more
/// than `reach` [m] from the probe.
bool Tracer::refreshPart(int part, const Vector3d& p, const Vector3d& last, const TraceOptions& options, double reach,
                         Foot& foot) noexcept {
  const Part& known = parts_[static_cast<std::size_t>(part)];
  Contact& contact = contactOf(part);
  const double most = known.depth + kSteepest * (tracks_.pathLength() - known.way);
  if (!contact.state.held() && known.known && most < -reach) return false;
  if (!(options.rule.hysteresis > 0)) {
    hold(part, -1);
    return nearestOfPart(part, p, options, foot);
  }
  Faces faces(*this, part, p, options);
  foot = contact.state.step(faces, last, p, options.rule);
  return contact::found(foot);
}

/// Computes the nearest foot of a part and updates parts_. Returns false if there is none in this tick.
bool Tracer::nearestOfPart(int part, const Vector3d& p, const TraceOptions& options, Foot& foot) noexcept {
  Part& known = parts_[static_cast<std::size_t>(part)];
  const double most = known.depth + kSteepest * (tracks_.pathLength() - known.way);
  if (known.nearest >= 0 && (tracks_[known.nearest].slot < 0 || tracks_[known.nearest].part != part))
    known.nearest = -1;
  if (known.nearest < 0 || known.nearest != nearest_) known.nearest = nearestOf(part, known.nearest, p, options);
  if (known.nearest < 0 || tracks_[known.nearest].tick != tracks_.tick()) return false;
  foot = describe(known.nearest, p, 0);
  if (known.nearest == nearest_ || tracks_.mostPromising(foot.distance, part) < 0) {
    known.known = true;
    known.depth = behindPlane(foot);
    known.way = tracks_.pathLength();
    return true;
  }
  // There was no budget left, and another foot may be nearer. By this foot alone the probe may seem much too deep, so
  // the depth is limited.
  foot.status = FootStatus::kDegraded;
  const double too_deep = behindPlane(foot) - most;
  if (!known.known) return false;
  if (too_deep > 0) {
    foot.behind -= too_deep;
    foot.depth = std::min(foot.depth, most);
  }
  return true;
}

void Tracer::uniteParts(const Vector3d& p, const Vector3d& last, const TraceOptions& options, Foot& foot) noexcept {
  std::array<Foot, Model::kMaxParts> feet;
  std::array<Wall, Model::kMaxParts> walls;
  std::array<double, Model::kMaxParts> pushes{};
  std::array<bool, Model::kMaxParts> seen{};
  int count = 0;
  double deepest = 0;
  // First the parts that contain the probe, then the parts so near that they could block the way out.
  for (int pass = 0; pass < 2 && (pass == 0 || deepest > 0); ++pass) {
    const double reach = deepest;
    for (int part = 0; part < model_.partCount(); ++part) {
      const auto n = static_cast<std::size_t>(count);
      if (seen[static_cast<std::size_t>(part)] || !refreshPart(part, p, last, options, reach, feet[n])) continue;
      seen[static_cast<std::size_t>(part)] = true;
      walls[n] = {feet[n].normal, behindPlane(feet[n])};
      deepest = std::max(deepest, walls[n].depth);
      ++count;
    }
  }
  for (int part = 0; part < model_.partCount(); ++part)
    if (!seen[static_cast<std::size_t>(part)]) contactOf(part).state.pass();
  if (!(deepest > 0)) return;
  const Vector3d way = wayOut(walls.data(), count, deepest, pushes.data());
  const auto pushing = std::count_if(pushes.begin(), pushes.begin() + count, [](double push) { return push > 0; });
  const auto most = static_cast<std::size_t>(std::max_element(pushes.begin(), pushes.begin() + count) - pushes.begin());
  foot = feet[most];
  const double depth = way.norm();
  if (pushing < 2 || !(depth > 0)) return;
  foot.point = p + way;
  foot.normal = way / depth;
  foot.depth = foot.behind = foot.distance = depth;
  foot.aside = 0;
  foot.on_edge = true;
}

}  // namespace hapticd::trace
