// SPDX-License-Identifier: MIT
/// The interface of a soft body to the plugin. Its medial axis is either a grid of points or a mesh.
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
#include "kernels/medial/energy_account.hpp"
#include "kernels/medial/mesh_body.hpp"
#include "kernels/medial/moving_mesh.hpp"
#include "kernels/medial/nodes.hpp"

namespace hapticd {

/// How the foot point is searched for.
struct FindOptions {
  medial::NewtonOptions newton;
  bool binary = false;  ///< true: uses the bisection of Corso et al. 2002 instead of Newton's method
  int halvings = 10;
  double crease = 0;  ///< [m] width over which the force turns from one part of a mesh to another; see MeshBody::foot()
};

/// The values of one probe on a body that are kept from tick to tick.
struct Track {
  medial::SkeletonFoot foot;
  Eigen::Vector3d last{0, 0, 0};    ///< [m] position of the probe in the last tick
  Eigen::Vector3d pushed{0, 0, 0};  ///< direction in which the surface pushed in the last tick; zero if it did not push
  std::array<double, 2> offer{};    ///< parameters of the foot that the proximity search found last
  bool active = false, known = false, offered = false;
  int side = 0;          ///< side of a sheet from which the probe came, +1 or -1; 0 if the side is not decided
  bool settled = false;  ///< in the interior of a sheet: `pushed` has turned fully to the direction of the foot
  contact::Friction friction;
  medial::EnergyAccount account;     ///< of a body at rest; a felt surface has one for all probes
  Eigen::Vector3d exerted{0, 0, 0};  ///< [N] force without friction in the last tick
  bool pressed = false;              ///< it was pushed in the last tick
  bool missed = false;               ///< its last sample was bad
  // The following is used only on a felt surface:
  /// true if the probe was already located in an earlier tick since it came near; if false, the probe may have begun
  /// inside
  bool met = false;
  bool counted = false;  ///< true if `inside` was set in the last tick
  bool near = false;     ///< the probe was within reach of the swinging surface in the last tick
  /// in a valley: the foot on the other flank, if the probe is nearly as deep below that flank
  medial::SkeletonFoot rival;
  /// 0 if there is no rival, or if the rival is the same foot; 1 if the two feet are clearly separate. Values between
  /// occur while the two feet move apart
  double apart = 0;
  bool swapped = false;  ///< true if the foot was the rival of the last tick
  uint32_t scanned = 0;  ///< index of the sample that the search for a rival examined last
  bool hopped = false;   ///< true if the foot jumped to another part of the surface in this tick
  double inside = 0;     ///< [m] depth of the probe below the displaced surface

  /// [rt] Where the probe is met next, it counts as put there.
  void forgetPress() noexcept {
    met = pressed = false;
    exerted.setZero();
  }
};

/// [rt] Returns the work [J] of a hand in the first tick of a contact, for its account: at most the energy of the
/// springs. A foot that was found late begins deep, where nobody has pressed. A probe that was put there, or whose last
/// samples were bad, counts as pressed.
inline double firstWork(const Eigen::Vector3d& force, const Eigen::Vector3d& moved, double energy) noexcept {
  return moved.isZero(0) ? energy : std::clamp(-0.5 * force.dot(moved), 0.0, energy);
}

/// The surface that the probe feels. After a push through the skeleton, this is still the surface of the side from
/// which the probe came.
struct Felt {
  Eigen::Vector3d normal{0, 0, 1};
  double depth = 0;
  double steep = 1;  ///< length of the depth's gradient; less than 1 if two parts of the surface push together
  double share = 0;  ///< weight of the rival (see rivalShare()), 0 to 1
};
/// What a person should know about a body before touching it.
struct Description {
  std::string text;
  bool warning = false;
};

/// The stiffness at one point of the body: the number in the file, and the stiffness that a hand feels.
struct FeltMaterial {
  Eigen::Vector3d place{0, 0, 0};  ///< [m] point on the contour
  double told = 0;                 ///< [N/m] stiffness in the file
  double felt = 0, deep = 0;       ///< [N/m] normal force divided by depth, at the depths kShallowPress and kDeepPress
};
inline constexpr double kShallowPress = 1e-3, kDeepPress = 5e-3;  ///< [m] depths, limited to half the radius

class SoftBody {
 public:
  SoftBody() = default;
  SoftBody(const SoftBody&) = delete;
  SoftBody& operator=(const SoftBody&) = delete;
  virtual ~SoftBody() = default;

  /// [rt] Follows the foot of a probe at p. If the foot may have been lost, searches the whole body.
  virtual void find(const Eigen::Vector3d& p, uint32_t flags, const FindOptions& options,
                    Track& track) const noexcept = 0;
  /// [rt] Returns the surface that the probe feels at p.
  /// @param moved [m] motion of the probe since the last tick
  virtual Felt felt(const Eigen::Vector3d& p, const Eigen::Vector3d& moved, Track& track) const noexcept = 0;
  /// [rt] Returns the force on a probe at p, at the depth `felt.depth`. @param closing_speed [m/s] speed at which the
  /// depth grows
  virtual medial::BodyForce press(const Eigen::Vector3d& p, const medial::SkeletonFoot& foot, const Felt& felt,
                                  double closing_speed) const noexcept = 0;
  /// [rt] Describes to a felt surface the place where the probe touches it.
  virtual void placeOf(const Eigen::Vector3d& p, const medial::SkeletonFoot& foot, const Felt& felt,
                       medial::Envelope envelope, medial::FeltPlace& place) noexcept = 0;
  /// [any] nullptr if the dynamics are only drawn and not felt
  virtual medial::FeltSurface* feltSurface() noexcept = 0;
  /// [rt] Moves the body under all contacts of a tick, if the dynamics are only drawn and not felt.
  virtual void yield(std::span<const medial::Press> contacts) noexcept = 0;
  /// [sim] Returns the foot of p, by a search without a known start.
  virtual medial::SkeletonFoot search(const Eigen::Vector3d& p, const FindOptions& options) const noexcept = 0;

  virtual medial::Nodes& nodes() noexcept = 0;  ///< [rt] the moving parts of the body
  virtual const Eigen::AlignedBox3d& bounds() const noexcept = 0;
  virtual double greatestRadius() const noexcept = 0;     ///< [m] greatest radius of all spheres
  virtual double greatestStiffness() const noexcept = 0;  ///< [N/m] greatest slope of the force over depth
  virtual std::unique_ptr<medial::MovingMesh> contour(double chord_error) const = 0;  ///< [main] a mesh for drawing
  /// [main] Returns a mesh that is fine enough for the body's volume to be right to a thousandth.
  virtual std::unique_ptr<medial::MovingMesh> hull() const = 0;
  virtual Description describe(const std::string& file) const = 0;  ///< [main] text for the log
  virtual std::vector<FeltMaterial> feltMaterial() const = 0;       ///< [main] one per point of the file
  virtual std::size_t bytes() const noexcept = 0;
};

/// [main] @throws std::invalid_argument that says what is wrong with the data.
std::unique_ptr<SoftBody> makeSoftBody(const medial::BodyData& data, const medial::BodyOptions& options);
std::unique_ptr<SoftBody> makeSoftBody(const medial::MeshBodyData& data, const medial::BodyOptions& options);

}  // namespace hapticd
