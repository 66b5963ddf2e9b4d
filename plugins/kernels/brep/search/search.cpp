// SPDX-License-Identifier: MIT
#include "kernels/brep/search/search.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/brep/elements/feet.hpp"
#include "kernels/brep/elements/newton_feet.hpp"
#include "kernels/brep/geometry/triangle_foot.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;

constexpr int kMostRestarts = 8;  ///< most leaves per search on which Newton's method starts from several places
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Examines an edge that is a single point. Returns its squared distance. `hit` is replaced if the point is nearer.
inline double poleFoot(const Part& part, std::uint32_t edge, const Vector3d& p, Hit& hit) noexcept {
  const Vector3d q = vec(part.vertices[part.edges[edge].first_vertex].point);
  const double d2 = (p - q).squaredNorm();
  if (!(d2 < hit.d2)) return d2;
  hit.d2 = d2;
  hit.point = q;
  return d2;
}

/// Returns the foot on a triangle of a mesh.
inline TriangleFoot footIn(const Part& part, std::uint32_t triangle, const Vector3d& p) noexcept {
  const Triangle& t = part.triangles[triangle];
  return triangleFoot(p, vec(part.points[t.corner[0]]), vec(part.points[t.corner[1]]), vec(part.points[t.corner[2]]));
}

/// Returns the squared distance of a foot. `hit` is replaced if the foot is nearer.
inline double keepNearer(const TriangleFoot& foot, const Vector3d& p, Hit& hit) noexcept {
  const double d2 = (p - foot.point).squaredNorm();
  if (!(d2 < hit.d2)) return d2;
  hit.d2 = d2;
  hit.point = foot.point;
  hit.u = foot.s;
  hit.v = foot.t;
  hit.region = static_cast<std::uint8_t>(foot.region);
  return d2;
}

/// Examines a triangle of a mesh. Returns its squared distance. `hit` is replaced if the triangle is nearer.
inline double meshFoot(const Part& part, std::uint32_t triangle, const Vector3d& p, Hit& hit) noexcept {
  return keepNearer(footIn(part, triangle, p), p, hit);
}

/// Returns the squared distance [m^2] from p to a known point of the part, rounded up.
double limitOf(const Vector3d& p, const Hit& known) noexcept {
  return (p - known.point).squaredNorm() * (1 + 1e-9);
}

bool isAt(const Nearest& found, Element element, std::uint32_t place) noexcept {
  return found.hit.element == element && found.place == place;
}

}  // namespace

double Nearest::distance() const noexcept {
  return std::sqrt(hit.d2);
}

Search::Search(const Model& model) : model_(model) {}

/// Finds the foot on a line or a circle. If the edge is recognised (a spline in the file), the parameter in `hit` is
/// converted to that of the spline, which the faces beside the edge use.
double Search::edgeFoot(Element element, const Vector3d& p, Hit& hit) const noexcept {
  const EdgeShape& edge = model_.edge(element.index());
  const double before = hit.d2;
  const double d2 = element.kind() == ElementKind::kLine ? lineFoot(edge, p, hit) : circleFoot(edge, p, hit);
  if (edge.recognised != kNone && hit.d2 < before)
    hit.u = parameterAt(model_.geometry(), model_.recognised(edge.recognised), hit.u, hit.point);
  return d2;
}

/// Finds the foot on a leaf. If the last foot is known, Newton's method starts there. Then mayHaveFoot() was not
/// called, so countFeet() is called here.
double Search::evaluateLeaf(Element element, const Vector3d& p, Examination& examination, Hit& hit) const noexcept {
  const Leaf& leaf = model_.leaf(element.index());
  LeafStart start{examination.uv, examination.feet, examination.elsewhere, examination.limit2};
  if (examination.start != nullptr) {
    start.uv = Eigen::Array2d(examination.start->u, examination.start->v);
    start.feet = countFeet(leaf.curvature, leaf.curvature.local(p));
  }
  const std::uint32_t surface = model_.part().faces[leaf.face].surface;
  const NewtonResult answer = leafFoot(model_.geometry(), leaf, model_.face(leaf.face), surface, p, start, hit);
  examination.proved = answer.proved;
  examination.starts = answer.starts;
  examination.least2 = answer.proved && start.feet.number != FeetOfLeaf::kNowhere ? answer.untrimmed2 : 0;
  return answer.d2;
}

