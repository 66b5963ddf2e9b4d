// SPDX-License-Identifier: MIT
/// A soft body from a medial mesh: where its surface is, how hard it pushes back, and how it gives way to a probe.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "kernels/medial/body.hpp"
#include "kernels/medial/felt_surface.hpp"
#include "kernels/medial/medial_mesh.hpp"
#include "kernels/medial/nodes.hpp"
#include "kernels/medial/shear.hpp"
#include "kernels/medial/soft_weights.hpp"

namespace hapticd::medial {

/// The body of a model file with a medial mesh. The lists of material have one entry per vertex, or one for all
/// vertices.
struct MeshBodyData {
  MeshData mesh;
  std::vector<double> stiffness;  ///< [N/m]
  std::vector<double> damping;    ///< [N s/m]; empty if the body has no damping
  /// [kg]; empty if the body has no mass: its vertices then return to rest without swinging
  std::vector<double> mass;
};

/// How a medial mesh yields to contacts. Its nodes are the vertices. A contact moves the corners of the cone or slab
/// that holds its foot, and rings of neighbours around them. The weight of a vertex says how far it moves. At first
/// only the corners have weights. Then, once per ring, every vertex gives a part of its weight to its neighbours in
/// equal parts. So the weights do not jump while the contact slides from one element to the next.
class MeshDeformation : public Nodes {
 public:
  /// [main] @throws std::invalid_argument if a material is impossible.
  MeshDeformation(const MedialMesh& mesh, const std::vector<Oscillator>& material, const DeformationOptions& options);

  /// [rt] Moves vertices until the contour at every contact is not outside the probe. Press::u and Press::v are the
  /// parameters of the foot: on a slab the weights of corners 1 and 2, on a cone the position along the axis (0 to 1)
  /// and 0. Without dynamics the displacements come from these contacts alone.
  void press(std::span<const Press> contacts) noexcept;
  /// [rt] Writes to `place` the vertices that shape a felt surface at a foot, with weights and derivatives. The weights
  /// of the corners have zero slope where the mesh ends (soft_weights.hpp). They are spread over `rings` of neighbours,
  /// so that neighbouring cones and slabs yield together.
  void nodesAt(uint32_t element, const Eigen::Array2d& parameter, FeltPlace& place) noexcept;
  /// [rt] Returns the displacement of the skeleton (x, y, z) and the change of the radius at a foot [m].
  Eigen::Vector4d at(uint32_t element, const Eigen::Array2d& parameter) const noexcept;
  std::size_t bytes() const noexcept;

 private:
  static constexpr std::size_t kMostMoved = 128;  ///< most vertices that one contact moves

  struct Reach {
    std::array<NodeWeight, kMostMoved> moved;
    std::array<NodeWeight, 3> felt;
    std::size_t moved_count = 0, felt_count = 0;
  };

  void join(const MedialMesh& mesh);
  void reach(const Press& contact, Reach& out) noexcept;
  void spread(Reach& reach) noexcept;
  void add(Reach& reach, uint32_t node, double weight) noexcept;
  void spread(FeltPlace& place) noexcept;
  PlaceNode& nodeOf(FeltPlace& place, uint32_t node) noexcept;

  const MedialMesh* mesh_;
  std::vector<uint8_t> ends_;  ///< for each vertex: 1 if the mesh ends there
  /// vertex i has the neighbours neighbour_[first_[i]] to neighbour_[first_[i + 1] - 1]
  std::vector<uint32_t> first_, neighbour_;
  /// for each vertex: its index in the list of vertices that is being made; UINT32_MAX if it is not in the list
  std::vector<uint32_t> place_;
  std::vector<Reach> reaches_;  ///< one per contact
};

class MeshBody {
 public:
  /// [main] @throws std::invalid_argument that says what is wrong with the data.
  MeshBody(const MeshBodyData& data, const BodyOptions& options);
  MeshBody(const MeshBody&) = delete;  // deformation_ points to mesh_
  MeshBody& operator=(const MeshBody&) = delete;

