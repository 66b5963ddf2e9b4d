// SPDX-License-Identifier: MIT
#include "kernels/medial/body.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;

/// samples of the monotonicity check per interval of the grid, along each direction
constexpr int kChecksPerInterval = 2;
constexpr double kSameValue = 1e-300;
/// A direction lies fully on one side of a sheet if its cosine to the sheet's normal is above 1 / this.
constexpr double kSideways = 2;

/// Makes a field from the samples of the grid. The samples of a curve are used for both rows of its surface.
ScalarField fieldOf(const Skeleton& skeleton, std::vector<double> samples, const SkeletonGrid& grid, const char* what) {
  if (samples.size() != grid.points.size())
    throw std::invalid_argument(std::string(what) + ": " + std::to_string(samples.size()) + " values, expected " +
                                std::to_string(grid.points.size()) + ", one for each point");
  if (skeleton.curve()) {
    const std::vector<double> row = samples;
    samples.insert(samples.end(), row.begin(), row.end());
  }
  try {
    return ScalarField(skeleton.parameters(), samples);
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(std::string(what) + ": " + e.what());
  }
}

std::vector<double> orZeros(const std::vector<double>& samples, std::size_t count) {
  return samples.empty() ? std::vector<double>(count, 0) : samples;
}

}  // namespace

BodyForce BodyForce::weakened(double share, const Vector3d& outward) const noexcept {
  BodyForce weak = *this;
  if (share == 1) return weak;
  weak.elastic *= share;
  weak.force -= (1 - share) * elastic;
  weak.normal = weak.force.dot(outward);
  if (weak.normal < 0) weak.force -= weak.normal * outward;
  weak.normal = std::max(0.0, weak.normal);
  return weak;
}

Body::Body(const BodyData& data, const BodyOptions& options)
    : options_(options), skeleton_(data.grid, options.degree, options.form) {
  stiffness_ = fieldOf(skeleton_, data.stiffness, data.grid, "stiffness");
  damping_ = fieldOf(skeleton_, orZeros(data.damping, data.grid.points.size()), data.grid, "damping");
  const std::vector<Oscillator> material = materialOf(data);
  options_.deformation.shear_reach = data.shear_reach;
  deformation_.emplace(skeleton_, material, options_.deformation);
  if (options.felt.on)
    felt_.emplace(*deformation_, tissueOf(material), deformation_->compliance(), options.felt.contact_ratio,
                  options.felt.tick);
  skeleton_.trim();
}

std::vector<Tissue> Body::tissueOf(const std::vector<Oscillator>& material) const {
  std::vector<Tissue> all;
  for (const Oscillator& o : material)
    all.push_back({o.stiffness, o.damping, o.mass, options_.felt.relaxation_share, options_.felt.relaxation_time});
  return all;
}

void Body::placeOf(const Vector3d& p, const SkeletonFoot& foot, const Vector3d& normal, Envelope envelope,
                   double direct, FeltPlace& place) const noexcept {
  deformation_->nodesAt(foot.u, foot.v, place);
  place.normal = normal;
  place.stiffness = stiffness_.evaluate(foot.u, foot.v).f;
  const FootMotion motion = footMotion(skeleton_, p, foot, normal, envelope, direct);
  place.toward_u = motion.toward_u;
  place.toward_v = motion.toward_v;
  place.tangent_u = motion.tangent_u;
  place.tangent_v = motion.tangent_v;
  place.turn = motion.turn;
}

/// Returns the material of each control point: the body's material at the place where the point acts most.
std::vector<Oscillator> Body::materialOf(const BodyData& data) const {
  const ScalarField mass = fieldOf(skeleton_, orZeros(data.mass, data.grid.points.size()), data.grid, "mass");
  if (mass.constant() && damping_.constant() && stiffness_.constant())
    return {Oscillator{mass.greatest(), damping_.greatest(), stiffness_.greatest()}};
  const ControlGrid& control = skeleton_.control();
  std::vector<Oscillator> material;
  for (const double u : control.greville[0])
    for (const double v : control.greville[1])
      material.push_back({mass.evaluate(u, v).f, damping_.evaluate(u, v).f, stiffness_.evaluate(u, v).f});
  return material;
}

