// SPDX-License-Identifier: MIT
/// A boundary representation, with the same records, byte for byte, as in a part file (hapticd-part/1,
/// driver/docs/part_file.md). Lengths are in m, angles in rad. Indices count from 0 in the part's own arrays.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace hapticd::brep {

/// An index that points to nothing.
inline constexpr std::uint32_t kNone = 0xffffffffu;
/// Largest absolute value of coordinates and radii [m].
inline constexpr double kFarthestPart = 1e6;
/// Largest absolute value of the coordinates of all points of faces and edges [m]. A plane with wide bounds reaches
/// farther than its axes. Squares of their sums must be finite in single precision.
inline constexpr double kFarthestReach = 1e15;

using Vector = std::array<double, 3>;
using Vector2 = std::array<double, 2>;

enum class SurfaceKind : std::uint32_t {
  kPlane = 0,      ///< o + u x + v y
  kCylinder = 1,   ///< o + r0 (cos u x + sin u y) + v z
  kCone = 2,       ///< o + (r0 + v r1) (cos u x + sin u y) + v z
  kSphere = 3,     ///< o + r0 (cos v (cos u x + sin u y) + sin v z)
  kTorus = 4,      ///< o + (r0 + r1 cos v) (cos u x + sin u y) + r1 sin v z
  kSpline = 5,     ///< B-spline; see Surface::data for its numbers
  kExtrusion = 6,  ///< C(u) + v z, where C is the curve with index `basis`
  /// C(v) turned by u about the axis through o along z (unit), where C is the curve with index `basis`.
  kRevolution = 7,
  kOffset = 8  ///< B(u, v) + r0 n(u, v), where B is the surface with index `basis` and n is Bu x Bv with length 1
};

inline constexpr std::uint32_t kRational = 1;  ///< flag of surfaces and curves: weights follow the points
inline constexpr std::uint32_t kClosedU = 2;   ///< flag of surfaces: u = lo and u = hi are the same line in space
inline constexpr std::uint32_t kClosedV = 4;

/// A surface with the parameters of the imported file, so that the curves in its parameter plane stay exact. The length
/// of an axis is the unit of its parameter: if the parameters of a plane are in mm, its x is 0.001 m long. For
/// cylinders, cones, spheres and tori x and y are unit vectors; for spheres, tori and revolutions z is a unit vector.
/// Frames may be left-handed.
struct Surface {
  SurfaceKind kind = SurfaceKind::kPlane;
  std::uint32_t flags = 0;                ///< kRational, kClosedU, kClosedV
  std::array<std::uint32_t, 2> degree{};  ///< splines: along u, v
  std::array<std::uint32_t, 2> count{};   ///< splines: control points along u, v
  /// Index of the curve of an extrusion or revolution, or of the surface of an offset (lower than its own).
  std::uint32_t basis = kNone;
  std::uint32_t reserved = 0;
  /// Splines: index in `reals` of the first number. The order is: the knots along u (count + degree + 1), the knots
  /// along v, the points (x, y, z; v runs fastest), then the weights if kRational is set. Points are not multiplied by
  /// their weights.
  std::uint64_t data = 0;
  Vector o{}, x{}, y{}, z{};
  std::array<double, 2> r{};       ///< [m] r0 and r1
  std::array<double, 2> period{};  ///< of u and v; 0 if not periodic, as for all splines
  double reserved2 = 0;
};

enum class CurveKind : std::uint32_t {
  kLine = 0,     ///< o + t x
  kCircle = 1,   ///< o + cos t x + sin t y; x and y are as long as the radius
  kEllipse = 2,  ///< o + cos t x + sin t y; x and y are as long as the half axes
  kSpline = 3    ///< B-spline; see Curve3::data for its numbers
};

/// A curve in space [m].
struct Curve3 {
  CurveKind kind = CurveKind::kLine;
  std::uint32_t flags = 0;  ///< kRational
  std::uint32_t degree = 0, count = 0;
  /// Splines: index in `reals` of the first number: knots, points (x, y, z), weights if kRational.
  std::uint64_t data = 0;
  Vector o{}, x{}, y{};
};

/// A curve in the parameter plane of a surface. The fields have the same meaning as in Curve3, but points are (u, v).
struct Curve2 {
  CurveKind kind = CurveKind::kLine;
  std::uint32_t flags = 0;
  std::uint32_t degree = 0, count = 0;
  std::uint64_t data = 0;
  Vector2 o{}, x{}, y{};
};