  const MedialMesh& mesh() const noexcept { return mesh_; }
  // NOLINTBEGIN(bugprone-unchecked-optional-access): the constructor makes it
  MeshDeformation& deformation() noexcept { return *deformation_; }
  const MeshDeformation& deformation() const noexcept { return *deformation_; }
  // NOLINTEND(bugprone-unchecked-optional-access)

  /// [any] Returns the foot of p. The search starts at element `start`, or at the root of the tree if `start` is
  /// MedialMesh::kNoStart. If p is inside and another part of the body is at most `crease` [m] farther away, the normal
  /// is blended between the two parts, so that the force does not jump where a branch begins. If the search ended at
  /// `most_visits`, the foot is not converged, and its residual says by how much another foot may be nearer.
  SkeletonFoot foot(const Eigen::Vector3d& p, uint32_t start, double crease, int most_visits = INT_MAX) const noexcept;
  /// [rt] Finds the foot of p with its own normal, and as `rival` the most important foot on another part of the body
  /// that is at most `crease` [m] farther away.
  /// @return 0 if there is no rival, 1 if it lies on a clearly separate part; values between if the two feet are just
  /// separating
  double feet(const Eigen::Vector3d& p, uint32_t start, double crease, SkeletonFoot& foot,
              SkeletonFoot& rival) const noexcept;
  /// [rt] Returns the force on a probe at `p`, `depth` [m] below the surface along `normal`: a spring, damping against
  /// `closing_speed` [m/s], and along the surface the slope of the stiffness (see forceAlong()). It is taken within the
  /// cone or slab of the foot, or over `shear_distance`, also on other cones and slabs.
  BodyForce press(const Eigen::Vector3d& p, const SkeletonFoot& foot, const Eigen::Vector3d& normal, double depth,
                  double closing_speed) const noexcept;
  /// [rt] Describes to a felt surface the place where a probe at `p` touches the body.
  /// @param direct 1 if `normal` points from the foot to the probe, 0 if it does not; values between blend the two
  /// cases
  void placeOf(const Eigen::Vector3d& p, const SkeletonFoot& foot, const Eigen::Vector3d& normal, double direct,
               FeltPlace& place) noexcept;
  /// [any] Returns the felt surface; nullptr if the deformation is only drawn and not felt.
  FeltSurface* feltSurface() noexcept { return felt_ ? &*felt_ : nullptr; }
  double greatestStiffness() const noexcept;  ///< [any] [N/m] stiffness of the stiffest vertex
  double stiffness(std::size_t vertex) const noexcept { return stiffness_[stiffness_.size() == 1 ? 0 : vertex]; }
  std::size_t bytes() const noexcept;

 private:
  /// Returns the gradient of the stiffness over the position of a probe [N/m^2].
  Eigen::Vector3d slopeOfStiffness(const Eigen::Vector3d& p, const SkeletonFoot& foot, const Eigen::Vector3d& normal,
                                   double depth) const noexcept;
  SkeletonFoot footOf(const MeshFoot& found) const noexcept;
  /// Returns 0 if both feet are on the same place of the body, 1 if they are on two places.
  double apart(const MeshFoot& a, const MeshFoot& b) const noexcept;
  /// [rad] Returns the angle by which the surface turns where two elements meet and continue each other; negative if
  /// they do not continue each other.
  double bend(const MedialMesh::Element& one, const MedialMesh::Element& other, uint32_t a, uint32_t b) const noexcept;
  /// Returns the same as apart() for two elements that continue each other nearly straight, and 1 for all others.
  double besideStraight(const MeshFoot& a, const MeshFoot& b) const noexcept;
  double material(const std::vector<double>& values, const SkeletonFoot& foot) const noexcept;

  BodyOptions options_;
  MedialMesh mesh_;
  std::vector<double> stiffness_, damping_;  ///< one per vertex, or one for all
  std::optional<MeshDeformation> deformation_;
  std::optional<FeltSurface> felt_;
};

}  // namespace hapticd::medial
