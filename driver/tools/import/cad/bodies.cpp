// SPDX-License-Identifier: MIT
#include "cad_import/bodies.hpp"

#include <BRepBndLib.hxx>
#include <BRepTools.hxx>
#include <BRepTools_WireExplorer.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Precision.hxx>
#include <ShapeFix_Edge.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>

#include "cad_import/doubled_faces.hpp"
#include "kernels/part/names.hpp"

namespace hapticd::cad {
namespace {

using brep::kNone;
using brep::Part;

template <class Record>
void cut(std::vector<Record>& records, std::size_t size) {
  records.erase(records.begin() + static_cast<std::ptrdiff_t>(size), records.end());
}

std::uint32_t sizeOf(const auto& records) {
  return static_cast<std::uint32_t>(records.size());
}

double extentOf(const TopoDS_Face& face) {
  Bnd_Box box;
  BRepBndLib::Add(face, box, false);
  return box.IsVoid() || box.IsOpen() ? 0 : kMetres * std::sqrt(box.SquareExtent());
}

bool bounds(const TopoDS_Edge& edge) {
  return edge.Orientation() == TopAbs_FORWARD || edge.Orientation() == TopAbs_REVERSED;
}

/// Returns the edges of a wire in an order in which each starts where the one before ends. If this would lose edges,
/// returns them in the order of the file.
std::vector<TopoDS_Edge> inOrder(const TopoDS_Wire& wire, const TopoDS_Face& face, const brep::Face& range) {
  std::vector<TopoDS_Edge> all, ordered;
  for (TopoDS_Iterator at(wire); at.More(); at.Next())
    if (const TopoDS_Edge edge = TopoDS::Edge(at.Value()); bounds(edge)) all.push_back(edge);
  BRepTools_WireExplorer at;  // the range of the face is given, because the explorer would otherwise compute it from
                              // all loops, for each loop
  at.Init(wire, face, range.lo[0], range.hi[0], range.lo[1], range.hi[1]);
  for (; at.More() && ordered.size() <= all.size(); at.Next())
    if (bounds(at.Current())) ordered.push_back(at.Current());
  return ordered.size() == all.size() ? ordered : all;
}

/// Finds the parameter range of a face: the box of its loops, or that of the whole surface if it has none.
void findRange(const TopoDS_Face& face, brep::Face& record) {
  BRepTools::UVBounds(face, record.lo[0], record.hi[0], record.lo[1], record.hi[1]);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double lo = record.lo[axis], hi = record.hi[axis];
    if (!(std::abs(lo) < Precision::Infinite() / 2 && std::abs(hi) < Precision::Infinite() / 2))
      throw Unkept("its surface is infinite, and no loop bounds it");
    if (!(lo < hi)) throw Unkept("it has no area");
  }
}

}  // namespace

BodyBuilder::BodyBuilder(const Colours& colours, std::string name, Part& part)
    : colours_(colours), name_(std::move(name)), part_(part) {}

BodyBuilder::Sizes BodyBuilder::sizes() const {
  return {part_.surfaces.size(), part_.curves3.size(), part_.curves2.size(), part_.reals.size(), part_.vertices.size(),
          part_.edges.size(),    part_.coedges.size(), part_.loops.size(),   part_.faces.size(), part_.losses.size()};
}

/// Removes the records that were added since `to` was taken, for a face that could not be kept.
void BodyBuilder::cutBack(const Sizes& to) {
  cut(part_.surfaces, to.surfaces), cut(part_.curves3, to.curves3), cut(part_.curves2, to.curves2);
  cut(part_.reals, to.reals), cut(part_.vertices, to.vertices), cut(part_.edges, to.edges);
  cut(part_.coedges, to.coedges), cut(part_.loops, to.loops), cut(part_.faces, to.faces);
  cut(part_.losses, to.losses);
  for (std::uint32_t& index : edge_index_)
    if (index != kNone && index >= to.edges) index = kNone;
  for (std::uint32_t& index : vertex_index_)
    if (index != kNone && index >= to.vertices) index = kNone;
}

void BodyBuilder::note(const std::string& what, const Kept& kept) {
  if (kept.error > 0)
    part_.losses.push_back({what + " of face " + std::to_string(part_.faces.size()) + " of '" + name_ + "'",
                            brep::kApproximated, kept.error, static_cast<std::uint32_t>(part_.faces.size())});
}

