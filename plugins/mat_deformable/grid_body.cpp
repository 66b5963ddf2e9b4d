// SPDX-License-Identifier: MIT
/// Soft bodies from a grid of skeleton points.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "foot_scan.hpp"
#include "kernels/medial/contour.hpp"
#include "push_through.hpp"
#include "soft_body.hpp"

namespace hapticd {
namespace {

using Eigen::Vector3d;
using medial::SkeletonFoot;

/// If a probe has moved by more than this share of a cell in a tick, its foot point is searched for on the whole body.
constexpr double kNewPlace = 0.25;
/// [m] If the body is farther from the probe than this, the servo thread does not search the whole body. It waits for
/// the foot that the proximity search offers.
constexpr double kWithinReach = 0.02;
constexpr double kGridHullError = 0.005;  ///< chord error of hull(), as a share of the greatest radius
/// share of the radius; a rival that is less deep than the foot by more than this is dropped
constexpr double kForget = 0.3;
/// share of the radius; a rival on the other flank is searched already if it is less deep by up to this, because a scan
/// of all samples takes many ticks
constexpr double kLookAhead = 0.2;
/// [m] if a probe is farther outside a felt body than this, its foot need not be exact
constexpr double kAloof = 0.01;
constexpr double kLoosely = 1e-6;  ///< [m] error of the distance that is allowed for a probe beyond kAloof
/// If the parameters u and v of an offered foot differ from those of the known foot by more than this together, it
/// counts as another foot.
constexpr double kOtherFoot = 0.02;

class GridBody final : public SoftBody {
 public:
  GridBody(const medial::BodyData& data, const medial::BodyOptions& options)
      : body_(data, options), envelope_(options.envelope), felt_(body_.feltSurface() != nullptr) {
    if (felt_) scan_.emplace(body_.skeleton());
  }

  void find(const Vector3d& p, uint32_t flags, const FindOptions& options, Track& track) const noexcept override {
    const medial::Skeleton& skeleton = body_.skeleton();
    if (options.binary) {
      track.foot = skeleton.bisect(p, options.newton.envelope, options.halvings);
      return;
    }
    const std::array<double, 2>& offer = track.offer;
    const bool jumped = (flags & HSP_IN_JUMP) != 0;
    if (!track.known && track.offered && !jumped) {  // the proximity search has just searched the whole body
      track.foot.u = offer[0];
      track.foot.v = offer[1];
      track.known = true;
      track.last = p;
    }
    const bool far = (p - track.last).squaredNorm() > std::pow(kNewPlace * skeleton.spacing(), 2);
    const bool lost = !track.known || far || jumped;
    const bool matters = skeleton.leastDistance(p) < kWithinReach;
    if (!lost || !matters)
      track.foot = skeleton.nearest(p, track.foot.u, track.foot.v, followed(options.newton, track));
    if (matters && (lost || !track.foot.converged)) {
      track.foot = skeleton.search(p, options.newton);
    } else if (track.offered && std::fabs(offer[0] - track.foot.u) + std::fabs(offer[1] - track.foot.v) > kOtherFoot) {
      const SkeletonFoot other = skeleton.nearest(p, offer[0], offer[1], options.newton);
      if (other.depth > track.foot.depth) track.foot = other;
    }
    if (felt_) followRival(p, options, track);
  }

  Felt felt(const Vector3d& p, const Vector3d& moved, Track& track) const noexcept override {
    return body_.skeleton().curve() ? feltTurning(p, moved, felt_, track) : feltOnSheet(p, moved, felt_, track);
  }

