// SPDX-License-Identifier: MIT
/// What a search looks at: faces with a closed-form foot, pieces of spline surfaces, edges and pieces of edges, poles,
/// triangles.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "kernels/brep/leaf_bow.hpp"
#include "kernels/brep/piece_bow.hpp"
#include "kernels/brep/trim.hpp"

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

/// A nearest point, in the frame of its body.
struct Hit {
  double d2 = std::numeric_limits<double>::infinity();  ///< [m^2] squared distance to the probe
  Eigen::Vector3d point{0, 0, 0};
  double u = 0, v = 0;  ///< of the face; edges and pieces: u is t; triangles: s and t of triangleFoot()
  Element element;
  std::uint8_t region = 0;  ///< triangles: TriangleRegion; edges and pieces: EdgeRegion
};

enum class EdgeRegion : std::uint8_t { kInside, kFirst, kLast };

/// A trimmed face, ready for search.
struct FaceShape {
  Eigen::Vector3d o{0, 0, 0}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  ///< unit axes
  double r0 = 0, r1 = 0;  ///< [m] radii; cone: radius at v = 0, slope dr/ds along the slant line
  double rise = 1;        ///< cone: dz/ds
  double per_x = 1,
         per_y = 1;    ///< plane: parameters per metre; others: per_y is v per metre of z, or of the slant line
  double nappe = 1;    ///< -1: the face is where the radius is negative (far nappe, inside of a spindle torus)
  double outward = 1;  ///< sign of the outward normal relative to the radial one, or for planes to x cross y
  Eigen::Array2d middle{0, 0};  ///< of [lo, hi]
  Eigen::Array2d period{0, 0};  ///< 0: none
  SurfaceKind kind = SurfaceKind::kPlane;
  Trim trim;
};

/// An edge that is a line or a circle.
struct EdgeShape {
  Eigen::Vector3d o{0, 0, 0}, x{1, 0, 0}, y{0, 1, 0};  ///< line: unit x; circle: unit x and y
  double t0 = 0, t1 = 0;
  double size = 1;                                                  ///< line: [m] per t; circle: [m] radius
  std::uint32_t guise = std::numeric_limits<std::uint32_t>::max();  ///< of a spline: which of the model's guised edges
};

/// A piece of a face without a closed-form foot, flat enough that Newton's method converges directly to its foot.
struct Leaf {
  Eigen::Array2d lo, hi;  ///< of (u, v)
  float bend_front = 0;   ///< [1/m] the piece curves toward its outward normal by at most this; 0: not at all
  float bend_back = 0;    ///< likewise toward the other side
  std::uint32_t face = 0;
  std::uint32_t borders = 0;  ///< bit 2 axis + (0: lo, 1: hi): the surface ends there, or its loops' box
  LeafBow bow;

  Eigen::Array2d middle() const noexcept { return 0.5 * (lo + hi); }
};

/// A piece of an edge that is an ellipse or a spline.
struct CurvePiece {
  double t0 = 0, t1 = 0;
  double bend = 0;  ///< [1/m] largest curvature
  std::uint32_t edge = 0;
  std::uint32_t ends = 0;  ///< bit 0: t0 is the edge's, bit 1: t1 is
  PieceBow shape{};
};

}  // namespace hapticd::brep