std::uint32_t BodyBuilder::vertexOf(const TopoDS_Vertex& vertex) {
  if (vertex.IsNull()) return kNone;
  std::uint32_t& index = vertex_index_[static_cast<std::size_t>(vertices_.Add(vertex) - 1)];
  if (index != kNone) return index;
  index = sizeOf(part_.vertices);
  part_.vertices.push_back({metres(BRep_Tool::Pnt(vertex).XYZ()), BRep_Tool::Tolerance(vertex) * kMetres});
  part_.tolerance = std::max(part_.tolerance, part_.vertices.back().tolerance);
  return index;
}

std::uint32_t BodyBuilder::edgeOf(const TopoDS_Edge& any) {
  std::uint32_t& index = edge_index_[static_cast<std::size_t>(edges_.Add(any) - 1)];
  if (index != kNone) return index;
  const TopoDS_Edge edge = TopoDS::Edge(any.Oriented(TopAbs_FORWARD));
  brep::Edge record;
  record.first_vertex = vertexOf(TopExp::FirstVertex(edge));
  record.last_vertex = vertexOf(TopExp::LastVertex(edge));
  record.tolerance = BRep_Tool::Tolerance(edge) * kMetres;
  if (BRep_Tool::Degenerated(edge)) {
    record.kind = brep::EdgeKind::kPole;
  } else {
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, record.t0, record.t1);
    if (curve.IsNull()) throw Unkept("one of its edges has no curve in space");
    if (!(record.t0 < record.t1)) throw Unkept("one of its edges has no length");
    const Kept kept = addCurve(curve, record.t0, record.t1, part_);
    record.curve = kept.index;
    note("edge " + std::to_string(part_.edges.size()), kept);
  }
  index = sizeOf(part_.edges);
  part_.edges.push_back(record);
  part_.tolerance = std::max(part_.tolerance, record.tolerance);
  return index;
}

void BodyBuilder::addCoedge(const TopoDS_Face& face, const TopoDS_Edge& edge) {
  double t0 = 0, t1 = 0;
  Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, t0, t1);
  if (curve.IsNull()) {
    ShapeFix_Edge().FixAddPCurve(edge, face, BRep_Tool::IsClosed(edge, face), Precision::Confusion());
    curve = BRep_Tool::CurveOnSurface(edge, face, t0, t1);
  }
  if (curve.IsNull()) throw Unkept("one of its edges has no curve in the parameter plane of the face");
  brep::Coedge record;
  record.edge = edgeOf(edge);
  record.face = sizeOf(part_.faces);
  const brep::Edge& own = part_.edges[record.edge];
  const bool pole = own.kind == brep::EdgeKind::kPole;
  record.t0 = pole ? t0 : own.t0;
  record.t1 = pole ? t1 : own.t1;
  if (!(record.t0 < record.t1)) throw Unkept("one of its edges has no length");
  const double wide = 1e-9 * (record.t1 - record.t0);
  if (std::abs(record.t0 - t0) > wide || std::abs(record.t1 - t1) > wide)
    throw Unkept("an edge and its curve in the parameter plane of the face have different parameter ranges");
  if (unfolding_) {
    if (pole) throw Unkept("it has a pole");
    double c0 = 0, c1 = 0;
    const double middle = 0.5 * (record.t0 + record.t1);
    record.pcurve =
        unfolding_->addPlaneCurve(BRep_Tool::Curve(edge, c0, c1), part_.curves3[own.curve], record.t0, record.t1,
                                  curve->Value(middle), middle, std::max(own.tolerance, 1e-9), part_);
  } else {
    const Kept kept = addPlaneCurve(curve, record.t0, record.t1, part_);
    if (kept.error > 0) note("pcurve of edge " + std::to_string(record.edge), {kept.index, own.tolerance});
    record.pcurve = kept.index;
  }
  if (edge.Orientation() == TopAbs_REVERSED) record.flags |= brep::kReversed;
  if (BRep_Tool::IsClosed(edge, face)) record.flags |= brep::kSeam;
  if (pole) record.flags |= brep::kDegenerate;
  part_.coedges.push_back(record);
}

