// SPDX-License-Identifier: MIT
#include "kernels/brep/model/model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "kernels/brep/elements/feet.hpp"
#include "kernels/brep/elements/part_bounds.hpp"
#include "kernels/brep/elements/pieces.hpp"
#include "kernels/brep/model/empty_balls.hpp"
#include "kernels/brep/model/placements.hpp"
#include "kernels/brep/model/topology.hpp"
#include "kernels/part/names.hpp"

namespace hapticd::brep {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// Fills a Model from its part.
class ModelBuilder {
 public:
  ModelBuilder(Model& model, const ModelOptions& options) : model_(model), part_(model.part_), options_(options) {}

  void run() {
    model_.placements_ = placementsOf(part_, options_, model_.feature_count_);
    for (Curve2& curve : part_.curves2) recogniseLine(curve);
    model_.geometry_ = std::make_unique<Geometry>(part_, options_.form);
    classifyEdges(*model_.geometry_, part_.edges);
    model_.vertex_normals_ = vertexNormals(*model_.geometry_);
    model_.point_normals_ = pointNormals(part_);
    model_.has_narrow_ = std::any_of(model_.point_normals_.begin(), model_.point_normals_.end(),
                                     [](const CornerNormal& normal) { return normal.narrow; });
    listEdgesOfVertices();
    smoothNormals(part_, model_.smooth_corner_, model_.smooth_normals_);
    shapeFacesAndEdges();
    model_.bodies_.resize(part_.bodies.size());
    model_.face_roots_.assign(part_.faces.size(), BodyTree::kNoRoot);
    for (std::uint32_t b = 0; b < part_.bodies.size(); ++b) buildTree(b);
    placeBodies();
    touchWithBalls();
    warn();
    dropSplineNumbers();
  }

 private:
  static bool isAnalytic(const Surface& s) { return s.kind <= SurfaceKind::kTorus; }

  /// Turns a pcurve that is a spline of one straight span into a line, which needs no numbers of its own.
  void recogniseLine(Curve2& curve) const {
    if (curve.kind != CurveKind::kSpline || curve.degree != 1 || curve.count != 2 || (curve.flags & kRational) != 0)
      return;
    constexpr double kFar = 10;  // farther from its parameters' origin, the line would lose digits
    const double* knots = part_.reals.data() + curve.data;
    const double *points = knots + 4, t0 = knots[1], t1 = knots[2];
    if (!(std::abs(t0) + std::abs(t1) <= kFar * (t1 - t0))) return;
    for (std::size_t i = 0; i < 2; ++i) {
      curve.x[i] = (points[2 + i] - points[i]) / (t1 - t0);
      curve.o[i] = points[i] - t0 * curve.x[i];
    }
    curve.kind = CurveKind::kLine;
    curve.degree = curve.count = 0;
  }

  void shapeFacesAndEdges() {
    model_.faces_.reserve(part_.faces.size());
    for (std::uint32_t f = 0; f < part_.faces.size(); ++f) model_.faces_.push_back(faceShape(*model_.geometry_, f));
    model_.edge_slots_.assign(part_.edges.size(), kNone);
    for (std::uint32_t e = 0; e < part_.edges.size(); ++e) {
      const Edge& edge = part_.edges[e];
      if (edge.curve != kNone && part_.curves3[edge.curve].kind <= CurveKind::kCircle)
        keepEdge(e, edgeShape(part_, edge));
      if (auto made = recogniseEdge(*model_.geometry_, edge)) {
        made->shape.recognised = static_cast<std::uint32_t>(model_.recognised_.size());
        keepEdge(e, made->shape);
        model_.recognised_.push_back(std::move(*made));
      }
    }
    model_.edges_.shrink_to_fit();
  }

  void keepEdge(std::uint32_t index, const EdgeShape& shape) {
    model_.edge_slots_[index] = static_cast<std::uint32_t>(model_.edges_.size());
    model_.edges_.push_back(shape);
  }

