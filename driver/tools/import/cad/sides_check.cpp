// SPDX-License-Identifier: MIT
#include "cad_import/sides_check.hpp"

#include <BRepBndLib.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepClass3d_SolidExplorer.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>

#include "cad_import/shape_fixes.hpp"

namespace hapticd::cad {
namespace {

/// Returns 1 if the outside is in front of a point and the inside behind, -1 if not, 0 if the classifier cannot say.
int lookBeside(BRepClass3d_SolidClassifier& solid, const gp_Pnt& p, const gp_Vec& normal, double far) {
  bool right = true;
  for (const int side : {1, -1}) {
    solid.Perform(p.Translated(normal * (side * far)), 1e-9);
    if (solid.State() != TopAbs_IN && solid.State() != TopAbs_OUT) return 0;
    right = right && (solid.State() == TopAbs_OUT) == (side > 0);
  }
  return right ? 1 : -1;
}

/// Returns 1 if the outside is in front of the face and the inside behind it, -1 if not, 0 if this cannot be decided.
int judge(BRepClass3d_SolidClassifier& solid, const TopoDS_Face& face, double step) {
  gp_Pnt p;
  gp_Vec along_u, along_v;
  double u = 0, v = 0, share = 0.4321;
  if (!BRepClass3d_SolidExplorer::FindAPointInTheFace(face, p, u, v, share, along_u, along_v)) return 0;
  gp_Vec normal = along_u.Crossed(along_v);
  if (!(normal.Magnitude() > 1e-12)) return 0;
  normal = normal.Normalized() * (face.Orientation() == TopAbs_REVERSED ? -1 : 1);
  // A wall that is thinner than the step has its other side's outside behind it, so a short step is tried as well.
  int found = 0;
  for (const double share_of_step : {1.0, 0.01}) {
    const double far = std::max(share_of_step * step, 5 * BRep_Tool::Tolerance(face));
    const int now = lookBeside(solid, p, normal, far);
    if (now != 0) found = now;
    if (now > 0) break;
  }
  return found;
}

}  // namespace

SidesTried trySides(const TopoDS_Shape& solid, double seconds) {
  constexpr int kMostFaces = 40;
  constexpr double kStep = 1e-4;  // share of the diagonal of the solid
  SidesTried result;
  Bnd_Box box;
  BRepBndLib::Add(solid, box, false);
  if (box.IsVoid() || box.IsOpen() || mostLoops(solid) > kManyLoops) return result;
  const double step = kStep * std::sqrt(box.SquareExtent());
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(solid, TopAbs_FACE, faces);
  BRepClass3d_SolidClassifier classifier(solid);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  const int stride = std::max(1, (faces.Extent() + kMostFaces - 1) / kMostFaces);
  for (int i = 1; i <= faces.Extent() && std::chrono::steady_clock::now() < end; i += stride) {
    const int found = judge(classifier, TopoDS::Face(faces(i)), step);
    result.tried += found != 0 ? 1 : 0;
    result.wrong += found < 0 ? 1 : 0;
  }
  return result;
}

}  // namespace hapticd::cad
