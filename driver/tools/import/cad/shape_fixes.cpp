// SPDX-License-Identifier: MIT
#include "cad_import/shape_fixes.hpp"

#include <Interface_Static.hxx>
#include <ShapeFix_Face.hxx>
#include <ShapeFix_Shape.hxx>
#include <ShapeFix_Wire.hxx>
#include <ShapeProcess_ShapeContext.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Iterator.hxx>
#include <XSAlgo.hxx>
#include <XSAlgo_AlgoContainer.hxx>
#include <algorithm>
#include <cstring>

namespace hapticd::cad {
namespace {

class LimitedFixes final : public XSAlgo_AlgoContainer {
 public:
  TopoDS_Shape ProcessShape(const TopoDS_Shape& shape, Standard_Real precision, Standard_Real widest,
                            Standard_CString resources, Standard_CString sequence, Handle(Standard_Transient) & info,
                            const Message_ProgressRange& progress, Standard_Boolean non_manifold) const override {
    if (std::strncmp(sequence, "read.", 5) != 0 || mostLoops(shape) <= kManyLoops)
      return XSAlgo_AlgoContainer::ProcessShape(shape, precision, widest, resources, sequence, info, progress,
                                                non_manifold);
    const Handle(ShapeProcess_ShapeContext) context =
        new ShapeProcess_ShapeContext(shape, Interface_Static::CVal(resources));
    context->SetNonManifold(non_manifold);
    info = context;  // the reader needs it to find the colours of changed faces
    const Handle(ShapeFix_Shape) fix = new ShapeFix_Shape(shape);
    fix->SetPrecision(precision);
    fix->SetMaxTolerance(widest);
    fix->FixWireTool()->FixSelfIntersectionMode() = 0;
    fix->FixFaceTool()->FixIntersectingWiresMode() = 0;
    fix->Perform(progress);
    if (!fix->Shape().IsNull() && fix->Shape() != shape) {
      context->RecordModification(fix->Context());
      context->SetResult(fix->Shape());
    }
    return context->Result();
  }
};

}  // namespace

int mostLoops(const TopoDS_Shape& shape) {
  int most = 0;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) {
    int loops = 0;
    for (TopoDS_Iterator at(face.Current()); at.More(); at.Next()) ++loops;
    most = std::max(most, loops);
  }
  return most;
}

void limitShapeFixes() {
  XSAlgo::Init();  // called before the first reader calls it, because it would replace the container that is set here
  XSAlgo::SetAlgoContainer(new LimitedFixes);
}

}  // namespace hapticd::cad
