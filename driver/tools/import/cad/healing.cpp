// SPDX-License-Identifier: MIT
#include "cad_import/healing.hpp"

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeFix_Shape.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "base/counted.hpp"
#include "cad_import/closed_shells.hpp"
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
  double gap = kFirstGap;
  while (gap <= widest * (1 + 1e-9)) {
    const Handle(Progress) progress = new Progress("sewing " + body, kLongest);
    Seam made{{}, new BRepBuilderAPI_Sewing(gap), 0, gap};
    for (TopExp_Explorer face(faces, TopAbs_FACE); face.More(); face.Next()) made.sewing->Add(face.Current());
    made.sewing->Perform(progress->Start());
    if (progress->late() || made.sewing->SewedShape().IsNull()) break;
    made.shape = made.sewing->SewedShape();
    made.free = made.sewing->NbFreeEdges();
    if (best.shape.IsNull() || made.free < best.free) best = made;
    if (best.free == 0) break;
    gap *= 100;
  }
  return best;
}

/// Keeps the colours of faces that were sewn.
TopoDS_Shape kept(const Seam& seam, const TopoDS_Shape& faces, Colours& colours) {
  for (TopExp_Explorer face(faces, TopAbs_FACE); face.More(); face.Next())
    moveColour(face.Current(), seam.sewing->Modified(face.Current()), colours);
  return seam.shape;
}

TopoDS_Shape sewnFaces(const TopoDS_Shape& faces, const std::string& body, Colours& colours,
                       std::vector<std::string>& steps) {
  const Seam seam = sewn(faces, body);
  if (seam.shape.IsNull()) {
    steps.push_back(body + ": its loose faces could not be sewn within 10 s");
    return faces;
  }
  TopExp_Explorer face(faces, TopAbs_FACE);
  if (face.More()) face.Next();
  if (!face.More()) return kept(seam, faces, colours);  // a single face has nothing to be sewn to
  char line[120];
  std::snprintf(line, sizeof line, ": loose faces sewn over gaps up to %.0e mm, %d edges stay free", seam.gap,
                seam.free);
  steps.push_back(body + line);
  return kept(seam, faces, colours);
}

/// Sorts what a shape consists of: its groups of several faces, and as one more group everything else.
void findGroups(const TopoDS_Shape& shape, std::vector<TopoDS_Shape>& groups, TopoDS_Compound& rest) {
  const BRep_Builder builder;
  for (TopoDS_Iterator at(shape); at.More(); at.Next()) {
    if (at.Value().ShapeType() != TopAbs_COMPOUND) {
      builder.Add(rest, at.Value());
      continue;
    }
    TopoDS_Compound own;
    builder.MakeCompound(own);
    findGroups(at.Value(), groups, own);
    TopExp_Explorer face(own, TopAbs_FACE);
    const bool any = face.More();
    if (any) face.Next();
    if (any) face.More() ? groups.push_back(own) : builder.Add(rest, own);
  }
}

/// Sews the faces of each group that closes by itself, because that is one part of an assembly: sewn together, parts
/// that touch would grow into one. The faces of all other groups are sewn together. Returns what they became.
std::vector<TopoDS_Shape> sewnGroups(const TopoDS_Shape& faces, const std::string& body, Colours& colours,
                                     std::vector<std::string>& steps) {
  std::vector<TopoDS_Shape> groups, parts;
  TopoDS_Compound rest;
  const BRep_Builder builder;
  builder.MakeCompound(rest);
  if (faces.ShapeType() == TopAbs_COMPOUND) findGroups(faces, groups, rest);
  if (groups.size() < 2) return {sewnFaces(faces, body, colours, steps)};
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kLongest);
  for (const TopoDS_Shape& group : groups) {
    const Seam seam = std::chrono::steady_clock::now() < end ? sewn(group, body) : Seam{};
    if (!seam.shape.IsNull() && seam.free == 0)
      parts.push_back(kept(seam, group, colours));
    else
      builder.Add(rest, group);
  }
  if (parts.empty()) return {sewnFaces(faces, body, colours, steps)};
  steps.push_back(body + ": " + std::to_string(parts.size()) + " of " + std::to_string(groups.size()) +
                  " groups of loose faces sewn, each to a part without free edges");
  if (TopExp_Explorer(rest, TopAbs_FACE).More()) parts.push_back(sewnFaces(rest, body, colours, steps));
  return parts;
}

/// Makes solids of the closed shells of shapes without solids, because they bound volumes.
std::vector<TopoDS_Shape> solidsOf(const std::vector<TopoDS_Shape>& shapes, const std::string& body,
                                   std::vector<std::string>& steps) {
  std::vector<TopoDS_Shape> bodies;
  int solids = 0, cavities = 0, doubtful = 0;
  double seconds = 4;  // for testing all shells
  for (const TopoDS_Shape& shape : shapes) {
    Volumes volumes{{shape}, 0, 0, 0};
    if (!TopExp_Explorer(shape, TopAbs_SOLID).More()) volumes = volumesOf(shape, seconds);
    bodies.insert(bodies.end(), volumes.bodies.begin(), volumes.bodies.end());
    solids += volumes.solids;
    cavities += volumes.cavities;
    doubtful += volumes.doubtful;
  }
  if (solids == 1 && cavities == 0)
    steps.push_back(body + ": a closed shell, taken as a solid");
  else if (solids > 0)
    steps.push_back(body + ": " + std::to_string(solids + cavities) + " closed shells, taken as " +
                    counted(solids, "solid") + " with " + counted(cavities, "cavity", "cavities"));
  if (doubtful > 0)
    steps.push_back(
        body + ": closed shells whose faces bound no single volume, felt from both sides: " + std::to_string(doubtful));
  return bodies;
}

}  // namespace

std::vector<TopoDS_Shape> healed(const TopoDS_Shape& shape, const std::string& body, Colours& colours,
                                 std::vector<std::string>& steps) {
  std::vector<TopoDS_Shape> parts{fixed(shape, body, colours, steps)};
  if (TopExp_Explorer(parts[0], TopAbs_FACE, TopAbs_SHELL).More()) parts = sewnGroups(parts[0], body, colours, steps);
  std::vector<TopoDS_Shape> bodies = solidsOf(parts, body, steps);
  for (TopoDS_Shape& made : bodies) {
    BRepLib::BuildCurves3d(made);
    BRepLib::SameParameter(made);
  }
  return bodies;
}

bool isInsideOut(const TopoDS_Shape& shape) {
  GProp_GProps volume;
  BRepGProp::VolumeProperties(shape, volume, true);
  return volume.Mass() < 0;
}

}  // namespace hapticd::cad
