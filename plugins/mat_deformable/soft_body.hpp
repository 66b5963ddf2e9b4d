// SPDX-License-Identifier: MIT
/// What the plugin needs of a soft body, whichever form its medial axis has: a grid of points or a mesh.
#pragma once
#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hapticd/shape.h"
#include "kernels/contact/friction.hpp"
#include "kernels/medial/body.hpp"
#include "kernels/medial/mesh_body.hpp"
#include "kernels/medial/moving_mesh.hpp"
#include "kernels/medial/nodes.hpp"

namespace hapticd {

/// How a foot is looked for.
struct FindOptions {
  medial::NewtonOptions newton;
  bool binary = false;  ///< the paper's halving instead
  int halvings = 10;
  double crease = 0;  ///< [m] width over which the force turns from one part of a mesh to another
};

/// One probe on a body.
struct Track {
  medial::SkeletonFoot foot;
  Eigen::Vector3d last{0, 0, 0};    ///< where the probe was
  Eigen::Vector3d pushed{0, 0, 0};  ///< direction in which the surface pushed; zero: it did not
  std::array<double, 2> offer{};    ///< parameters of what the search of the simulation side found last
  bool active = false, known = false, offered = false;
  int side = 0;          ///< of a sheet that it came from; 0: of neither
  bool settled = false;  ///< within a sheet: `pushed` has turned to the direction of the foot
  contact::Friction friction;
  // On a surface that is felt:
  bool met = false;            ///< the probe has been at the surface since it came near; else it may have begun inside
  bool counted = false;        ///< `inside` is that of the last tick
  bool near = false;           ///< the probe was within reach of the swinging surface in the last tick
  medial::SkeletonFoot rival;  ///< another part of the surface that is nearly as deep over the probe, in a valley
  double apart = 0;            ///< 0: there is none, or it is the foot's own place; 1: it is another
  bool swapped = false;        ///< the foot is the rival of the last tick
  uint32_t scanned = 0;        ///< sample of the body that was looked at last
  bool hopped = false;         ///< the foot went to another part of the surface in this tick
  double inside = 0;           ///< [m] by how much the probe was inside the present surface
};

/// The surface as the probe feels it: where it was pushed through the skeleton, still that of the side it came from.
struct Felt {
  Eigen::Vector3d normal{0, 0, 1};
  double depth = 0;
  double steep = 1;  ///< length of the depth's gradient: less than 1 where two parts of the surface push together
  double share = 0;  ///< of the rival, 0 to 1
};
inline constexpr double kSameDirection = 0.99;  ///< cosine of the direction of a foot and the one that is felt
inline constexpr double kTurned = 0.9;          ///< cosine from which on it is another, that turns toward the foot's

/// [rt] 1: a direction with this cosine to that of the foot is the foot's; 0: it is another.
inline double directness(double cosine) noexcept {
  return std::clamp((cosine - kTurned) / (kSameDirection - kTurned), 0.0, 1.0);
}

/// What a person should know of a body before they touch it.
struct Description {
  std::string text;
  bool warning = false;
};

/// What a file says of one place of the body, and what a hand feels there.
struct FeltMaterial {
  Eigen::Vector3d place{0, 0, 0};  ///< [m] on the contour
  double told = 0;                 ///< [N/m] in the file
  double felt = 0, deep = 0;       ///< [N/m] force along the normal over depth, kShallowPress and kDeepPress deep
};
inline constexpr double kShallowPress = 1e-3, kDeepPress = 5e-3;  ///< [m] at most half the radius

class SoftBody {
 public:
  SoftBody() = default;
  SoftBody(const SoftBody&) = delete;
  SoftBody& operator=(const SoftBody&) = delete;
  virtual ~SoftBody() = default;

  /// [rt] Follows the foot of a probe at p; looks all over the body where following may have lost it.
  virtual void find(const Eigen::Vector3d& p, uint32_t flags, const FindOptions& options,
                    Track& track) const noexcept = 0;
  /// [rt] What the probe feels there; `moved` [m] since the last tick.
  virtual Felt felt(const Eigen::Vector3d& p, const Eigen::Vector3d& moved, Track& track) const noexcept = 0;
  /// [rt] The force on a probe so deep.
  virtual medial::BodyForce press(const Eigen::Vector3d& p, const medial::SkeletonFoot& foot, const Felt& felt,
                                  double closing_speed) const noexcept = 0;
  /// [rt] The place that the probe is at, for a surface that is felt.
  virtual void placeOf(const Eigen::Vector3d& p, const medial::SkeletonFoot& foot, const Felt& felt,
                       medial::Envelope envelope, medial::FeltPlace& place) noexcept = 0;
  virtual medial::FeltSurface* feltSurface() noexcept = 0;  ///< [any] nullptr: its dynamics are seen alone
  /// [rt] Gives way to all contacts of a tick, where its dynamics are seen alone.
  virtual void yield(std::span<const medial::Press> contacts) noexcept = 0;
  /// [sim] The foot of p with no start known.
  virtual medial::SkeletonFoot search(const Eigen::Vector3d& p, const FindOptions& options) const noexcept = 0;

  virtual medial::Nodes& nodes() noexcept = 0;  ///< [rt]
  virtual const Eigen::AlignedBox3d& bounds() const noexcept = 0;
  virtual double greatestRadius() const noexcept = 0;                                 ///< [m]
  virtual double greatestStiffness() const noexcept = 0;                              ///< [N/m]
  virtual std::unique_ptr<medial::MovingMesh> contour(double chord_error) const = 0;  ///< [main]
  /// [main] Fine enough for the volume under it to be right to a thousandth.
  virtual std::unique_ptr<medial::MovingMesh> hull() const = 0;
  virtual Description describe(const std::string& file) const = 0;  ///< [main]
  virtual std::vector<FeltMaterial> feltMaterial() const = 0;       ///< [main] one a point of the file
  virtual std::size_t bytes() const noexcept = 0;
};

/// [main] @throws std::invalid_argument that says what is wrong with the data.
std::unique_ptr<SoftBody> makeSoftBody(const medial::BodyData& data, const medial::BodyOptions& options);
std::unique_ptr<SoftBody> makeSoftBody(const medial::MeshBodyData& data, const medial::BodyOptions& options);

}  // namespace hapticd