  medial::BodyForce press(const Vector3d& p, const SkeletonFoot& foot, const Felt& felt,
                          double closing_speed) const noexcept override {
    return body_.press(p, foot, felt.normal, felt.depth, closing_speed);
  }
  void placeOf(const Vector3d& p, const SkeletonFoot& foot, const Felt& felt, medial::Envelope envelope,
               medial::FeltPlace& place) noexcept override {
    body_.placeOf(p, foot, felt.normal, envelope, medial::directness(felt.normal.dot(foot.normal)), place);
  }
  medial::FeltSurface* feltSurface() noexcept override { return body_.feltSurface(); }
  void yield(std::span<const medial::Press> contacts) noexcept override { body_.deformation().press(contacts); }
  SkeletonFoot search(const Vector3d& p, const FindOptions& options) const noexcept override {
    return body_.skeleton().search(p, options.newton);
  }

  medial::Nodes& nodes() noexcept override { return body_.deformation(); }
  const Eigen::AlignedBox3d& bounds() const noexcept override { return body_.skeleton().bounds(); }
  double greatestRadius() const noexcept override { return body_.skeleton().radius().greatest(); }
  double greatestStiffness() const noexcept override { return body_.greatestStiffness(); }
  std::unique_ptr<medial::MovingMesh> contour(double chord_error) const override {
    return std::make_unique<medial::Contour>(body_.skeleton(), chord_error);
  }
  std::unique_ptr<medial::MovingMesh> hull() const override { return contour(kGridHullError * greatestRadius()); }
  std::size_t bytes() const noexcept override {
    return sizeof *this - sizeof body_ + body_.bytes() + (scan_ ? scan_->bytes() : 0);
  }

  std::vector<FeltMaterial> feltMaterial() const override {
    std::vector<FeltMaterial> all;
    const auto& [us, vs] = body_.skeleton().parameters();
    const std::size_t rows = body_.skeleton().curve() ? 1 : us.size();
    for (std::size_t i = 0; i < rows; ++i)
      for (const double v : vs) all.push_back(materialAt(us[i], v));
    return all;
  }

  Description describe(const std::string& file) const override {
    const medial::MonotonicityReport check = body_.checkMonotonicity();
    char text[512];
    if (check.holds()) {
      std::snprintf(text, sizeof text,
                    "%zu control points, at rest until touched; with the shear springs the force grows with depth "
                    "everywhere (least slope: %.0f %% of the normal spring's)",
                    body_.deformation().count(), 100 * check.slope);
    } else {
      std::snprintf(
          text, sizeof text,
          "%s: near u = %.3g, v = %.3g the shear springs may pull the hand inward: their rest length over their least "
          "length is %.3g, but must be below %.3g; use shear_distance, or a smaller shear_offset",
          file.c_str(), check.u, check.v, check.ratio, check.limit);
    }
    Description description{text, !check.holds()};
    if (const std::string steep = describeSlope(file); !steep.empty())
      description = {description.warning ? description.text + "; " + steep : steep, true};
    return description;
  }

 private:
  /// Returns a warning if the radius changes too fast along the skeleton, else "".
  std::string describeSlope(const std::string& file) const {
    constexpr double kFootSlope = 0.1;  // [m/m] the foot's normal is then off by 6 degrees
    const medial::Steepness steep = body_.skeleton().steepest();
    const bool nested = steep.slope >= 1;
    if (!nested && !(envelope_ == medial::Envelope::kFoot && steep.slope > kFootSlope)) return "";
    char place[128];
    std::snprintf(place, sizeof place, ": near u = %.3g, v = %.3g the radius changes by %.3g m per metre of skeleton",
                  steep.u, steep.v, steep.slope);
    const char* what =
        nested ? ", but must change by less than 1: some spheres there are inside others, and only the union of all "
                 "spheres is felt; place the points farther apart, or make the radii more equal"
               : ": with envelope: foot the force is aslant there, and a hand that strokes over it feels much less of "
                 "it; use envelope: exact";
    return file + place + what;
  }

