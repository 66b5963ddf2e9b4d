// SPDX-License-Identifier: MIT
#include "cad_import/healing.hpp"

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeFix_Shape.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Solid.hxx>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cad_import/progress.hpp"
#include "cad_import/shape_fixes.hpp"

namespace hapticd::cad {
namespace {

constexpr double kLongest = 10;      ///< [s] for fixing a body, and for one run of sewing
constexpr double kFirstGap = 1e-6;   ///< [mm] first tolerance of sewing; raised 100-fold while edges stay free
constexpr double kWidestGap = 1e-2;  ///< [mm] largest tolerance of sewing
constexpr double kGapShare = 1e-3;   ///< share of the body's diagonal: sewing never closes wider gaps

double diagonalOf(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  return box.IsVoid() || box.IsOpen() ? 0 : std::sqrt(box.SquareExtent());
}

void moveColour(const TopoDS_Shape& from, const TopoDS_Shape& to, Colours& colours) {
  const auto known = colours.find(from.TShape().get());
  if (known == colours.end() || to.IsNull() || to.IsSame(from)) return;
  const std::uint32_t colour = known->second;
  for (TopExp_Explorer face(to, TopAbs_FACE); face.More(); face.Next())
    colours.emplace(face.Current().TShape().get(), colour);
}

TopoDS_Shape fixed(const TopoDS_Shape& shape, const std::string& body, Colours& colours,
                   std::vector<std::string>& steps) {
  if (mostLoops(shape) > kManyLoops) {
    steps.push_back(body + ": not checked, because it has a face with more than 200 loops");
    return shape;
  }
  if (BRepCheck_Analyzer(shape).IsValid()) return shape;
  const Handle(Progress) progress = new Progress("healing " + body, kLongest);
  const Handle(ShapeFix_Shape) fix = new ShapeFix_Shape(shape);
  fix->Perform(progress->Start());
  if (progress->late()) {
    steps.push_back(body + ": not valid, and not healed, because healing took longer than 10 s");
    return shape;
  }
  const TopoDS_Shape result = fix->Shape();
  if (result.IsNull()) return shape;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
    moveColour(face.Current(), fix->Context()->Apply(face.Current()), colours);
  const bool valid = BRepCheck_Analyzer(result).IsValid();
  steps.push_back(body + (valid ? ": was not valid, and was healed" : ": is not valid, even after healing"));
  return result;
}

struct Seam {
  TopoDS_Shape shape;
  Handle(BRepBuilderAPI_Sewing) sewing;
  int free = 0;
  double gap = 0;
};

/// Sews the faces, with larger tolerances as long as that leaves fewer edges free.
Seam sewn(const TopoDS_Shape& faces, const std::string& body) {
  const double widest = std::min(kWidestGap, kGapShare * diagonalOf(faces));
  Seam best;
  for (double gap = kFirstGap; gap <= widest * (1 + 1e-9); gap *= 100) {
    const Handle(Progress) progress = new Progress("sewing " + body, kLongest);
    Seam made{{}, new BRepBuilderAPI_Sewing(gap), 0, gap};
    for (TopExp_Explorer face(faces, TopAbs_FACE); face.More(); face.Next()) made.sewing->Add(face.Current());
    made.sewing->Perform(progress->Start());
    if (progress->late() || made.sewing->SewedShape().IsNull()) break;
    made.shape = made.sewing->SewedShape();
    made.free = made.sewing->NbFreeEdges();
    if (best.shape.IsNull() || made.free < best.free) best = made;
    if (best.free == 0) break;
  }
  return best;
}

TopoDS_Shape sewnFaces(const TopoDS_Shape& faces, const std::string& body, Colours& colours,
                       std::vector<std::string>& steps) {
  const Seam seam = sewn(faces, body);
  if (seam.shape.IsNull()) {
    steps.push_back(body + ": its loose faces could not be sewn within 10 s");
    return faces;
  }
  for (TopExp_Explorer face(faces, TopAbs_FACE); face.More(); face.Next())
    moveColour(face.Current(), seam.sewing->Modified(face.Current()), colours);
  char line[120];
  std::snprintf(line, sizeof line, ": loose faces sewn over gaps up to %.0e mm, %d edges stay free", seam.gap,
                seam.free);
  steps.push_back(body + line);
  return seam.shape;
}

/// Makes a solid from a closed shell, because it bounds a volume. Other shapes are returned unchanged.
TopoDS_Shape solidOf(const TopoDS_Shape& shape, const std::string& body, std::vector<std::string>& steps) {
  TopExp_Explorer shells(shape, TopAbs_SHELL);
  if (!shells.More() || TopExp_Explorer(shape, TopAbs_SOLID).More()) return shape;
  const TopoDS_Shell shell = TopoDS::Shell(shells.Current());
  shells.Next();
  if (shells.More() || TopExp_Explorer(shape, TopAbs_FACE, TopAbs_SHELL).More() || !BRep_Tool::IsClosed(shell))
    return shape;
  TopoDS_Solid solid;
  const BRep_Builder builder;
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  BRepLib::OrientClosedSolid(solid);
  steps.push_back(body + ": a closed shell, taken as a solid");
  return solid;
}

}  // namespace

TopoDS_Shape healed(const TopoDS_Shape& shape, const std::string& body, Colours& colours,
                    std::vector<std::string>& steps) {
  TopoDS_Shape result = fixed(shape, body, colours, steps);
  if (TopExp_Explorer(result, TopAbs_FACE, TopAbs_SHELL).More()) result = sewnFaces(result, body, colours, steps);
  result = solidOf(result, body, steps);
  BRepLib::BuildCurves3d(result);
  BRepLib::SameParameter(result);
  return result;
}

bool isInsideOut(const TopoDS_Shape& shape) {
  GProp_GProps volume;
  BRepGProp::VolumeProperties(shape, volume, true);
  return volume.Mass() < 0;
}

}  // namespace hapticd::cad