/// Computes the foot on an element. Returns a lower bound of the squared distance [m^2]. `hit` is replaced if the foot
/// is nearer.
double Search::evaluate(Element element, const Vector3d& p, Examination& examination, Hit& hit) const noexcept {
  const std::uint32_t i = element.index();
  switch (element.kind()) {
    case ElementKind::kFace:
      return faceFoot(model_.face(i), p, hit);
    case ElementKind::kLine:
    case ElementKind::kCircle:
      return edgeFoot(element, p, hit);
    case ElementKind::kLeaf:
      return evaluateLeaf(element, p, examination, hit);
    case ElementKind::kPiece: {
      const CurvePiece& piece = model_.piece(i);
      const double t = examination.start != nullptr ? examination.start->u : 0.5 * (piece.t0 + piece.t1);
      const NewtonResult answer = pieceFoot(model_.geometry(), piece, p, t, examination.limit2, hit);
      examination.proved = answer.proved;
      return answer.d2;
    }
    case ElementKind::kPole:
      return poleFoot(model_.part(), i, p, hit);
    case ElementKind::kTriangle:
      return meshFoot(model_.part(), i, p, hit);
    default:
      return kInfinity;
  }
}

/// Returns false if a leaf certainly has no foot, so that it cannot have the nearest point. Otherwise sets the start
/// for Newton's method.
bool Search::mayHaveFoot(Element element, const Vector3d& p, Examination& examination) const noexcept {
  const Leaf& leaf = model_.leaf(element.index());
  const Vector3d q = leaf.curvature.local(p);
  examination.feet = countFeet(leaf.curvature, q);
  if (examination.feet.number == FeetOfLeaf::kNowhere) return false;
  examination.uv = footNear(leaf.curvature, leaf.middle(), q);
  return true;
}

/// True if an element, whose examination returned d2, really has a point that near. The foot of a face may be outside
/// its trim, and then it does not count.
bool Search::isAsNear(Element element, const Vector3d& p, double d2) const noexcept {
  if (element.kind() != ElementKind::kFace) return true;
  Hit hit;
  faceFoot(model_.face(element.index()), p, hit);
  return hit.d2 == d2;
}

/// Returns the lower bound [m^2] that an examination has found for the squared distance to the whole element, including
/// its points outside the trim.
double Search::lowerBoundOf(double d2, const Examination& examination) noexcept {
  if (examination.least2 >= 0) return examination.least2;
  return examination.proved && d2 < kInfinity ? d2 : 0;
}

/// Examines one element. @param bound2 [m^2] bound of the element's box. Returns a lower bound of the squared distance
/// to the whole element.
double Search::examine(std::uint32_t place, Element element, const Vector3d& p, double bound2, Run& run) noexcept {
  Nearest& best = run.best;
  const double before = best.hit.d2;
  Examination examination;
  examination.elsewhere = run.restarts > 0;
  examination.limit2 = run.within2();
  if (element.kind() == ElementKind::kLeaf && !mayHaveFoot(element, p, examination)) {
    run.others2 = std::min(run.others2, bound2);
    return bound2;
  }
  ++best.elements;
  const double d2 = evaluate(element, p, examination, best.hit);
  if (!examination.proved) run.open2 = std::min(run.open2, bound2);
  if (examination.starts > 1) --run.restarts;
  compare(place, element, p, before, d2, run);
  return lowerBoundOf(d2, examination);
}

/// Examines a triangle of a mesh as examine() does.
void Search::examineTriangle(std::uint32_t place, Element element, const Vector3d& p, Run& run) noexcept {
  const double before = run.best.hit.d2;
  ++run.best.elements;
  compare(place, element, p, before, meshFoot(model_.part(), element.index(), p, run.best.hit), run);
}

/// As examineTriangle(). Returns the foot, which takes a little longer.
Vector3d Search::examineForFoot(std::uint32_t place, Element element, const Vector3d& p, Run& run) noexcept {
  const double before = run.best.hit.d2;
  ++run.best.elements;
  const TriangleFoot foot = footIn(model_.part(), element.index(), p);
  compare(place, element, p, before, keepNearer(foot, p, run.best.hit), run);
  return foot.point;
}

/// Notes whether an element, whose examination returned d2, has the best foot now. @param before [m^2] squared distance
/// of the best foot before this examination
void Search::compare(std::uint32_t place, Element element, const Vector3d& p, double before, double d2,
                     Run& run) const noexcept {
  Nearest& best = run.best;
  if (best.hit.d2 < before) {
    run.others2 = std::min(run.others2, before);
    run.tied = false;
    best.hit.element = element;
    best.place = place;
  } else {
    if (d2 == before && !isAt(best, run.first, run.first_place) && !isAt(best, element, place))
      run.tied = run.tied || isAsNear(element, p, before);
    run.others2 = std::min(run.others2, d2);
  }
}