  /// Presses the contour above a point of the skeleton, on the side of the normal Su x Sv.
  FeltMaterial materialAt(double u, double v) const {
    const medial::Skeleton& skeleton = body_.skeleton();
    spline::SurfacePoint s;
    skeleton.surface().evaluate1(u, v, s);
    const Vector3d cross = s.Su.cross(s.Sv);
    SkeletonFoot foot;
    foot.u = u, foot.v = v, foot.center = s.S, foot.radius = skeleton.radius().evaluate(u, v).f;
    if (!skeleton.curve() && cross.norm() > 0) foot.across = cross.normalized();
    const Vector3d normal = !foot.across.isZero(0) ? foot.across
                            : s.Sv.norm() > 0      ? s.Sv.unitOrthogonal()
                                                   : Vector3d(Vector3d::UnitZ());
    FeltMaterial material{s.S + foot.radius * normal, body_.stiffness().evaluate(u, v).f, 0, 0};
    const auto press = [&](double deepest) {
      const double depth = std::min(deepest, 0.5 * foot.radius);
      if (!(depth > 0)) return material.told;
      return body_.press(material.place - depth * normal, foot, normal, depth, 0).normal / depth;
    };
    material.felt = press(kShallowPress);
    material.deep = press(kDeepPress);
    return material;
  }

  /// Returns a coarser tolerance for a probe outside a felt body, beyond the reach of its swings. Only the distance
  /// matters there, and its error is of second order in the step, so one evaluation suffices. Bodies that are not felt
  /// keep the exact tolerance, so that their results do not change.
  medial::NewtonOptions followed(medial::NewtonOptions options, const Track& track) const noexcept {
    const double outside = -track.foot.depth;
    if (felt_ && track.known && outside > kAloof)
      options.tolerance = std::max(options.tolerance, std::sqrt(kLoosely * outside));
    return options;
  }

  /// Follows the foot on the other flank of a valley too, so that neither is lost.
  void followRival(const Vector3d& p, const FindOptions& options, Track& track) const noexcept {
    const bool known = track.apart > 0;
    track.apart = 0;
    if (!(track.foot.depth > 0)) return;
    if (known && (isRival(p, track.rival.u, track.rival.v, options, track) || remains(p, track))) return;
    const double ahead = std::max(options.crease, kLookAhead * track.foot.radius);
    if (const auto found = scan_->rival(p, track.foot, ahead, track.scanned))
      isRival(p, (*found)[0], (*found)[1], options, track);
  }

  /// True if the foot that is found from (u, v) is another foot, and nearly as deep. The deeper of both then becomes
  /// the track's foot, the other its rival.
  bool isRival(const Vector3d& p, double u, double v, const FindOptions& options, Track& track) const noexcept {
    const SkeletonFoot other = body_.skeleton().nearest(p, u, v, options.newton);
    if (!other.converged || !accept(other, track)) return false;
    if (track.rival.depth > track.foot.depth) std::swap(track.foot, track.rival);
    return true;
  }

  /// Keeps the rival for some time. Deep in a bend, near the place where its spheres meet, a flank may lose its own
  /// foot while it is still nearly as deep. Its last sphere then continues to push until it is less deep; otherwise its
  /// share of the force would end in one step.
  static bool remains(const Vector3d& p, Track& track) noexcept {
    SkeletonFoot other = track.rival;
    const Vector3d away = p - other.center;
    const double distance = away.norm();
    if (!(distance > 0)) return false;
    other.normal = away / distance;
    other.depth = other.radius - distance;
    return accept(other, track);
  }

  static bool accept(const SkeletonFoot& other, Track& track) noexcept {
    if (other.depth < track.foot.depth - kForget * track.foot.radius) return false;
    const double apart = FootScan::apart(track.foot, other);
    if (!(apart > 0)) return false;
    track.rival = other;
    track.apart = apart;
    return true;
  }

  medial::Body body_;
  std::optional<FootScan> scan_;  ///< only for a felt body
  medial::Envelope envelope_;
  bool felt_;  ///< the newer rules for creases and for a push through the body apply only to felt bodies
};

}  // namespace

std::unique_ptr<SoftBody> makeSoftBody(const medial::BodyData& data, const medial::BodyOptions& options) {
  return std::make_unique<GridBody>(data, options);
}

}  // namespace hapticd
