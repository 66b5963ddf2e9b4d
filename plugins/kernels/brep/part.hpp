// SPDX-License-Identifier: MIT
/// A boundary representation as a part file (hapticd-part/1, driver/docs/part_file.md) holds it: the records are those
/// of the file, byte for byte. Lengths are metres, angles radians. Indices count from 0 in the part's own arrays.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace hapticd::brep {

/// An index that points to nothing.
inline constexpr std::uint32_t kNone = 0xffffffffu;
/// Limits of coordinates and of radii [m].
inline constexpr double kFarthestPart = 1e6;

using Vector = std::array<double, 3>;
using Vector2 = std::array<double, 2>;

enum class SurfaceKind : std::uint32_t {
  kPlane = 0,       ///< o + u x + v y
  kCylinder = 1,    ///< o + r0 (cos u x + sin u y) + v z
  kCone = 2,        ///< o + (r0 + v r1) (cos u x + sin u y) + v z
  kSphere = 3,      ///< o + r0 (cos v (cos u x + sin u y) + sin v z)
  kTorus = 4,       ///< o + (r0 + r1 cos v) (cos u x + sin u y) + r1 sin v z
  kSpline = 5,      ///< B-spline, see Surface::data
  kExtrusion = 6,   ///< C(u) + v z, C is curve `basis`
  kRevolution = 7,  ///< C(v) turned by u about the axis through o along z (unit), C is curve `basis`
  kOffset = 8       ///< B(u, v) + r0 n(u, v), B is surface `basis`, n its unit Bu x Bv
};

inline constexpr std::uint32_t kRational = 1;  ///< flag of surfaces and curves: weights follow the points
inline constexpr std::uint32_t kClosedU = 2;   ///< flag of surfaces: u = lo and u = hi are one line in space
inline constexpr std::uint32_t kClosedV = 4;

/// A surface in the parameters of its source, so that the curves in its parameter plane stay exact. Axes carry the unit
/// of the parameters: the x of a plane whose parameters count millimetres is 0.001 long. x, y of cylinders, cones,
/// spheres, tori and z of spheres, tori, revolutions are unit vectors; frames may be left-handed.
struct Surface {
  SurfaceKind kind = SurfaceKind::kPlane;
  std::uint32_t flags = 0;                ///< kRational, kClosedU, kClosedV
  std::array<std::uint32_t, 2> degree{};  ///< splines: along u, v
  std::array<std::uint32_t, 2> count{};   ///< splines: control points along u, v
  std::uint32_t basis = kNone;            ///< curve of an extrusion or revolution; surface of an offset (a lower index)
  std::uint32_t reserved = 0;
  /// Splines: index in `reals` of the knots along u (count + degree + 1), along v, the points (x, y, z; v runs
  /// fastest), then the weights if kRational. Points are plain, not multiplied by their weights.
  std::uint64_t data = 0;
  Vector o{}, x{}, y{}, z{};
  std::array<double, 2> r{};       ///< [m] r0 and r1
  std::array<double, 2> period{};  ///< of u and v; 0: not periodic. Splines have none.
  double reserved2 = 0;
};

enum class CurveKind : std::uint32_t {
  kLine = 0,     ///< o + t x
  kCircle = 1,   ///< o + cos t x + sin t y; x and y are as long as the radius
  kEllipse = 2,  ///< the same, x and y as long as the half axes
  kSpline = 3    ///< see data
};

/// A curve in space [m].
struct Curve3 {
  CurveKind kind = CurveKind::kLine;
  std::uint32_t flags = 0;  ///< kRational
  std::uint32_t degree = 0, count = 0;
  std::uint64_t data = 0;  ///< splines: index in `reals` of the knots, the points (x, y, z), the weights if kRational
  Vector o{}, x{}, y{};
};

/// A curve in the parameter plane of a surface. The fields mean what they mean in Curve3; points are (u, v).
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
  kUnknown = 0,      ///< not classified yet: the loader of the part does it
  kSmooth = 1,       ///< the normals of both faces agree within 0.1 degrees everywhere
  kConvex = 2,       ///< the solid takes less than half of the space around it
  kConcave = 3,      ///< more than half
  kMixed = 4,        ///< convex in some places, concave in others
  kFree = 5,         ///< one face alone
  kNonManifold = 6,  ///< more than two faces
  kPole = 7          ///< a single point: the apex of a cone, the pole of a sphere; it has no curve
};

/// A curve in space between two vertices, and the coedges that bound faces with it.
struct Edge {
  std::uint32_t curve = kNone;                              ///< in curves3; kNone: only for kPole
  std::uint32_t first_vertex = kNone, last_vertex = kNone;  ///< at t0 and t1; kNone: unknown
  std::uint32_t first_coedge = kNone, coedge_count = 0;     ///< the list continues in Coedge::next
  EdgeKind kind = EdgeKind::kUnknown;
  double t0 = 0, t1 = 0;  ///< parameters of the curve, t0 < t1
  double angle = 0;       ///< [rad] largest angle between the normals of the two faces
  double tolerance = 0;   ///< [m] the curves of the coedges run within it of this curve
};

