// SPDX-License-Identifier: MIT
/// Triangles of trimmed faces. A face is divided into strips along u, at the values of v where its loops turn; inside
/// the loops, a strip is a row of trapezoids. (Scan conversion of polygons: Foley et al., Computer Graphics, 3.6, with
/// exact corners.)
#include "traced_shape/part_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "kernels/brep/model/topology.hpp"

namespace hapticd {
namespace {

using brep::Face;
using brep::Geometry;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kMostCells = 256;        ///< most cells of a face along u or v
constexpr double kLowestStrip = 4096;  ///< a strip is at least the range of v divided by this

class FaceMesh {
 public:
  FaceMesh(const brep::Model& model, const brep::Placement& place, std::uint32_t face, double chord_error, Mesh& mesh)
      : geometry_(model.geometry()),
        part_(model.part()),
        place_(place),
        face_(part_.faces[face]),
        chord_error_(chord_error),
        lo_(brep::vec(face_.lo)),
        range_(brep::vec(face_.hi) - brep::vec(face_.lo)),
        mesh_(mesh) {}

  void run() {
    countCells();
    collectSegments();
    const std::vector<double> levels = strips();
    std::sort(segments_.begin(), segments_.end(), [](const Segment& a, const Segment& b) { return a.a[1] < b.a[1]; });
    std::vector<Segment> active;
    std::size_t next = 0;
    for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
      const double middle = 0.5 * (levels[i] + levels[i + 1]);
      while (next < segments_.size() && segments_[next].a[1] < middle) active.push_back(segments_[next++]);
      std::erase_if(active, [middle](const Segment& s) { return s.b[1] <= middle; });
      std::sort(active.begin(), active.end(),
                [middle](const Segment& a, const Segment& b) { return a.at(middle) < b.at(middle); });
      for (std::size_t k = 0; k + 1 < active.size(); k += 2)
        addStrip(active[k], active[k + 1], levels[i], levels[i + 1]);
    }
  }

 private:
  /// A piece of a loop from a to b, where b has the larger v.
  struct Segment {
    Vector2d a, b;
    double at(double v) const { return a[0] + (v - a[1]) / (b[1] - a[1]) * (b[0] - a[0]); }
  };

  /// Chooses the number of cells: a chord over a step h is off by |C''| h^2 / 8 from a curve with the second derivative
  /// C''.
  void countCells() {
    constexpr int kProbes = 5;
    double bend_u = 0, bend_v = 0;
    spline::SurfacePoint E;
    for (int i = 0; i < kProbes; ++i)
      for (int j = 0; j < kProbes; ++j) {
        const Vector2d uv = lo_ + Vector2d((i + 0.5) / kProbes * range_[0], (j + 0.5) / kProbes * range_[1]);
        geometry_.surface(face_.surface, uv[0], uv[1], E);
        bend_u = std::max(bend_u, E.Suu.norm() * range_[0] * range_[0] + E.Suv.norm() * range_[0] * range_[1]);
        bend_v = std::max(bend_v, E.Svv.norm() * range_[1] * range_[1] + E.Suv.norm() * range_[0] * range_[1]);
      }
    const auto cells = [this](double bend) {
      const double wanted = std::ceil(std::sqrt(bend / (8 * chord_error_)));
      return std::isfinite(wanted) ? std::clamp(static_cast<int>(std::min<double>(wanted, kMostCells)), 1, kMostCells)
                                   : kMostCells;
    };
    cells_u_ = refined(0, cells(bend_u));
    cells_v_ = refined(1, cells(bend_v));
  }

  /// Doubles the cells along u (0) or v (1) until no chord of a cell is far from the face: at a crease the second
  /// derivatives are those beside it.
  int refined(int axis, int cells) const {
    while (2 * cells <= kMostCells && farthestChord(axis, cells) > 2 * chord_error_) cells *= 2;
    return cells;
  }

  /// Returns the largest distance [m] of the middle of a cell's chord from the face, on a few lines along u (0) or v
  /// (1).
  double farthestChord(int axis, int cells) const {
    constexpr int kLines = 3;
    double farthest = 0;
    spline::SurfacePoint from, middle, to;
    const auto evaluate = [&](int line, double share, spline::SurfacePoint& E) {
      Vector2d at((line + 0.5) / kLines, (line + 0.5) / kLines);
      at[axis] = share;
      const Vector2d uv = lo_ + at.cwiseProduct(range_);
      geometry_.surface(face_.surface, uv[0], uv[1], E);
    };
    for (int line = 0; line < kLines; ++line) {
      evaluate(line, 0, from);
      for (int i = 0; i < cells; ++i) {
        evaluate(line, (i + 0.5) / cells, middle);
        evaluate(line, (i + 1.0) / cells, to);
        farthest = std::max(farthest, (middle.S - 0.5 * (from.S + to.S)).norm());
        from = to;
      }
    }
    return farthest;
  }