/// Finds four points of the contour at rest beside the contact. From the contact to each point, the normal turns as the
/// skeleton's normal does. The springs fade out toward the rim, so that the force does not jump there.
Body::Neighbours Body::neighboursOf(const SkeletonFoot& foot, const Vector3d& normal) const noexcept {
  Neighbours neighbours;
  if (!springs()) return neighbours;
  const double here = stiffness_.evaluate(foot.u, foot.v).f;
  const double side = std::clamp(kSideways * normal.dot(foot.across), -1.0, 1.0);  // changes continuously round the rim
  spline::SurfacePoint s;
  for (std::size_t axis = skeleton_.curve() ? 1 : 0; axis < 2; ++axis) {
    const auto& range = skeleton_.parameters()[axis];
    const double offset = options_.shear_offset * (range.back() - range.front());
    for (const double sign : {-1.0, 1.0}) {
      std::array<double, 2> at{foot.u, foot.v};
      const double start = at[axis];
      at[axis] = std::clamp(start + sign * offset, range.front(), range.back());
      const double share = std::fabs(at[axis] - start) / offset;
      if (!(share > 0)) continue;
      skeleton_.surface().evaluate1(at[0], at[1], s);
      const Vector3d cross = s.Su.cross(s.Sv);
      const double area = cross.norm();
      Vector3d turned = normal;
      if (area > 0) turned += side * (cross / area - foot.across);
      const double length = turned.norm();
      if (!(length > 0)) continue;
      ShearSpring& spring = neighbours.springs[neighbours.count++];
      spring.anchor = s.S + skeleton_.radius().evaluate(at[0], at[1]).f / length * turned;
      spring.stiffness = share * 0.5 * (here + stiffness_.evaluate(at[0], at[1]).f);
    }
  }
  return neighbours;
}

std::array<double, 2> Body::slopesAlong(const SkeletonFoot& foot, const FootMotion& motion) const noexcept {
  const ScalarField::Value k = stiffness_.evaluate(foot.u, foot.v);
  std::array<double, 2> slopes{k.fu, k.fv};
  for (std::size_t axis = 0; axis < 2 && options_.shear_distance > 0; ++axis) {
    const auto& range = skeleton_.parameters()[axis];
    const double metres = (axis == 0 ? motion.tangent_u : motion.tangent_v).norm();  // per unit of the parameter
    const double whole = range.back() - range.front();
    const double offset = metres * whole > options_.shear_distance ? options_.shear_distance / metres : whole;
    std::array<double, 2> low{foot.u, foot.v}, high = low;
    low[axis] = std::max(low[axis] - offset, range.front());
    high[axis] = std::min(high[axis] + offset, range.back());
    slopes[axis] =
        (stiffness_.evaluate(high[0], high[1]).f - stiffness_.evaluate(low[0], low[1]).f) / (high[axis] - low[axis]);
  }
  return slopes;
}

Vector3d Body::slopeOfStiffness(const Vector3d& p, const SkeletonFoot& foot, const Vector3d& normal) const noexcept {
  const double direct = directness(normal.dot(foot.normal));
  const FootMotion motion = footMotion(skeleton_, p, foot, normal, options_.envelope, direct);
  const std::array<double, 2> slopes = slopesAlong(foot, motion);
  return slopes[0] * motion.toward_u + slopes[1] * motion.toward_v;
}