void BodyBuilder::addLoop(const TopoDS_Face& face, const TopoDS_Shape& wire, const brep::Face& range) {
  if (wire.ShapeType() != TopAbs_WIRE) return;
  brep::Loop loop{sizeOf(part_.coedges), 0};
  const bool flat = unfolding_ && part_.surfaces.back().kind == brep::SurfaceKind::kPlane;
  for (const TopoDS_Edge& edge : inOrder(TopoDS::Wire(wire), face, range)) {
    double t0 = 0, t1 = 0;
    const bool pole = BRep_Tool::Degenerated(edge);
    if (pole && flat) continue;  // a plane has no poles
    if (!pole) BRep_Tool::Range(edge, t0, t1);
    if (!pole && !(t0 < t1)) continue;  // the edge is a single point, which is an end of its neighbours
    addCoedge(face, edge);
  }
  loop.count = sizeOf(part_.coedges) - loop.first;
  if (loop.count > 0) part_.loops.push_back(loop);
}

/// Adds a face with its surface and loops. Throws Unkept if it cannot be kept.
/// @param shape the recognised surface; nullptr to keep the surface of the face
void BodyBuilder::addFace(const TopoDS_Face& oriented, const brep::Surface* shape) {
  const TopoDS_Face face = TopoDS::Face(oriented.Oriented(TopAbs_FORWARD));
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  if (surface.IsNull()) throw Unkept("it has no surface");
  brep::Face record;
  findRange(face, record);
  if (shape != nullptr) {
    record.surface = sizeOf(part_.surfaces);
    part_.surfaces.push_back(*shape);
    unfolding_.emplace(surface, record.lo, record.hi, *shape);
  } else {
    const Kept kept = addSurface(surface, record.lo, record.hi, part_);
    note("surface", kept);
    record.surface = kept.index;
  }
  record.body = sizeOf(part_.bodies);
  record.first_loop = sizeOf(part_.loops);
  record.tolerance = BRep_Tool::Tolerance(face) * kMetres;
  if (oriented.Orientation() == TopAbs_REVERSED) record.flags |= brep::kReversed;
  if (const auto colour = colours_.find(oriented.TShape().get()); colour != colours_.end())
    record.colour = colour->second;
  for (TopoDS_Iterator wire(face); wire.More(); wire.Next()) addLoop(face, wire.Value(), record);
  record.loop_count = sizeOf(part_.loops) - record.first_loop;
  if (unfolding_) {
    record.lo = unfolding_->lo();
    record.hi = unfolding_->hi();
  }
  part_.faces.push_back(record);
}

/// Returns true if the face was a plane, cylinder, cone or sphere stored as a spline, and was added as such.
bool BodyBuilder::addDisguised(const TopoDS_Face& face) {
  const Sizes before = sizes();
  try {
    brep::Face range;
    findRange(TopoDS::Face(face.Oriented(TopAbs_FORWARD)), range);
    const auto shape = recognised(BRep_Tool::Surface(face), range.lo, range.hi);
    if (!shape) return false;
    addFace(face, &*shape);
    unfolding_.reset();
    const brep::Face& made = part_.faces.back();
    if (made.loop_count > 0 && made.lo[0] < made.hi[0] && made.lo[1] < made.hi[1]) {
      ++recognised_;
      return true;
    }
  } catch (const Unkept&) {  // keep it as a spline
  } catch (const Standard_Failure&) {
  }
  unfolding_.reset();
  cutBack(before);
  return false;
}

void BodyBuilder::noteOutline(const TopoDS_Face& face, bool with_curves) {
  try {
    outlines_.push_back(outlineOff(face, with_curves));
    outlines_.back().face = face_number_;
  } catch (const Standard_Failure&) {  // the face is good without this check
  }
}

void BodyBuilder::tryFace(const TopoDS_Face& face) {
  if (addDisguised(face)) return noteOutline(face, false);
  const Sizes before = sizes();
  std::string reason;
  try {
    addFace(face, nullptr);
    return noteOutline(face, true);
  } catch (const Unkept& why) {
    reason = why.what();
  } catch (const Standard_Failure& failure) {
    reason = std::string("Open CASCADE failed: ") + failure.DynamicType()->Name() + " " + failure.GetMessageString();
  }
  cutBack(before);
  part_.losses.push_back(
      {"face " + std::to_string(face_number_) + " of '" + name_ + "'", reason, extentOf(face), kNone});
}

