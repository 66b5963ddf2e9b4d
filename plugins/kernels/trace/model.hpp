// SPDX-License-Identifier: MIT
/// A model of many spline surfaces, ready for tracing: smooth patches, what adjoins what, and a tree for global search.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/trace/box_tree.hpp"
#include "kernels/trace/patch.hpp"

namespace hapticd::trace {

/// One end of an adjacency that a model file states: surface and side (see patch.hpp).
struct EdgeEnd {
  int surface = 0, side = 0;
};
struct EdgeLink {
  EdgeEnd a, b;
  bool flipped = false;  ///< the parameters along the edge run against each other
};

struct ModelOptions {
  /// [m] Sides closer than this are one edge. 0: 1e-5 of the model's diagonal, the usual tolerance of CAD files.
  double sew_tolerance = 0;
  std::vector<EdgeLink> edges;               ///< known adjacency; the rest is found by geometry
  spline::Form form = spline::Form::kTable;  ///< how the patches are stored
};

/// A surface near a probe, as an activation record needs it.
struct Near {
  int surface = 0;
  double u = 0, v = 0;
  double distance = 0;  ///< [m]
};

/// What a global search finds.
struct Found {
  std::vector<Near> nearest;  ///< one a surface, nearest first
  std::vector<Near> rivals;   ///< other local feet that could become the nearest before the next search
};

/// Built once, then constant: every const function may run in any thread while a Tracer steps.
class Model {
 public:
  /// [m] How much nearer than another a surface can come before the next search: 10 ms at 2 m/s, toward one and away
  /// from the other.
  static constexpr double kSoon = 0.02;
  static constexpr int kMaxParts = 8;

  /// [main] Splits, sews and indexes the surfaces.
  /// @throws std::invalid_argument that names the surface and says what was expected.
  explicit Model(const std::vector<spline::SurfaceData>& surfaces, const ModelOptions& options = {});

  /// [sim] Global search: every surface within `radius` [m] of `p` (model frame), nearest first. The nearest of each
  /// part, and those at most kSoon farther, come with their global foot; the others with a lower bound of the distance
  /// and a parameter to start from. Rivals are feet in other valleys of the same surfaces, at most kSoon farther than
  /// the part's nearest.
  void search(const Eigen::Vector3d& p, double radius, Found& found) const;
  /// [sim] The same without rivals. Writes at most `cap` records and returns how many surfaces there are, even beyond.
  std::int64_t nearby(const Eigen::Vector3d& p, double radius, Near* out, std::size_t cap) const;

  /// [any] Number of surfaces in the model file; a surface with creases holds several patches.
  int surfaceCount() const noexcept { return static_cast<int>(first_patch_.size()) - 1; }
  int patchCount() const noexcept { return static_cast<int>(patches_.size()); }
  const Patch& patch(int index) const noexcept { return patches_[static_cast<std::size_t>(index)]; }
  /// [any] Patches [first, last) of a surface.
  int firstPatch(int surface) const noexcept { return first_patch_[static_cast<std::size_t>(surface)]; }
  int lastPatch(int surface) const noexcept { return first_patch_[static_cast<std::size_t>(surface) + 1]; }

  int shellCount() const noexcept { return static_cast<int>(shell_closed_.size()); }
  /// [any] True if the shell has no free side: it bounds a solid.
  bool closed(int shell) const noexcept { return shell_closed_[static_cast<std::size_t>(shell)] != 0; }
  /// [any] Angle-weighted mean of the outward normals around a corner (Baerentzen & Aanaes 2005): its side decides
  /// inside and outside when the nearest point is that corner.
  const Eigen::Vector3d& vertexNormal(int vertex) const noexcept {
    return vertex_normal_[static_cast<std::size_t>(vertex)];
  }
  /// [any] Shells that run into each other (one ends or passes inside the other) belong to different parts: each part
  /// is a solid of its own, and the probe is outside if it is outside all of them. Other shells bound one solid
  /// together.
  int part(int shell) const noexcept { return part_[static_cast<std::size_t>(shell)]; }
  int partCount() const noexcept { return part_count_; }
  const PoleFan& pole(int index) const noexcept { return poles_[static_cast<std::size_t>(index)]; }

  const Eigen::AlignedBox3d& bounds() const noexcept { return bounds_; }
  /// [main] What a person should know of this model: T-junctions, edges of three surfaces, sides that disagree.
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }
  std::size_t bytes() const noexcept;

 private:
  friend class Sewing;
  void split(const std::vector<spline::SurfaceData>& surfaces, spline::Form form);

  std::vector<Patch> patches_;
  std::vector<int> first_patch_;
  std::vector<PoleFan> poles_;
  std::vector<Eigen::Vector3d> vertex_normal_;
  std::vector<char> shell_closed_;
  std::vector<int> part_;        ///< by shell
  std::vector<int> patch_part_;  ///< by patch
  int part_count_ = 1;
  std::vector<std::string> warnings_;
  std::vector<std::string> names_;
  BoxTree tree_;
  Eigen::AlignedBox3d bounds_;
};

}  // namespace hapticd::trace