  void listEdgesOfVertices() {
    const auto each = [this](const auto& use) {
      for (std::uint32_t e = 0; e < part_.edges.size(); ++e) {
        const Edge& edge = part_.edges[e];
        if (edge.first_vertex != kNone) use(edge.first_vertex, e);
        if (edge.last_vertex != kNone && edge.last_vertex != edge.first_vertex) use(edge.last_vertex, e);
      }
    };
    std::vector<std::uint32_t>& first = model_.first_edge_at_;
    first.assign(part_.vertices.size() + 1, 0);
    each([&](std::uint32_t vertex, std::uint32_t) { ++first[vertex + 1]; });
    for (std::size_t v = 0; v + 1 < first.size(); ++v) first[v + 1] += first[v];
    model_.edges_at_.resize(first.back());
    std::vector<std::uint32_t> place(first.begin(), first.end() - 1);
    each([&](std::uint32_t vertex, std::uint32_t e) { model_.edges_at_[place[vertex]++] = e; });
  }

  static void checkIndex(std::size_t index) {
    if (index > Element::kMostElements)
      throw std::invalid_argument(
          "the part has more than 536,870,911 elements of one kind, expected fewer (use a simpler part)");
  }

  void add(ElementKind kind, std::size_t index, const AlignedBox3d& box, const OrientedBox& oriented) {
    checkIndex(index);
    elements_.emplace_back(kind, static_cast<std::uint32_t>(index));
    const AlignedBox3d both = box.intersection(oriented.axisAligned());
    boxes_.push_back(both.isEmpty() ? box : both);
    oriented_.push_back(oriented);
  }

  /// Refuses the boxes from index `first` on if one is too far. @param name returns what they belong to
  template <class Name>
  void checkReach(std::size_t first, const Name& name) const {
    const auto within = [](const Vector3d& corner) { return (corner.array().abs() <= kFarthestReach).all(); };
    for (std::size_t i = first; i < boxes_.size(); ++i)
      if (!within(boxes_[i].min()) || !within(boxes_[i].max()))
        throw std::invalid_argument(name() +
                                    " reaches beyond 1e15 m, expected a part within this distance of its "
                                    "origin; the file may be damaged (import the part again)");
  }

  void addFace(std::uint32_t f) {
    constexpr std::size_t kMostLeaves = 20'000'000;
    if (isAnalytic(part_.surfaces[part_.faces[f].surface]))
      return add(ElementKind::kFace, f, faceBox(model_.face(f)), orientedFaceBox(model_.face(f)));
    std::vector<BoxedLeaf> leaves;
    cutFace(*model_.geometry_, f, model_.face(f), leaves);
    if (model_.leaves_.size() + leaves.size() > kMostLeaves)
      throw std::invalid_argument(
          "the curved faces need more than 20,000,000 flat pieces, expected fewer (use a simpler part)");
    for (const BoxedLeaf& made : leaves) {
      add(ElementKind::kLeaf, model_.leaves_.size(), made.box, made.oriented);
      model_.leaves_.push_back(made.leaf);
    }
  }

  void addEdge(std::uint32_t e) {
    const Edge& edge = part_.edges[e];
    if (edge.curve == kNone) {
      if (edge.first_vertex == kNone) return;
      const AlignedBox3d point(vec(part_.vertices[edge.first_vertex].point));
      return add(ElementKind::kPole, e, point, {Eigen::Matrix3d::Identity(), point});
    }
    const CurveKind kind = part_.curves3[edge.curve].kind;
    const std::uint32_t recognised = model_.edge_slots_[e] == kNone ? kNone : model_.edge(e).recognised;
    if (kind <= CurveKind::kCircle || recognised != kNone) {
      const bool circle = recognised != kNone ? model_.recognised(recognised).is_circle : kind == CurveKind::kCircle;
      return add(circle ? ElementKind::kCircle : ElementKind::kLine, e, edgeBox(model_.edge(e), circle),
                 orientedEdgeBox(model_.edge(e), circle));
    }
    std::vector<BoxedPiece> pieces;
    cutEdge(*model_.geometry_, e, pieces);
    for (const BoxedPiece& made : pieces) {
      add(ElementKind::kPiece, model_.pieces_.size(), made.box, made.oriented);
      model_.pieces_.push_back(made.piece);
    }
  }