bool BodyBuilder::isClosed(const brep::Body& body) const {
  std::vector<int> uses(body.edge_count, 0);
  for (const brep::Coedge& coedge : part_.coedges)
    if (coedge.edge >= body.first_edge && coedge.edge - body.first_edge < body.edge_count)
      ++uses[coedge.edge - body.first_edge];
  for (std::uint32_t e = 0; e < body.edge_count; ++e)
    if (uses[e] < 2 && part_.edges[body.first_edge + e].kind != brep::EdgeKind::kPole) return false;
  return body.face_count > 0;
}

/// Adds the faces of a shape. Of faces that lie on one another only the first is added: beside two of them, a point is
/// in front of the one and behind the other, so the force would depend on which of the two is found. Returns how many
/// were left out.
std::size_t BodyBuilder::addFaces(const TopoDS_Shape& shape) {
  const std::vector<int> doubled = doubledFaces(shape);
  int number = 0;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next(), ++face_number_, ++number)
    if (!std::binary_search(doubled.begin(), doubled.end(), number)) tryFace(TopoDS::Face(at.Current()));
  if (!doubled.empty())
    part_.warnings.push_back("'" + name_ + "': " + std::to_string(doubled.size()) +
                             (doubled.size() == 1 ? " face lies on another one" : " faces lie on other ones") +
                             ", with no volume between them, so " + (doubled.size() == 1 ? "it was" : "they were") +
                             " left out; the body is taken as a shell, felt from both sides");
  return doubled.size();
}

/// Decides whether a body is a solid. One that the file calls a solid is none if it is open, or if faces were left out
/// because they lie on others.
/// @param told true if the report has named already why the body may be open
void BodyBuilder::setKind(const TopoDS_Shape& shape, brep::Body& body, bool doubled, bool told) {
  const bool solid = TopExp_Explorer(shape, TopAbs_SOLID).More();
  const bool shell = TopExp_Explorer(shape, TopAbs_SHELL).More();
  if (isClosed(body)) body.flags = brep::kClosed;
  body.kind = solid && !doubled && body.flags != 0 ? brep::BodyKind::kSolid
              : shell                              ? brep::BodyKind::kShell
                                                   : brep::BodyKind::kSheet;
  if (solid && body.flags == 0 && !doubled && !told)
    part_.warnings.push_back("'" + name_ +
                             "' is stored as a solid, but some of its edges bound only one face: taken as a shell");
}

std::uint32_t BodyBuilder::add(const TopoDS_Shape& shape, std::uint32_t name, std::uint32_t colour) {
  brep::Body body;
  body.name = name;
  body.colour = colour;
  body.first_face = sizeOf(part_.faces);
  body.first_edge = sizeOf(part_.edges);
  body.first_vertex = sizeOf(part_.vertices);
  TopTools_IndexedMapOfShape all;
  TopExp::MapShapes(shape, TopAbs_EDGE, all);
  edge_index_.assign(static_cast<std::size_t>(all.Extent()), kNone);
  all.Clear();
  TopExp::MapShapes(shape, TopAbs_VERTEX, all);
  vertex_index_.assign(static_cast<std::size_t>(all.Extent()), kNone);
  const std::size_t losses = part_.losses.size();
  const std::size_t doubled = addFaces(shape);
  body.face_count = sizeOf(part_.faces) - body.first_face;
  body.edge_count = sizeOf(part_.edges) - body.first_edge;
  body.vertex_count = sizeOf(part_.vertices) - body.first_vertex;
  setKind(shape, body, doubled > 0, part_.losses.size() > losses);
  if (body.flags != 0 && body.kind == brep::BodyKind::kSolid && isInsideOut(shape)) {
    for (std::uint32_t f = 0; f < body.face_count; ++f) part_.faces[body.first_face + f].flags ^= brep::kReversed;
    part_.warnings.push_back("'" + name_ + "' was inside out: its faces were reversed");
  }
  part_.bodies.push_back(body);
  return sizeOf(part_.bodies) - 1;
}

}  // namespace hapticd::cad
