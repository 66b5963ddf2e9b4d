// SPDX-License-Identifier: MIT
#include "cad_import/outline_check.hpp"

#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>

namespace hapticd::cad {
namespace {

/// Returns the largest distance [mm] between an edge and its curve on a face.
double offFace(const TopoDS_Edge& edge, const Handle(Geom_Curve) & curve, const TopoDS_Face& face) {
  constexpr int kSteps = 32;
  double t0 = 0, t1 = 0, most = 0;
  const Handle(Geom2d_Curve) flat = BRep_Tool::CurveOnSurface(edge, face, t0, t1);
  if (flat.IsNull()) return 0;
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  for (int i = 0; i <= kSteps; ++i) {
    const double t = t0 + (t1 - t0) * i / kSteps;
    const gp_Pnt2d uv = flat->Value(t);
    most = std::max(most, surface->Value(uv.X(), uv.Y()).Distance(curve->Value(t)));
  }
  return most;
}

/// Returns the largest distance [mm] between an end of an edge and the vertex there.
double offVertices(const TopoDS_Edge& edge, const Handle(Geom_Curve) & curve, double t0, double t1) {
  const TopoDS_Vertex first = TopExp::FirstVertex(edge), last = TopExp::LastVertex(edge);
  double most = 0;
  if (!first.IsNull()) most = BRep_Tool::Pnt(first).Distance(curve->Value(t0));
  if (!last.IsNull()) most = std::max(most, BRep_Tool::Pnt(last).Distance(curve->Value(t1)));
  return most;
}

}  // namespace

OutlineOff outlineOff(const TopoDS_Face& face, bool with_curves) {
  OutlineOff found;
  for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(at.Current());
    double t0 = 0, t1 = 0;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, t0, t1);
    if (curve.IsNull()) continue;  // a pole
    const double on_face = with_curves ? offFace(edge, curve, face) : 0;
    const double at_end = offVertices(edge, curve, t0, t1);
    if (std::max(on_face, at_end) > found.by) found = {0, std::max(on_face, at_end), at_end >= on_face};
  }
  return found;
}

}  // namespace hapticd::cad