void Search::searchWhole(const Vector3d& p, Run& run) noexcept {
  if (model_.placements().size() == 1)
    searchTree(model_.body(model_.placements()[0].body), 0, 0, model_.placements()[0].toBody(p), run);
  else
    searchPlaces(p, run);
}

/// Searches within run.limit2, and again without this limit if nothing was found. That happens if the foot leaves a
/// face through a gap, within the tolerance of the file, between the face and its edge: the edge may be farther away
/// than the last point.
template <class Whole>
void Search::searchWithin(Run& run, const Whole& whole) noexcept {
  const Run start = run;
  whole();
  if (run.best.hit.d2 <= run.limit2) return;
  run = start;
  run.limit2 = kInfinity;
  whole();
}

/// Returns true if no search is needed, because the last element still has the nearest point; last_ is then the result
/// of this tick. Every distance changes by at most the distance `way` [m] that the probe has moved. So a lower bound of
/// the distance to all other elements is still known.
bool Search::reuseLast(const Vector3d& p, double way, const Run& run) noexcept {
  if (!last_.proved || run.first_place == kNone) return false;
  const double others = last_.others - way;
  if (!(std::sqrt(run.best.hit.d2) * (1 + kRounding) < others) || mayEnterBeside(p, run)) return false;
  last_.hit = run.best.hit;
  last_.others = others;
  last_.nodes = 0;
  last_.elements = 1;
  last_p_ = p;
  return true;
}

/// Returns the squared distance [m^2] to the nearest of some vertices, rounded up by the tolerance of the file. A
/// search that begins without a known point would examine hundreds of elements in one corner of a part of splines, if
/// none of them has a foot inside its trim.
double Search::vertexLimit(const Vector3d& p) const noexcept {
  constexpr std::size_t kMostPlaces = 16, kMostVertices = 256;
  const std::vector<Placement>& places = model_.placements();
  const Part& part = model_.part();
  const std::size_t step = (places.size() + kMostPlaces - 1) / kMostPlaces, each = kMostVertices * step / places.size();
  double best2 = kInfinity;
  for (std::size_t i = 0; i < places.size(); i += step) {
    const Body& body = part.bodies[places[i].body];
    const Vector3d q = places[i].toBody(p);
    const std::size_t stride = std::max<std::size_t>(1, (body.vertex_count + each - 1) / each);
    for (std::size_t v = 0; v < body.vertex_count; v += stride)
      best2 = std::min(best2, (q - vec(part.vertices[body.first_vertex + v].point)).squaredNorm());
  }
  const double distance = std::sqrt(best2) + part.tolerance;
  return distance * distance * (1 + 1e-9);
}

/// Examines the last element first, because a near start saves most of the search. The foot may have left this element,
/// but the last point is still a point of the part and limits the search.
void Search::begin(const Vector3d& p, Run& run) noexcept {
  if (!last_.found()) {
    run.limit2 = vertexLimit(p);
    return;
  }
  Examination examination;
  examination.start = &last_.hit;
  const Vector3d p_body = model_.placements()[last_.place].toBody(p);
  run.limit2 = limitOf(p_body, last_.hit);
  const double d2 = evaluate(last_.hit.element, p_body, examination, run.best.hit);
  run.best.elements = 1;
  if (run.best.hit.d2 < kInfinity) {
    run.best.hit.element = last_.hit.element;
    run.best.place = last_.place;
  }
  if (!examination.proved) return;
  run.first = last_.hit.element;
  run.first_place = last_.place;
  run.first_least2 = lowerBoundOf(d2, examination);
}

/// True if the best foot is on an edge and a face beside it may be nearer.
bool Search::mayEnterBeside(const Vector3d& p, const Run& run) const noexcept {
  const std::uint32_t edge = model_.edgeOf(run.best.hit.element);
  if (edge == kNone) return false;
  const Part& part = model_.part();
  const Vector3d p_body = model_.placements()[run.best.place].toBody(p);
  Hit nearer;
  nearer.d2 = run.best.hit.d2 * (1 + 3 * kRounding);
  const double limit2 = nearer.d2;
  for (std::uint32_t c = part.edges[edge].first_coedge; c != kNone; c = part.coedges[c].next)
    faceFoot(model_.face(part.coedges[c].face), p_body, nearer);
  return nearer.d2 < limit2;
}

