// SPDX-License-Identifier: MIT
/// A model of many spline surfaces, ready for tracing: smooth patches, their neighbours, and a tree for global search.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/trace/box_tree.hpp"
#include "kernels/trace/free_sides.hpp"
#include "kernels/trace/patch.hpp"

namespace hapticd::trace {

/// One of the two sides that a model file joins: index of the surface, and number of its side (see patch.hpp).
struct EdgeEnd {
  int surface = 0, side = 0;
};
struct EdgeLink {
  EdgeEnd a, b;
  bool flipped = false;  ///< true if the parameters of the two sides run in opposite directions
};

struct ModelOptions {
  /// [m] Sides that are closer than this are joined. 0 means 1e-5 of the model's diagonal, the usual tolerance of CAD
  /// files.
  double sew_tolerance = 0;
  std::vector<EdgeLink> edges;               ///< sides that are known to be joined; other joints are found by geometry
  spline::Form form = spline::Form::kTable;  ///< how the patches are stored
};

/// A surface near a probe, with the values that an activation record needs.
struct Near {
  int surface = 0;
  double u = 0, v = 0;
  double distance = 0;  ///< [m] distance from the probe, or a lower bound
};

/// The result of a global search.
struct Found {
  std::vector<Near> nearest;  ///< one entry per surface, nearest first
  /// Other local minima of the distance that could become the nearest foot before the next search.
  std::vector<Near> rivals;
};

/// A model that is ready for tracing. It is built once and is then constant, so every const function may run in any
/// thread while a Tracer steps.
class Model {
 public:
  /// [m] Largest change of the difference between two distances until the next search, 5 ms later. It is reached if the
  /// probe moves at 2 m/s toward one surface and away from the other: each distance then changes by 10 mm.
  static constexpr double kSoon = 0.02;
  static constexpr int kMaxParts = 8;

  /// [main] Splits, sews and indexes the surfaces.
  /// @throws std::invalid_argument that names the surface and says what was expected.
  explicit Model(const std::vector<spline::SurfaceData>& surfaces, const ModelOptions& options = {});

  /// [sim] Makes a global search: finds every surface within `radius` [m] of `p` (model frame), nearest first. The
  /// nearest surface of each part, and surfaces that are at most kSoon farther away, are returned with their nearest
  /// foot point. The others are returned with a lower bound of the distance and parameters at which tracing can start.
  /// Rivals are other local minima of the distance on the same surfaces, at most kSoon farther away than the nearest
  /// foot point of the part.
  void search(const Eigen::Vector3d& p, double radius, Found& found) const;
  /// [sim] Makes the same search as search(), but returns no rivals. Writes at most `cap` records. Returns the number
  /// of surfaces within the radius, which may be larger than `cap`.
  std::int64_t nearby(const Eigen::Vector3d& p, double radius, Near* out, std::size_t cap) const;

  /// [any] Returns the number of surfaces in the model file. A surface with creases has several patches.
  int surfaceCount() const noexcept { return static_cast<int>(first_patch_.size()) - 1; }
  int patchCount() const noexcept { return static_cast<int>(patches_.size()); }
  const Patch& patch(int index) const noexcept { return patches_[static_cast<std::size_t>(index)]; }
  /// [any] False if the points of each surface lie in one place or on one line. Such a model has no inside.
  bool hasArea() const noexcept { return has_area_; }
  /// [any] The patches of a surface are those from firstPatch() to lastPatch() - 1. A surface without area has none if
  /// another surface has an area.
  int firstPatch(int surface) const noexcept { return first_patch_[static_cast<std::size_t>(surface)]; }
  int lastPatch(int surface) const noexcept { return first_patch_[static_cast<std::size_t>(surface) + 1]; }

  int shellCount() const noexcept { return static_cast<int>(shell_closed_.size()); }
  /// [any] True if the shell has no free side, so that it bounds a solid.
  bool closed(int shell) const noexcept { return shell_closed_[static_cast<std::size_t>(shell)] != 0; }
  const FreeSides& freeSides() const noexcept { return free_sides_; }
  /// [any] Returns the angle-weighted mean of the outward normals around a corner (Baerentzen & Aanaes 2005): if the
  /// nearest point is that corner, this normal decides whether the probe is outside.
  const Eigen::Vector3d& vertexNormal(int vertex) const noexcept {
    return vertex_normal_[static_cast<std::size_t>(vertex)];
  }
  /// [any] Returns the part to which a shell belongs. Shells that overlap (one ends or passes inside the other) belong
  /// to different parts. Each part is a separate solid, and the probe is outside if it is outside all parts. Other
  /// shells together bound one solid.
  int part(int shell) const noexcept { return part_[static_cast<std::size_t>(shell)]; }
  int partCount() const noexcept { return part_count_; }
  const PoleFan& pole(int index) const noexcept { return poles_[static_cast<std::size_t>(index)]; }

  const Eigen::AlignedBox3d& bounds() const noexcept { return bounds_; }
  /// [main] Returns warnings for the user about this model: T-junctions, edges of three surfaces, neighbours with
  /// opposite normals.
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }
  std::size_t bytes() const noexcept;

 private:
  friend class Sewing;
  /// Makes the patches. Returns the pieces of their sides.
  std::vector<SidePieces> split(const std::vector<spline::SurfaceData>& surfaces, spline::Form form);

  std::vector<Patch> patches_;
  std::vector<int> first_patch_;
  std::vector<PoleFan> poles_;
  std::vector<Eigen::Vector3d> vertex_normal_;
  std::vector<char> shell_closed_;
  FreeSides free_sides_;
  std::vector<int> part_;        ///< part of each shell
  std::vector<int> patch_part_;  ///< part of each patch
  int part_count_ = 1;
  bool has_area_ = true;
  std::vector<std::string> warnings_;
  std::vector<std::string> names_;
  BoxTree tree_;
  Eigen::AlignedBox3d bounds_;
};

}  // namespace hapticd::trace