struct Vertex {
  Vector point{};
  double tolerance = 0;  ///< [m]
};

enum class EdgeKind : std::uint32_t {
  kUnknown = 0,      ///< not classified yet; loading the part classifies the edge
  kSmooth = 1,       ///< the normals of both faces agree within 0.1 degrees everywhere
  kConvex = 2,       ///< the solid takes less than half of the space around it
  kConcave = 3,      ///< the solid takes more than half of the space around it
  kMixed = 4,        ///< convex in some places, concave in others
  kFree = 5,         ///< only one face ends at the edge
  kNonManifold = 6,  ///< more than two faces meet at the edge
  kPole = 7          ///< a single point without a curve, such as the apex of a cone or the pole of a sphere
};

/// A curve in space between two vertices, and the coedges that bound faces with it.
struct Edge {
  std::uint32_t curve = kNone;                              ///< index in curves3; kNone only for kPole
  std::uint32_t first_vertex = kNone, last_vertex = kNone;  ///< at t0 and t1; kNone if unknown
  std::uint32_t first_coedge = kNone, coedge_count = 0;     ///< the list continues in Coedge::next
  EdgeKind kind = EdgeKind::kUnknown;
  double t0 = 0, t1 = 0;  ///< parameters of the curve, t0 < t1
  double angle = 0;       ///< [rad] largest angle between the normals of the two faces
  double tolerance = 0;   ///< [m] largest distance between the coedges' curves and this curve
};

/// On coedges: the loop runs from t1 to t0; on faces: the outward normal is -(Su x Sv).
inline constexpr std::uint32_t kReversed = 1;
/// On coedges: the same face lies on both sides of the edge and has two coedges there.
inline constexpr std::uint32_t kSeam = 2;
/// On coedges: a line in the parameter plane that is a single point in space.
inline constexpr std::uint32_t kDegenerate = 4;

/// A face's use of an edge. The pcurve is the edge as a curve in the parameter plane of the face. Both have the same
/// parameter: point t of the pcurve is point t of the edge.
struct Coedge {
  std::uint32_t edge = kNone, face = kNone, pcurve = kNone;
  std::uint32_t next = kNone;  ///< the next coedge of the same edge
  std::uint32_t flags = 0;     ///< kReversed, kSeam, kDegenerate
  std::uint32_t reserved = 0;
  double t0 = 0, t1 = 0;  ///< range of the pcurve, t0 < t1; the same as the edge's unless the coedge is degenerate
};

/// A closed chain of coedges, in order. Which loop is the outer one does not matter.
struct Loop {
  std::uint32_t first = 0, count = 0;  ///< first coedge, and number of coedges
};

/// The part of a surface inside its loops. Without loops, the face is all of [lo, hi].
struct Face {
  std::uint32_t surface = kNone;
  std::uint32_t first_loop = 0, loop_count = 0;
  std::uint32_t flags = 0;  ///< kReversed
  std::uint32_t body = kNone;
  std::uint32_t colour = 0;  ///< red, green, blue, alpha from the lowest byte up; 0 if unknown
  std::uint32_t name = kNone;
  std::uint32_t reserved = 0;
  double tolerance = 0;  ///< [m]
  Vector2 lo{}, hi{};    ///< box of the loops in (u, v)
};

enum class BodyKind : std::uint32_t {
  kSolid = 0,  ///< faces that bound a volume
  kShell = 1,  ///< faces that share edges but bound no volume
  kSheet = 2,  ///< faces that share no edges
  kMesh = 3    ///< triangles
};

inline constexpr std::uint32_t kClosed = 1;  ///< flag of bodies that have no free edge

/// Faces or triangles that move together. A body is a range of consecutive faces, edges and vertices, or of consecutive
/// points and triangles.
struct Body {
  BodyKind kind = BodyKind::kSolid;
  std::uint32_t flags = 0;  ///< kClosed
  std::uint32_t name = kNone, colour = 0;
  std::uint32_t first_face = 0, face_count = 0;
  std::uint32_t first_edge = 0, edge_count = 0;
  std::uint32_t first_vertex = 0, vertex_count = 0;
  std::uint32_t first_point = 0, point_count = 0;        ///< meshes
  std::uint32_t first_triangle = 0, triangle_count = 0;  ///< meshes
  double smooth_angle = 0;  ///< [rad] meshes: normals are interpolated over edges that bend by less than this
};