  void buildTree(std::uint32_t b) {
    const Body& body = part_.bodies[b];
    elements_.clear();
    boxes_.clear();
    oriented_.clear();
    BodyTree& made = model_.bodies_[b];
    if (body.kind == BodyKind::kMesh) return buildMeshTree(body, made);
    for (std::uint32_t f = body.first_face; f < body.first_face + body.face_count; ++f) {
      const std::size_t first = boxes_.size();
      addFace(f);
      checkReach(first, [&] { return faceName(part_, f); });
    }
    for (std::uint32_t e = body.first_edge; e < body.first_edge + body.edge_count; ++e) {
      const std::size_t first = boxes_.size();
      addEdge(e);
      checkReach(first, [&] { return "edge " + std::to_string(e); });
    }
    arrange(made);
    addFaceTrees(body, made);
    made.tree.forgetOrder();
  }

  /// Builds the tree of a body and the box of each element.
  void arrange(BodyTree& body) const {
    const auto bent = std::count_if(elements_.begin(), elements_.end(), [](Element element) {
      return element.kind() == ElementKind::kLeaf || element.kind() == ElementKind::kPiece;
    });
    const bool is_bent = 2 * static_cast<std::size_t>(bent) > elements_.size();
    body.tree.build(boxes_, is_bent ? BodyTree::kElementRow : 1);
    body.elements.reserve(elements_.size());
    body.rows.reserve(elements_.size());
    for (const std::uint32_t i : body.tree.order()) {
      body.elements.push_back(elements_[i]);
      body.rows.push_back(rowBox(oriented_[i], body.tree));
    }
  }

  /// Calls use(number of the row, row) for each row of the tree.
  template <class Use>
  static void forEachRow(const BodyTree& body, const Use& use) {
    for (std::size_t n = 0; n < body.tree.nodeCount(); ++n) {
      const BoxNode& node = body.tree.node(static_cast<std::int32_t>(n));
      for (std::size_t i = 0; i < 4; ++i)
        if (node.child[i] < 0) use(static_cast<std::size_t>(node.row[i]), BoxTree::rowOf(node.child[i]));
    }
  }

  /// Calls use(face) for each face to which an element belongs.
  template <class F>
  void forEachFaceOf(Element element, F&& use) const {
    const auto of_edge = [&](std::uint32_t edge) {
      for (std::uint32_t c = part_.edges[edge].first_coedge; c != kNone; c = part_.coedges[c].next)
        use(part_.coedges[c].face);
    };
    switch (element.kind()) {
      case ElementKind::kFace:
        return use(element.index());
      case ElementKind::kLeaf:
        return use(model_.leaves_[element.index()].face);
      case ElementKind::kPiece:
        return of_edge(model_.pieces_[element.index()].edge);
      case ElementKind::kTriangle:
        return;
      default:
        of_edge(element.index());
    }
  }