inline constexpr std::uint32_t kReversed = 1;    ///< coedges: the loop runs from t1 to t0; faces: outside is -(Su x Sv)
inline constexpr std::uint32_t kSeam = 2;        ///< coedges: the face is on both sides of the edge, with two coedges
inline constexpr std::uint32_t kDegenerate = 4;  ///< coedges: a line of parameters that is one point in space

/// A face's use of an edge. Edge and pcurve share the parameter: point t of the pcurve is point t of the edge.
struct Coedge {
  std::uint32_t edge = kNone, face = kNone, pcurve = kNone;
  std::uint32_t next = kNone;  ///< the next coedge of the same edge
  std::uint32_t flags = 0;     ///< kReversed, kSeam, kDegenerate
  std::uint32_t reserved = 0;
  double t0 = 0, t1 = 0;  ///< of the pcurve, t0 < t1: those of the edge, but for degenerate coedges
};

/// A closed chain of coedges, in order. Which loop is the outer one does not matter.
struct Loop {
  std::uint32_t first = 0, count = 0;  ///< coedges
};

/// The part of a surface inside its loops; without loops, all of [lo, hi].
struct Face {
  std::uint32_t surface = kNone;
  std::uint32_t first_loop = 0, loop_count = 0;
  std::uint32_t flags = 0;  ///< kReversed
  std::uint32_t body = kNone;
  std::uint32_t colour = 0;  ///< red, green, blue, alpha from the lowest byte up; 0: not stated
  std::uint32_t name = kNone;
  std::uint32_t reserved = 0;
  double tolerance = 0;  ///< [m]
  Vector2 lo{}, hi{};    ///< box of the loops in (u, v)
};

enum class BodyKind : std::uint32_t {
  kSolid = 0,  ///< bounds a volume
  kShell = 1,  ///< faces that share edges
  kSheet = 2,  ///< loose faces
  kMesh = 3    ///< triangles
};

inline constexpr std::uint32_t kClosed = 1;  ///< flag of bodies: no free edge

/// What moves as one. Its faces, edges and vertices, or its points and triangles, stand in one row each.
struct Body {
  BodyKind kind = BodyKind::kSolid;
  std::uint32_t flags = 0;  ///< kClosed
  std::uint32_t name = kNone, colour = 0;
  std::uint32_t first_face = 0, face_count = 0;
  std::uint32_t first_edge = 0, edge_count = 0;
  std::uint32_t first_vertex = 0, vertex_count = 0;
  std::uint32_t first_point = 0, point_count = 0;        ///< meshes
  std::uint32_t first_triangle = 0, triangle_count = 0;  ///< meshes
  double smooth_angle = 0;  ///< [rad] meshes: normals are interpolated over edges that bend by less
};

/// A body in its place, or (body = kNone) an assembly that others name as their parent.
struct Instance {
  std::uint32_t body = kNone;
  std::uint32_t parent = kNone;  ///< a lower index, of an assembly
  std::uint32_t name = kNone, colour = 0;
  /// Rows of (rotation | position [m]) from the body's frame to the part's, whatever the parent. A proper rotation.
  std::array<double, 12> pose{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
};

/// A vertex of a mesh [m].
using Point = Vector;

/// Counter-clockwise seen from outside. Edge k runs from corner k to corner (k + 1) % 3.
struct Triangle {
  std::array<std::uint32_t, 3> corner{};  ///< in points
  /// By edge: 4 * (the next triangle around the same edge) + its edge there; the list closes. kNone: a free edge.
  std::array<std::uint32_t, 3> across{kNone, kNone, kNone};
};

/// What an import could not keep.
struct Loss {
  std::string what;    ///< "face 12 'lid'", "curve of edge 7"
  std::string reason;  ///< in words
  double size = 0;     ///< [m] how far the part may differ there; for a lost face its extent
  std::uint32_t face = kNone;
};

/// Where a part comes from.
struct Source {
  std::string file;    ///< its name, without folders
  std::string sha256;  ///< of its bytes, hexadecimal
  std::string unit;    ///< unit of its lengths: "mm", "in"
};

struct Part {
  Source source;
  std::vector<std::string> names;  ///< UTF-8; records name them by index
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
};

/// [main] Fills first_coedge, coedge_count of all edges and next of all coedges from Coedge::edge. Indices that are out
/// of range are passed over; checkPart() reports them.
void linkCoedges(Part& part);

static_assert(sizeof(Surface) == 176 && sizeof(Curve3) == 96 && sizeof(Curve2) == 72 && sizeof(Vertex) == 32);
static_assert(sizeof(Edge) == 56 && sizeof(Coedge) == 40 && sizeof(Loop) == 8 && sizeof(Face) == 72);
static_assert(sizeof(Body) == 64 && sizeof(Instance) == 112 && sizeof(Point) == 24 && sizeof(Triangle) == 24);
static_assert(std::is_trivially_copyable_v<Surface> && std::is_trivially_copyable_v<Body>);

}  // namespace hapticd::brep
