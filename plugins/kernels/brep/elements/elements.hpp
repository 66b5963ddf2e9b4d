// SPDX-License-Identifier: MIT
/// The elements that a search examines: faces with a closed-form foot, leaves (pieces of other faces), edges and pieces
/// of edges, poles, triangles.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "kernels/brep/elements/leaf_curvature.hpp"
#include "kernels/brep/elements/piece_curvature.hpp"
#include "kernels/brep/geometry/trim.hpp"

namespace hapticd::brep {

enum class ElementKind : std::uint32_t {
  kFace = 0,      ///< index in faces: a trimmed plane, cylinder, cone, sphere or torus
  kLeaf = 1,      ///< index in leaves
  kLine = 2,      ///< index in edges
  kCircle = 3,    ///< index in edges
  kPiece = 4,     ///< index in pieces
  kPole = 5,      ///< index in edges: an edge that is a single point
  kTriangle = 6,  ///< index in triangles
  kNothing = 7
};

/// Kind and index of an element in one word.
struct Element {
  std::uint32_t code = 0xffffffffu;

  constexpr Element() = default;
  constexpr Element(ElementKind kind, std::uint32_t index) : code(static_cast<std::uint32_t>(kind) << 29 | index) {}
  constexpr ElementKind kind() const noexcept { return static_cast<ElementKind>(code >> 29); }
  constexpr std::uint32_t index() const noexcept { return code & kMostElements; }
  friend constexpr bool operator==(const Element&, const Element&) = default;

  static constexpr std::uint32_t kMostElements = (1u << 29) - 1;
};

/// The nearest point on one element, in the frame of its body.
struct Hit {
  double d2 = std::numeric_limits<double>::infinity();  ///< [m^2] squared distance to the probe
  Eigen::Vector3d point{0, 0, 0};
  /// Parameters on the face; for edges and pieces u is t; for triangles s and t of triangleFoot().
  double u = 0, v = 0;
  Element element;
  std::uint8_t region = 0;  ///< TriangleRegion for triangles, EdgeRegion for edges and pieces
};

enum class EdgeRegion : std::uint8_t { kInside, kFirst, kLast };

/// A trimmed face, ready for search.
struct FaceShape {
  Eigen::Vector3d o{0, 0, 0}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  ///< unit axes
  double r0 = 0, r1 = 0;  ///< [m] radii; for a cone, radius at v = 0 and slope dr/ds along the slant line
  double rise = 1;        ///< for a cone, dz/ds along the slant line
  /// On a plane: parameters per metre. On other surfaces per_y is v per metre of z, or per metre of the slant line.
  double per_x = 1, per_y = 1;
  /// -1 if the face lies where the radius of the surface is negative (the far nappe of a cone, the inner part of a
  /// spindle torus), else 1.
  double nappe = 1;
  double outward = 1;  ///< +1 or -1: outward normal relative to the radial direction, or to x cross y for planes
  Eigen::Array2d middle{0, 0};  ///< middle of [lo, hi] of the face
  Eigen::Array2d period{0, 0};  ///< of u and v; 0 if not periodic
  SurfaceKind kind = SurfaceKind::kPlane;
  Trim trim;
};

/// An edge that is a line or a circle.
struct EdgeShape {
  /// For a line x is its direction, for a circle x and y span its plane; all unit.
  Eigen::Vector3d o{0, 0, 0}, x{1, 0, 0}, y{0, 1, 0};
  double t0 = 0, t1 = 0;
  double size = 1;  ///< line: [m] per unit of t; circle: [m] radius
  /// Index for Model::recognised() if the curve in the file is a spline, else kNone.
  std::uint32_t recognised = std::numeric_limits<std::uint32_t>::max();
};

/// A piece of a face without a closed-form foot, flat enough that Newton's method converges directly to its foot.
struct Leaf {
  Eigen::Array2d lo{0, 0}, hi{0, 0};  ///< range of (u, v)
  LeafCurvature curvature;
  Coarse curvature_front;  ///< [1/m] largest curvature toward the outward normal; 0 if it never curves that way
  Coarse curvature_back;   ///< the same toward the other side
  std::uint32_t face = 0;
  /// Bit 2 * axis is set if the surface, or the box of its loops, ends on the low side of that axis; bit 2 * axis + 1
  /// if it ends on the high side.
  std::uint8_t borders = 0;

  Eigen::Array2d middle() const noexcept { return 0.5 * (lo + hi); }
};

/// A piece of an edge that is an ellipse or a spline.
struct CurvePiece {
  double t0 = 0, t1 = 0;
  PieceCurvature curvature{};
  std::uint32_t edge : 30 = 0;
  std::uint32_t ends : 2 = 0;  ///< bit 0 is set if t0 is the t0 of the edge, bit 1 if t1 is its t1

  static constexpr std::uint32_t kMostEdges = (1u << 30) - 1;
};

// A part has many of them. Where they go beyond the cache, they cost time too.
static_assert(sizeof(Leaf) <= 176 && sizeof(CurvePiece) <= 104);

}  // namespace hapticd::brep