  /// Adds a tree over each face and its edges, because a held contact asks for the nearest point of a single face.
  void addFaceTrees(const Body& body, BodyTree& made) {
    std::vector<std::vector<std::uint32_t>> of_faces(body.face_count);
    for (std::uint32_t i = 0; i < elements_.size(); ++i)
      forEachFaceOf(elements_[i], [&](std::uint32_t face) {
        if (face - body.first_face >= body.face_count) return;
        std::vector<std::uint32_t>& of_face = of_faces[face - body.first_face];
        if (of_face.empty() || of_face.back() != i) of_face.push_back(i);  // a seam edge has two coedges on one face
      });
    std::vector<std::uint32_t> places(elements_.size()), order;
    for (std::uint32_t place = 0; place < places.size(); ++place) places[made.tree.order()[place]] = place;
    std::vector<AlignedBox3d> boxes;
    for (std::uint32_t f = 0; f < body.face_count; ++f) {
      if (of_faces[f].empty()) continue;
      boxes.clear();
      for (const std::uint32_t i : of_faces[f]) boxes.push_back(boxes_[i]);
      const std::size_t first = order.size();
      model_.face_roots_[body.first_face + f] = made.tree.graft(boxes, BodyTree::kFaceRow, order);
      for (std::size_t i = first; i < order.size(); ++i) order[i] = places[of_faces[f][order[i]]];
    }
    made.of_faces = std::vector<std::uint32_t>(order.begin(), order.end());  // without spare memory
  }

  void buildMeshTree(const Body& body, BodyTree& made) {
    checkIndex(std::size_t{body.first_triangle} + body.triangle_count);
    for (std::uint32_t i = 0; i < body.triangle_count; ++i) {
      AlignedBox3d box;
      for (const std::uint32_t corner : part_.triangles[body.first_triangle + i].corner)
        box.extend(vec(part_.points[corner]));
      boxes_.push_back(box);
    }
    made.tree.build(boxes_, BodyTree::kMeshRow);
    made.elements.reserve(boxes_.size());
    for (const std::uint32_t i : made.tree.order())
      made.elements.emplace_back(ElementKind::kTriangle, body.first_triangle + i);
    made.tree.forgetOrder();
    made.discs.resize(static_cast<std::size_t>(made.tree.rowCount()));
    forEachRow(made, [&](std::size_t number, const ElementRow& row) {
      std::array<std::uint32_t, BoxTree::kMaxRow> triangles{};
      for (std::size_t k = 0; k < row.count; ++k) triangles[k] = made.elements[row.first + k].index();
      made.discs[number] = rowDisc(part_, std::span(triangles).first(row.count), made.tree);
    });
  }

  /// Keeps the empty balls of the part, or finds them if they are few: a loader has no time for more.
  void touchWithBalls() {
    constexpr std::size_t kMostFound = 100'000;
    const BodyTree& body = model_.bodies_[model_.placements_[0].body];
    const bool wanted = options_.empty_balls && model_.placements_.size() == 1 && !body.discs.empty();
    if (wanted && hasEmptyBalls(part_, body)) return;
    part_.balls = std::vector<EmptyBalls>();
    if (wanted && body.elements.size() <= kMostFound)
      findEmptyBalls(part_, body);
    else if (wanted)
      model_.warnings_.emplace_back(
          "its ticks take longer than they need, because its file does not say how far each triangle is alone; import "
          "the mesh again");
  }

  void placeBodies() {
    std::vector<AlignedBox3d> boxes;
    for (const Placement& place : model_.placements_) {
      const AlignedBox3d& box = model_.bodies_[place.body].tree.bounds();
      AlignedBox3d moved;
      for (int corner = 0; corner < 8; ++corner)
        moved.extend(place.rotation * box.corner(static_cast<AlignedBox3d::CornerType>(corner)) + place.position);
      const Vector3d rounding = Vector3d::Constant(1e-12 + 1e-14 * moved.diagonal().norm());
      boxes.emplace_back(moved.min() - rounding, moved.max() + rounding);
      model_.bounds_.extend(boxes.back());
      model_.open_ = model_.open_ || !place.solid;
    }
    if (model_.placements_.size() > 1) model_.placement_tree_.build(boxes, 1);
  }