  void add(Vector2d a, Vector2d b) {
    if (a[1] > b[1]) std::swap(a, b);
    if (a[1] < b[1]) segments_.push_back({a, b});
  }

  void collectSegments() {
    if (face_.loop_count == 0) {
      add(lo_, {lo_[0], lo_[1] + range_[1]});
      add({lo_[0] + range_[0], lo_[1]}, lo_ + range_);
    }
    for (std::uint32_t l = 0; l < face_.loop_count; ++l) {
      const brep::Loop& loop = part_.loops[face_.first_loop + l];
      std::vector<Vector2d> chain;
      for (std::uint32_t i = 0; i < loop.count; ++i) sample(part_.coedges[loop.first + i], chain);
      for (std::size_t i = 0; i < chain.size(); ++i) add(chain[i], chain[(i + 1) % chain.size()]);
    }
  }

  /// Adds points of a coedge, in the direction of its loop, without the last point.
  void sample(const brep::Coedge& c, std::vector<Vector2d>& chain) const {
    const bool reversed = (c.flags & brep::kReversed) != 0;
    const double from = reversed ? c.t1 : c.t0, to = reversed ? c.t0 : c.t1;
    const auto at = [&](double share) { return geometry_.planeCurve(c.pcurve, from + share * (to - from)).c; };
    int count = 1;
    if (part_.curves2[c.pcurve].kind != brep::CurveKind::kLine) {
      constexpr int kFirst = 8;
      double off = 0;
      for (int i = 0; i < kFirst; ++i) {
        const Vector2d a = at(static_cast<double>(i) / kFirst), b = at((i + 1.0) / kFirst);
        const Vector2d m = at((i + 0.5) / kFirst), chord = 0.5 * (a + b);
        spline::SurfacePoint on, off_it;
        geometry_.surface(face_.surface, m[0], m[1], on);
        geometry_.surface(face_.surface, chord[0], chord[1], off_it);
        off = std::max(off, (on.S - off_it.S).norm());
      }
      const double wanted = std::ceil(kFirst * std::sqrt(off / chord_error_));
      count = std::isfinite(wanted) ? static_cast<int>(std::clamp(wanted, 4.0, 512.0)) : 512;
    }
    for (int i = 0; i < count; ++i) chain.push_back(at(static_cast<double>(i) / count));
  }

  /// Returns ascending values of v that divide the face into strips. All segments of loops end at these values, except
  /// where two values would be closer than the lowest strip.
  std::vector<double> strips() const {
    std::vector<double> levels;
    for (const Segment& s : segments_) {
      levels.push_back(s.a[1]);
      levels.push_back(s.b[1]);
    }
    for (int j = 1; j < cells_v_; ++j) levels.push_back(lo_[1] + range_[1] * j / cells_v_);
    std::sort(levels.begin(), levels.end());
    std::vector<double> kept;
    for (const double v : levels)
      if (kept.empty() || v > kept.back() + range_[1] / kLowestStrip) kept.push_back(v);
    return kept;
  }

  std::uint32_t addVertex(double u, double v) {
    spline::SurfacePoint E;
    geometry_.surface(face_.surface, u, v, E);
    Vector3d n = geometry_.normal(face_, {u, v});
    if ((face_.flags & brep::kReversed) != 0) n = -n;
    const Eigen::Vector3f p = (place_.rotation * E.S + place_.position).cast<float>();
    const Eigen::Vector3f normal = (place_.rotation * n).cast<float>();
    mesh_.xyz.insert(mesh_.xyz.end(), {p.x(), p.y(), p.z()});
    mesh_.normals.insert(mesh_.normals.end(), {normal.x(), normal.y(), normal.z()});
    return static_cast<std::uint32_t>(mesh_.xyz.size() / 3 - 1);
  }

  void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if ((face_.flags & brep::kReversed) != 0) std::swap(b, c);
    mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
  }