/// Returns Nearest::others for the best foot. A face whose foot is outside its trim has no distance of its own in
/// `others2`: its edges have, and its foot may enter the trim as soon as the probe moves. It is then not nearer than
/// the edges were, less that motion and the gaps of the file. That holds for the faces beside the best edge only until
/// one of them is entered, which mayEnterBeside() finds out if they have closed forms.
double Search::othersOf(const Run& run) const noexcept {
  const double others = std::sqrt(std::min(run.others2, run.open2));
  const std::uint32_t edge = model_.edgeOf(run.best.hit.element);
  if (edge == kNone) return others;
  const Part& part = model_.part();
  for (std::uint32_t c = part.edges[edge].first_coedge; c != kNone; c = part.coedges[c].next)
    if (model_.face(part.coedges[c].face).kind > SurfaceKind::kTorus) return 0;
  return std::max(others - part.tolerance, 0.0);
}

void Search::finish(Run& run) const noexcept {
  Nearest& best = run.best;
  best.others = othersOf(run);
  best.open2 = run.open2;
  best.proved = best.found() && !best.exhausted && !(run.open2 < best.hit.d2);
}

Hit Search::refine(std::uint32_t place, const Hit& last, const Vector3d& p) noexcept {
  Hit hit = last;
  hit.d2 = kInfinity;
  Examination examination;
  examination.start = &last;
  evaluate(last.element, model_.placements()[place].toBody(p), examination, hit);
  return hit;
}

const Nearest& Search::nearest(const Vector3d& p, const SearchBudget& budget) noexcept {
  Run run;
  run.budget = budget;
  run.restarts = kMostRestarts;
  const double way = (p - last_p_).norm();  // computed first, because a square root takes long
  moveNear(way);
  if (walkMesh(p, budget)) return last_;
  begin(p, run);
  if (reuseLast(p, way, run)) return last_;
  if (!searchNear(p, way, run)) {
    searchWithin(run, [&] { searchWhole(p, run); });
    whole_nodes_ = run.best.nodes;
  }
  finish(run);
  last_ = run.best;
  last_p_ = p;
  return last_;
}

Nearest Search::nearestOf(std::uint32_t place, std::uint32_t face, const Vector3d& p, const Hit& start,
                          const SearchBudget& budget) noexcept {
  Run run;
  run.budget = budget;
  run.restarts = kMostRestarts;
  const Vector3d p_body = model_.placements()[place].toBody(p);
  if (start.element.kind() != ElementKind::kNothing) {
    Examination examination;
    examination.start = &start;
    run.limit2 = limitOf(p_body, start);
    evaluate(start.element, p_body, examination, run.best.hit);
    if (run.best.hit.d2 < kInfinity) {
      run.best.hit.element = start.element;
      run.best.place = place;
    }
  }
  const BodyTree& body = model_.body(model_.placements()[place].body);
  const std::int32_t root = face == kNone ? 0 : model_.rootOfFace(face);
  searchWithin(run, [&] { searchTree(body, root, place, p_body, run); });
  finish(run);
  return run.best;
}

int Search::around(const Vector3d& p, std::uint32_t* places, int cap) const noexcept {
  const BoxTree& tree = model_.placementTree();
  if (tree.empty()) return 0;
  const BoxProbe probe(tree, p);
  std::array<DescentEntry, BoxTree::kMaxStack> stack;
  std::array<DescentEntry, 4> children;
  double beyond = kInfinity;
  int depth = 0, found = 0;
  stack[static_cast<std::size_t>(depth++)] = {0, 0, 0};
  while (depth > 0 && found < cap) {
    const DescentEntry entry = stack[static_cast<std::size_t>(--depth)];
    if (entry.child < 0) {
      const ElementRow row = BoxTree::rowOf(entry.child);
      for (std::uint32_t i = row.first; i < row.first + row.count && found < cap; ++i)
        if (model_.placements()[tree.order()[i]].solid) places[found++] = tree.order()[i];
      continue;
    }
    const BoxNode& node = tree.node(entry.child);
    const int count = sortChildren(node, boxDistances(node, probe), 0.0, children, beyond);
    for (int i = 0; i < count; ++i) stack[static_cast<std::size_t>(depth++)] = children[static_cast<std::size_t>(i)];
  }
  return found;
}

}  // namespace hapticd::brep