/// A body at its pose, or (if body is kNone) an assembly that other instances name as their parent.
struct Instance {
  std::uint32_t body = kNone;
  std::uint32_t parent = kNone;  ///< index of an assembly, lower than its own
  std::uint32_t name = kNone, colour = 0;
  /// Rows of (rotation | position [m]) from the body's frame to the part's frame, also if there is a parent. The
  /// rotation does not mirror.
  std::array<double, 12> pose{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
};

/// A vertex of a mesh [m].
using Point = Vector;

/// A triangle of a mesh. Its corners are counter-clockwise, seen from outside. Edge k runs from corner k to corner (k +
/// 1) % 3.
struct Triangle {
  std::array<std::uint32_t, 3> corner{};  ///< indices in Part::points
  /// For each edge k: 4 * (index of the next triangle around the same edge) + (number of the edge in that triangle).
  /// The triangles around an edge form a ring. kNone for a free edge.
  std::array<std::uint32_t, 3> across{kNone, kNone, kNone};
};

/// The colours of the corners of a triangle: red, green, blue, 255 from the lowest byte up; 0 if unknown.
struct CornerColours {
  std::array<std::uint32_t, 3> corner{};
};

/// What is known of the empty balls of a triangle: see kernels/brep/model/empty_balls.hpp. Each number is the upper
/// half of one in single precision, and not negative.
struct EmptyBalls {
  struct Side {
    std::uint16_t whole = 0;               ///< [m]
    std::array<std::uint16_t, 3> slope{};  ///< [m], one for each edge
  };
  std::array<Side, 2> sides{};  ///< that to which the normal points, and the other
  std::uint16_t around = 0;     ///< 1 if the rings around its corners have all triangles that touch it, else 0
};

/// A piece of geometry that an import could not keep exactly.
struct Loss {
  std::string what;    ///< the piece, such as "face 12 'lid'" or "curve of edge 7"
  std::string reason;  ///< why, in words
  double size = 0;     ///< [m] how far the part may differ there; for a lost face, its size
  std::uint32_t face = kNone;
};

/// The file from which a part was imported.
struct Source {
  std::string file;           ///< name of the file, without folders
  std::string sha256;         ///< SHA-256 of its bytes, hexadecimal
  std::string unit;           ///< unit of its lengths, such as "mm" or "in"
  bool unit_assumed = false;  ///< true if the file does not state its unit
  double scale = 1;           ///< factor by which a CAD part was scaled on top of its unit
  std::string placed{};       ///< how a CAD part was turned and moved, in words; empty if it was not
};

struct Part {
  Source source;
  std::vector<std::string> names;  ///< UTF-8; records refer to names by index
  std::vector<std::string> warnings;
  std::vector<Loss> losses;
  double tolerance = 0;  ///< [m] the largest of all edges and vertices

  std::vector<Surface> surfaces;
  std::vector<Curve3> curves3;
  std::vector<Curve2> curves2;
  std::vector<double> reals;
  std::vector<Vertex> vertices;
  std::vector<Edge> edges;
  std::vector<Coedge> coedges;
  std::vector<Loop> loops;
  std::vector<Face> faces;
  std::vector<Body> bodies;
  std::vector<Instance> instances;
  std::vector<Point> points;
  std::vector<Triangle> triangles;
  std::vector<CornerColours> colours;  ///< of each triangle; empty if no triangle has a colour
  std::vector<EmptyBalls> balls;       ///< of each triangle; empty if they are not known
};

/// [main] Sets first_coedge and coedge_count of all edges, and next of all coedges, from Coedge::edge. Indices out of
/// range are skipped; checkPart() reports them.
void linkCoedges(Part& part);

static_assert(sizeof(Surface) == 176 && sizeof(Curve3) == 96 && sizeof(Curve2) == 72 && sizeof(Vertex) == 32);
static_assert(sizeof(Edge) == 56 && sizeof(Coedge) == 40 && sizeof(Loop) == 8 && sizeof(Face) == 72);
static_assert(sizeof(Body) == 64 && sizeof(Instance) == 112 && sizeof(Point) == 24 && sizeof(Triangle) == 24);
static_assert(sizeof(CornerColours) == 12 && sizeof(EmptyBalls) == 18);
static_assert(std::is_trivially_copyable_v<Surface> && std::is_trivially_copyable_v<Body>);

}  // namespace hapticd::brep
