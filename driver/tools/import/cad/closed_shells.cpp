// SPDX-License-Identifier: MIT
#include "cad_import/closed_shells.hpp"

#include <BRepBndLib.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <chrono>
#include <cstddef>

#include "cad_import/doubled_faces.hpp"
#include "cad_import/sides_check.hpp"

namespace hapticd::cad {
namespace {

/// A closed shell as a solid of its own, with the outside in front of its faces.
struct Closed {
  TopoDS_Solid solid;
  Bnd_Box box;
  std::vector<std::size_t> around;  ///< indices of the closed shells that it is inside of
};

TopoDS_Shape shellOf(const Closed& closed) {
  return TopExp_Explorer(closed.solid, TopAbs_SHELL).Current();
}

Closed closedOf(const TopoDS_Shape& shell) {
  Closed closed;
  const BRep_Builder builder;
  builder.MakeSolid(closed.solid);
  builder.Add(closed.solid, shell);
  BRepLib::OrientClosedSolid(closed.solid);
  BRepBndLib::Add(shell, closed.box, false);
  return closed;
}

bool holds(const Bnd_Box& box, const Bnd_Box& inner) {
  return !box.IsVoid() && !inner.IsVoid() && !box.IsOut(inner.CornerMin()) && !box.IsOut(inner.CornerMax());
}

/// True if a shell lies inside another one. The first vertex that is not on the other one decides, because shells that
/// were sewn do not cross.
bool isInside(const Closed& inner, BRepClass3d_SolidClassifier& outer) {
  for (TopExp_Explorer at(inner.solid, TopAbs_VERTEX); at.More(); at.Next()) {
    const TopoDS_Vertex vertex = TopoDS::Vertex(at.Current());
    outer.Perform(BRep_Tool::Pnt(vertex), BRep_Tool::Tolerance(vertex));
    if (outer.State() == TopAbs_IN || outer.State() == TopAbs_OUT) return outer.State() == TopAbs_IN;
  }
  return false;
}

void findAround(std::vector<Closed>& closed) {
  for (std::size_t outer = 0; outer < closed.size(); ++outer) {
    BRepClass3d_SolidClassifier classifier;
    bool loaded = false;
    for (std::size_t inner = 0; inner < closed.size(); ++inner) {
      if (inner == outer || !holds(closed[outer].box, closed[inner].box)) continue;
      if (!loaded) classifier.Load(closed[outer].solid);
      loaded = true;
      if (isInside(closed[inner], classifier)) closed[inner].around.push_back(outer);
    }
  }
}

/// True if the faces of a solid lie on one another, or do not have the outside in front of them.
bool isDoubtful(const TopoDS_Solid& solid, double& seconds) {
  if (!doubledFaces(solid).empty()) return true;
  if (seconds <= 0) return false;
  const auto begun = std::chrono::steady_clock::now();
  const bool doubtful = trySides(solid, seconds).doubtful();
  seconds -= std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return doubtful;
}

/// Adds to a solid the shells that lie in it, but in nothing else that lies in it. Returns their number.
int addCavities(TopoDS_Solid& solid, std::size_t index, const std::vector<Closed>& closed) {
  const BRep_Builder builder;
  int added = 0;
  for (const Closed& inner : closed) {
    if (inner.around.size() != closed[index].around.size() + 1) continue;
    bool within = false;
    for (const std::size_t outer : inner.around) within = within || outer == index;
    if (!within) continue;
    builder.Add(solid, shellOf(inner).Reversed());
    ++added;
  }
  return added;
}

}  // namespace

Volumes volumesOf(const TopoDS_Shape& shape, double& seconds) {
  Volumes volumes;
  std::vector<Closed> closed;
  TopoDS_Compound rest;
  const BRep_Builder builder;
  builder.MakeCompound(rest);
  for (TopExp_Explorer at(shape, TopAbs_SHELL); at.More(); at.Next()) {
    const bool is_closed = BRep_Tool::IsClosed(at.Current());
    if (is_closed) closed.push_back(closedOf(at.Current()));
    const bool doubtful = is_closed && isDoubtful(closed.back().solid, seconds);
    if (doubtful) closed.pop_back(), ++volumes.doubtful;
    if (doubtful || !is_closed) builder.Add(rest, at.Current());
  }
  for (TopExp_Explorer at(shape, TopAbs_FACE, TopAbs_SHELL); at.More(); at.Next()) builder.Add(rest, at.Current());
  findAround(closed);
  for (std::size_t i = 0; i < closed.size(); ++i) {
    if (closed[i].around.size() % 2 != 0) continue;
    volumes.cavities += addCavities(closed[i].solid, i, closed);
    volumes.bodies.push_back(closed[i].solid);
  }
  volumes.solids = static_cast<int>(volumes.bodies.size());
  if (closed.empty())
    volumes.bodies.push_back(shape);
  else if (TopExp_Explorer(rest, TopAbs_FACE).More())
    volumes.bodies.push_back(rest);
  return volumes;
}

}  // namespace hapticd::cad
