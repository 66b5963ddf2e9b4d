// SPDX-License-Identifier: MIT
#include "cad_import/doubled_faces.hpp"

#include <BRepClass3d_SolidExplorer.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Tool.hxx>
#include <Precision.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>
#include <map>
#include <vector>

#include "cad_import/shape_fixes.hpp"

namespace hapticd::cad {
namespace {

/// True if a point of a surface lies on a face.
bool isOn(const TopoDS_Face& face, const gp_Pnt& p, double tolerance) {
  ShapeAnalysis_Surface surface(BRep_Tool::Surface(face));
  const gp_Pnt2d uv = surface.ValueOfUV(p, Precision::Confusion());
  if (!(surface.Value(uv).Distance(p) <= tolerance)) return false;
  return BRepTopAdaptor_FClass2d(face, Precision::PConfusion()).Perform(uv) == TopAbs_IN;
}

/// True if two faces that have the same edges cover the same part of a surface. The two halves of a sphere have the
/// same edge as well, so points between the edges decide.
bool coincide(const TopoDS_Face& a, const TopoDS_Face& b) {
  const double tolerance = std::max({BRep_Tool::Tolerance(a), BRep_Tool::Tolerance(b), Precision::Confusion()});
  for (double share : {0.4321, 0.1234, 0.8765}) {
    gp_Pnt p;
    gp_Vec along_u, along_v;
    double u = 0, v = 0;
    if (!BRepClass3d_SolidExplorer::FindAPointInTheFace(a, p, u, v, share, along_u, along_v)) return false;
    if (!isOn(b, p, tolerance)) return false;
  }
  return true;
}

/// Returns the numbers of the edges of a face, in order, without poles and seams, which each face has for itself.
std::vector<int> edgesOf(const TopoDS_Face& face, TopTools_IndexedMapOfShape& numbers) {
  std::vector<int> edges;
  for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(at.Current());
    if (!BRep_Tool::Degenerated(edge) && !BRep_Tool::IsClosed(edge, face)) edges.push_back(numbers.Add(edge));
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace

std::vector<int> doubledFaces(const TopoDS_Shape& shape) {
  std::vector<int> doubled;
  if (mostLoops(shape) > kManyLoops) return doubled;
  TopTools_IndexedMapOfShape numbers;
  std::map<std::vector<int>, std::vector<TopoDS_Face>> by_edges;
  int number = 0;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next(), ++number) {
    const TopoDS_Face face = TopoDS::Face(at.Current());
    std::vector<int> edges = edgesOf(face, numbers);
    if (edges.empty()) continue;
    std::vector<TopoDS_Face>& earlier = by_edges[std::move(edges)];
    const bool again = std::any_of(earlier.begin(), earlier.end(), [&](const TopoDS_Face& other) {
      return other.IsSame(face) || coincide(face, other);
    });
    if (again)
      doubled.push_back(number);
    else
      earlier.push_back(face);
  }
  return doubled;
}

}  // namespace hapticd::cad