  void addStrip(const Segment& left, const Segment& right, double v0, double v1) {
    const double l0 = left.at(v0), r0 = right.at(v0), l1 = left.at(v1), r1 = right.at(v1);
    const double width = std::max(r0 - l0, r1 - l1);
    const int count = std::clamp(static_cast<int>(std::ceil(width / range_[0] * cells_u_)), 1, kMostCells);
    std::uint32_t below = addVertex(l0, v0), above = addVertex(l1, v1);
    for (int i = 1; i <= count; ++i) {
      const double share = static_cast<double>(i) / count;
      const std::uint32_t next_below = addVertex(l0 + share * (r0 - l0), v0);
      const std::uint32_t next_above = addVertex(l1 + share * (r1 - l1), v1);
      addTriangle(below, next_below, next_above);
      addTriangle(below, next_above, above);
      below = next_below;
      above = next_above;
    }
  }

  const Geometry& geometry_;
  const brep::Part& part_;
  const brep::Placement& place_;
  const Face& face_;
  double chord_error_;
  Vector2d lo_, range_;
  Mesh& mesh_;
  std::vector<Segment> segments_;
  int cells_u_ = 1, cells_v_ = 1;
};

void addTriangles(const brep::Model& model, const brep::Placement& place, const brep::Body& body, Mesh& mesh) {
  const brep::Part& part = model.part();
  for (std::uint32_t i = body.first_triangle; i < body.first_triangle + body.triangle_count; ++i) {
    const Vector3d n = place.rotation * brep::triangleNormal(part, part.triangles[i]);
    for (int k = 0; k < 3; ++k) {
      const Vector3d p =
          place.rotation * brep::vec(part.points[part.triangles[i].corner[static_cast<std::size_t>(k)]]) +
          place.position;
      const Eigen::Vector3f* smooth = model.smoothNormal(i, k);
      const Vector3d normal = smooth != nullptr ? Vector3d(place.rotation * smooth->cast<double>()) : n;
      for (int axis = 0; axis < 3; ++axis) {
        mesh.xyz.push_back(static_cast<float>(p[axis]));
        mesh.normals.push_back(static_cast<float>(normal[axis]));
      }
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.xyz.size() / 3 - 1));
    }
  }
}

constexpr std::uint32_t kOpaque = 0xff000000u;

/// Returns the colour of all that has none of its own at a place.
std::uint32_t colourOf(const brep::Part& part, const brep::Placement& place) {
  const std::uint32_t own = part.instances[place.instance].colour;
  return own != 0 ? own : part.bodies[place.body].colour;
}

/// Gives the vertices that were added last a colour. The alpha of a CAD file is left out: what can be felt is opaque.
void paint(std::uint32_t colour, Mesh& mesh) {
  mesh.colours.resize(mesh.xyz.size() / 3, colour != 0 ? colour | kOpaque : 0);
}

/// Gives the corners of the triangles that were added last their own colours. The whole mesh has the colour of the
/// place if none of its triangles has one.
void paintTriangles(const brep::Part& part, const brep::Body& body, Mesh& mesh) {
  if (part.colours.empty()) return;
  const std::span own = std::span(part.colours).subspan(body.first_triangle, body.triangle_count);
  if (std::all_of(own.begin(), own.end(),
                  [](const auto& colours) { return colours.corner == decltype(colours.corner){}; }))
    return;
  for (const brep::CornerColours& colours : own)
    for (const std::uint32_t word : colours.corner) mesh.colours.push_back(word != 0 ? word | kOpaque : 0);
}

}  // namespace

Mesh tessellate(const brep::Model& model, double chord_error) {
  Mesh mesh;
  std::size_t triangles = 0;  // those of meshes are known before, and may be millions
  for (const brep::Placement& place : model.placements()) triangles += model.part().bodies[place.body].triangle_count;
  mesh.xyz.reserve(9 * triangles);
  mesh.normals.reserve(9 * triangles);
  mesh.indices.reserve(3 * triangles);
  for (const brep::Placement& place : model.placements()) {
    const brep::Body& body = model.part().bodies[place.body];
    const std::uint32_t colour = colourOf(model.part(), place);
    for (std::uint32_t f = body.first_face; f < body.first_face + body.face_count; ++f) {
      FaceMesh(model, place, f, chord_error, mesh).run();
      const std::uint32_t own = model.part().faces[f].colour;
      paint(own != 0 ? own : colour, mesh);
    }
    addTriangles(model, place, body, mesh);
    paintTriangles(model.part(), body, mesh);
    paint(colour, mesh);
  }
  if (std::all_of(mesh.colours.begin(), mesh.colours.end(), [](std::uint32_t colour) { return colour == 0; }))
    mesh.colours = {};
  return mesh;
}

}  // namespace hapticd
