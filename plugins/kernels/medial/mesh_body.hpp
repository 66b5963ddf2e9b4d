// SPDX-License-Identifier: MIT
/// A soft body from a medial mesh: where its surface is, how hard it pushes back, how it gives way.
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

/// What a model file says about a body; one material per vertex, or one for all.
struct MeshBodyData {
  MeshData mesh;
  std::vector<double> stiffness;  ///< [N/m]
  std::vector<double> damping;    ///< [N s/m]; empty: none
  std::vector<double> mass;       ///< [kg]; empty: none, so that vertices creep
};

/// How a medial mesh gives way: its nodes are the vertices. A contact moves the corners of the element that holds its
/// foot and the rings of neighbours round them, with weights that have no jump while it slides from one element to the
/// next: the corners' weights, spread evenly along the edges once a ring.
class MeshDeformation : public Nodes {
 public:
  /// [main] @throws std::invalid_argument if a material is impossible.
  MeshDeformation(const MedialMesh& mesh, const std::vector<Oscillator>& material, const DeformationOptions& options);

  /// [rt] Moves vertices so that the contour is at no contact outside the probe; u, v are weights 1 and 2 of a slab,
  /// u the place along a cone. Without dynamics the displacements are those of these contacts alone.
  void press(std::span<const Press> contacts) noexcept;
  /// [rt] The vertices that shape a felt surface at a foot, with their derivatives: the corners' weights, which lose
  /// their slope where the mesh ends (soft_weights.hpp), spread over `rings` of neighbours, so that neighbouring cones
  /// and slabs yield together.
  void nodesAt(uint32_t element, const Eigen::Array2d& parameter, FeltPlace& place) noexcept;
  /// [rt] Displacement of the skeleton (x, y, z) and change of the radius at a foot [m].
  Eigen::Vector4d at(uint32_t element, const Eigen::Array2d& parameter) const noexcept;
  std::size_t bytes() const noexcept;

 private:
  static constexpr std::size_t kMostMoved = 128;  ///< vertices that one contact moves

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
  std::vector<uint8_t> ends_;                ///< of each vertex, whether the mesh ends there
  std::vector<uint32_t> first_, neighbour_;  ///< neighbours of vertex i: neighbour_[first_[i]] and on
  std::vector<uint32_t> place_;              ///< of a vertex in the list that is being made
  std::vector<Reach> reaches_;               ///< one a contact
};

class MeshBody {
 public:
  /// [main] @throws std::invalid_argument that says what is wrong with the data.
  MeshBody(const MeshBodyData& data, const BodyOptions& options);
  MeshBody(const MeshBody&) = delete;  // the deformation uses the mesh beside it
  MeshBody& operator=(const MeshBody&) = delete;

  const MedialMesh& mesh() const noexcept { return mesh_; }
  MeshDeformation& deformation() noexcept { return *deformation_; }
  const MeshDeformation& deformation() const noexcept { return *deformation_; }

  /// [any] The foot of p, searched from `start` (MedialMesh::kNoStart: from nowhere). Inside, where other parts of the
  /// body are within `crease` [m] as near, the normal turns from one to the other over that width: at the crotch of
  /// a branch the force has no jump. A foot of a search that ended at `most_visits` is not converged, and says by how
  /// much another may be nearer.
  SkeletonFoot foot(const Eigen::Vector3d& p, uint32_t start, double crease, int most_visits = INT_MAX) const noexcept;
  /// [rt] The foot of p with its own normal and, of other parts of the body within `crease` [m] as near, the one that
  /// counts most. @return 0: there is none; 1: it is another part; between: the feet are just separating
  double feet(const Eigen::Vector3d& p, uint32_t start, double crease, SkeletonFoot& foot,
              SkeletonFoot& rival) const noexcept;
  /// [rt] The force on a probe `depth` below the surface along `normal`: spring, and damping against `closing_speed`.
  BodyForce press(const SkeletonFoot& foot, const Eigen::Vector3d& normal, double depth,
                  double closing_speed) const noexcept;
  /// [rt] The same on a probe at `p`, with springs to the contour `shear_distance` beside it, whichever cones and slabs
  /// that is on. They turn the force toward the stiffer neighbour; its part along the normal stays.
  BodyForce press(const Eigen::Vector3d& p, const SkeletonFoot& foot, const Eigen::Vector3d& normal, double depth,
                  double closing_speed) const noexcept;
  /// [rt] The place of the surface that a probe at `p` is at, with its foot, as a felt surface needs it.
  /// @param direct 1: `normal` is the direction from the foot to the probe; 0: it is not; between, in part
  void placeOf(const Eigen::Vector3d& p, const SkeletonFoot& foot, const Eigen::Vector3d& normal, double direct,
               FeltPlace& place) noexcept;
  FeltSurface* feltSurface() noexcept { return felt_ ? &*felt_ : nullptr; }  ///< [any] nullptr: it is only seen
  double greatestStiffness() const noexcept;                                 ///< [any] [N/m]
  double stiffness(std::size_t vertex) const noexcept { return stiffness_[stiffness_.size() == 1 ? 0 : vertex]; }
  std::size_t bytes() const noexcept;

 private:
  std::size_t neighboursOf(const Eigen::Vector3d& surface, const SkeletonFoot& foot, const Eigen::Vector3d& normal,
                           std::array<ShearSpring, 6>& springs) const noexcept;
  SkeletonFoot footOf(const MeshFoot& found) const noexcept;
  /// 0: both feet are on one place of the body; 1: on two.
  double apart(const MeshFoot& a, const MeshFoot& b) const noexcept;
  /// [rad] By how much the surface turns where two elements meet that go on in one another; negative: they do not.
  double bend(const MedialMesh::Element& one, const MedialMesh::Element& other, uint32_t a, uint32_t b) const noexcept;
  /// The same as apart() of elements that go on in one another nearly straight; 1: of all others.
  double besideStraight(const MeshFoot& a, const MeshFoot& b) const noexcept;
  double material(const std::vector<double>& values, const SkeletonFoot& foot) const noexcept;

  BodyOptions options_;
  MedialMesh mesh_;
  std::vector<double> stiffness_, damping_;  ///< one per vertex, or one for all
  std::optional<MeshDeformation> deformation_;
  std::optional<FeltSurface> felt_;
};

}  // namespace hapticd::medial