BodyForce Body::press(const Vector3d& p, const SkeletonFoot& foot, const Vector3d& normal, double depth,
                      double closing_speed) const noexcept {
  BodyForce result;
  if (!(depth > 0)) return result;
  const Vector3d surface = p + depth * normal;
  const Neighbours neighbours = neighboursOf(foot, normal);
  const std::span<const ShearSpring> springs(neighbours.springs.data(), neighbours.count);
  result.stiffness = stiffness_.evaluate(foot.u, foot.v).f;
  result.energy = 0.5 * result.stiffness * depth * depth;
  for (const ShearSpring& spring : springs) {
    const double stretch = (spring.anchor - p).norm() - (spring.anchor - surface).norm();
    result.energy += 0.5 * spring.stiffness * stretch * stretch;
  }
  const double outward = pressForce(p, surface, normal, result.stiffness, depth, springs).dot(normal);
  const double pushes = std::max(0.0, outward);
  Vector3d along = Vector3d::Zero();
  if (!stiffness_.constant() && result.stiffness > 0)
    along = forceAlong(slopeOfStiffness(p, foot, normal), normal, result.energy / result.stiffness, pushes);
  result.elastic = pushes * normal + along;
  const double drag = std::isfinite(closing_speed) ? damping_.evaluate(foot.u, foot.v).f *
                                                         std::min(1.0, depth / options_.damping_scale) * closing_speed
                                                   : 0;
  result.normal = std::max(0.0, outward + drag);  // a surface does not pull
  result.force = result.normal * normal + along;
  return result;
}

/// If the far end of a spring lies below the contact, the spring gets shorter while the contact comes down to that
/// level, and it pushes the probe inward. At worst it reduces the slope of the normal spring by its stiffness times
/// (rest length / least length - 1).
void Body::checkMonotonicityAt(const SkeletonFoot& at, const Vector3d& normal, MonotonicityReport& report) const {
  const double k = stiffness_.evaluate(at.u, at.v).f;
  const Neighbours neighbours = neighboursOf(at, normal);
  double slope = k, worst = 1, total = 0;
  for (std::size_t i = 0; i < neighbours.count; ++i) {
    const ShearSpring& spring = neighbours.springs[i];
    const Vector3d chord = spring.anchor - (at.center + at.radius * normal);
    const double down = -chord.dot(normal), level = (chord + down * normal).norm();
    total += spring.stiffness;
    if (!(down > 0)) continue;
    const double ratio = chord.norm() / std::max(level, kSameValue);
    slope += spring.stiffness * (1 - ratio);
    worst = std::max(worst, ratio);
  }
  if (!(k > 0) || !(slope / k < report.slope)) return;
  report = {slope / k, worst, total > 0 ? 1 + k / total : HUGE_VAL, at.u, at.v};
}

MonotonicityReport Body::checkMonotonicity() const {
  MonotonicityReport report;
  if (!springs()) return report;
  const auto visit = [&](double u, double v) {
    SkeletonFoot at;
    spline::SurfacePoint s;
    skeleton_.surface().evaluate1(u, v, s);
    const Vector3d cross = s.Su.cross(s.Sv);
    at.u = u, at.v = v, at.center = s.S, at.radius = skeleton_.radius().evaluate(u, v).f;
    if (cross.norm() > 0) at.across = cross.normalized();
    if (skeleton_.curve()) {
      const Vector3d side = s.Sv.unitOrthogonal(), other = s.Sv.cross(side).normalized();
      for (const Vector3d& normal : {side, Vector3d(-side), other, Vector3d(-other)})
        checkMonotonicityAt(at, normal, report);
    } else if (cross.norm() > 0) {
      checkMonotonicityAt(at, at.across, report);
      checkMonotonicityAt(at, -at.across, report);
    }
  };
  const auto& [tu, tv] = skeleton_.parameters();
  const int rows = skeleton_.curve() ? 0 : kChecksPerInterval * (static_cast<int>(tu.size()) - 1);
  const int columns = kChecksPerInterval * (static_cast<int>(tv.size()) - 1);
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j <= columns; ++j)
      visit(rows > 0 ? tu.front() + (tu.back() - tu.front()) * i / rows : tu.front(),
            tv.front() + (tv.back() - tv.front()) * j / columns);
  return report;
}

std::size_t Body::bytes() const noexcept {
  return sizeof *this - sizeof skeleton_ + skeleton_.bytes() + stiffness_.bytes() + damping_.bytes() +
         deformation_->bytes() + (felt_ ? felt_->bytes() : 0);
}

}  // namespace hapticd::medial