  /// Keeps only the numbers of splines in parameter planes, which are evaluated from there. The geometry has copied
  /// those of surfaces and edges.
  void dropSplineNumbers() {
    std::vector<double> kept;
    for (const bool counting : {true, false}) {
      std::size_t size = 0;
      for (Curve2& c : part_.curves2) {
        if (c.kind != CurveKind::kSpline) continue;
        const std::size_t numbers = c.count * ((c.flags & kRational) != 0 ? 4ul : 3ul) + c.degree + 1;
        const auto first = part_.reals.begin() + static_cast<std::ptrdiff_t>(c.data);
        if (!counting) kept.insert(kept.end(), first, first + static_cast<std::ptrdiff_t>(numbers));
        if (!counting) c.data = size;
        size += numbers;
      }
      if (size > part_.reals.size()) return;  // curves of this part share numbers
      kept.reserve(size);
    }
    part_.reals = std::move(kept);
    for (Surface& s : part_.surfaces) s.data = 0, s.count = {0, 0};
    for (Curve3& c : part_.curves3) c.data = 0, c.count = 0;
  }

  void warn() {
    constexpr std::size_t kMostNamed = 5;
    std::vector<std::uint32_t> faces;
    int gaps = 0;
    for (std::uint32_t f = 0; f < model_.faces_.size(); ++f) {
      const int count = model_.faces_[f].trim.gaps().count;
      if (count > 0) faces.push_back(f);
      gaps += count;
    }
    if (gaps == 0) return;
    const auto widest = [this](std::uint32_t f) { return model_.faces_[f].trim.gaps().widest; };
    std::stable_sort(faces.begin(), faces.end(), [&](auto a, auto b) { return widest(a) > widest(b); });
    std::string text =
        std::to_string(gaps) + (gaps == 1 ? " gap in the loop of a face was closed by a straight line: "
                                          : " gaps in the loops of faces were closed by straight lines: ");
    for (std::size_t i = 0; i < std::min(faces.size(), kMostNamed); ++i) {
      char size[32];
      std::snprintf(size, sizeof size, ", %.3g mm", 1000 * widest(faces[i]));
      text += (i == 0 ? "" : "; ") + faceName(part_, faces[i]) + size;
    }
    if (faces.size() > kMostNamed)
      text += "; and narrower ones on " + std::to_string(faces.size() - kMostNamed) +
              (faces.size() - kMostNamed == 1 ? " face" : " faces");
    model_.warnings_.push_back(std::move(text));
  }

  Model& model_;
  Part& part_;
  const ModelOptions& options_;
  std::vector<Element> elements_;  ///< elements of the body whose tree is being built
  std::vector<AlignedBox3d> boxes_;
  std::vector<OrientedBox> oriented_;  ///< tighter boxes around the same elements
};

Model::Model(Part part, const ModelOptions& options) : part_(std::move(part)) {
  ModelBuilder(*this, options).run();
}

std::size_t Model::bytes() const noexcept {
  std::size_t sum = geometry_->bytes() + part_.reals.size() * sizeof(double);
  const auto add = [&sum](const auto& v) { sum += v.size() * sizeof v[0]; };
  add(part_.surfaces), add(part_.curves3), add(part_.curves2), add(part_.vertices), add(part_.edges);
  add(part_.coedges), add(part_.loops), add(part_.faces), add(part_.points), add(part_.triangles), add(part_.balls);
  add(faces_), add(edges_), add(leaves_), add(pieces_), add(vertex_normals_), add(point_normals_);
  add(smooth_corner_), add(smooth_normals_), add(placements_), add(recognised_), add(first_edge_at_), add(edges_at_);
  for (const RecognisedEdge& edge : recognised_) add(edge.stops), add(edge.parameters);
  for (const FaceShape& face : faces_) sum += face.trim.bytes();
  add(face_roots_), add(edge_slots_);
  for (const BodyTree& tree : bodies_) {
    sum += sizeof tree + tree.tree.bytes();
    add(tree.elements), add(tree.rows), add(tree.discs), add(tree.of_faces);
  }
  return sum + placement_tree_.bytes();
}

std::string Model::featureName(std::uint32_t feature) const {
  return brep::featureName(part_, feature);
}

}  // namespace hapticd::brep
