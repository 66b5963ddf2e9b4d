// SPDX-License-Identifier: MIT
#include "cad_import/part_builder.hpp"

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <Bnd_Box.hxx>
#include <Standard_Failure.hxx>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <gp_Quaternion.hxx>
#include <map>

#include "cad_import/bodies.hpp"
#include "cad_import/outline_check.hpp"
#include "cad_import/progress.hpp"
#include "cad_import/sides_check.hpp"

namespace hapticd::cad {
namespace {

using brep::kNone;
using brep::Part;

class PartBuilder {
 public:
  PartBuilder(CadFile& file, Report& report) : file_(file), report_(report) {}

  Part run() {
    part_.source.unit = file_.unit;
    part_.source.unit_assumed = file_.unit_assumed;
    part_.losses = file_.losses;
    part_.warnings = file_.remarks;
    const Handle(Progress) progress = new Progress("converting");
    Message_ProgressScope scope(progress->Start(), "converting", static_cast<double>(file_.nodes.size()));
    std::vector<std::uint32_t> instance_of;
    for (Node& node : file_.nodes) {
      instance_of.push_back(addNode(node, instance_of));
      scope.Next();
    }
    if (part_.faces.empty())
      throw CadError(part_.losses.empty() ? "there are no faces in it; expected solids, shells or faces: "
                                            "curves, points and finite elements are not taken"
                                          : "none of its faces can be kept; the first: " + part_.losses.front().what +
                                                ": " + part_.losses.front().reason);
    brep::linkCoedges(part_);
    return std::move(part_);
  }

 private:
  std::uint32_t nameIndex(const std::string& name) {
    if (name.empty()) return kNone;
    const auto [known, added] = names_.emplace(name, static_cast<std::uint32_t>(part_.names.size()));
    if (added) part_.names.push_back(name);
    return known->second;
  }

  std::uint32_t addNode(Node& node, const std::vector<std::uint32_t>& instance_of) {
    brep::Instance instance;
    instance.name = nameIndex(node.name);
    instance.colour = node.colour;
    if (node.parent >= 0) instance.parent = instance_of[static_cast<std::size_t>(node.parent)];
    place(node.pose, instance);
    std::vector<std::uint32_t> bodies;
    if (!node.shape.IsNull()) {
      bodies = bodiesOf(node);
      if (bodies.empty()) return kNone;
    }
    if (bodies.size() == 1) instance.body = bodies[0];
    part_.instances.push_back(instance);
    const auto index = static_cast<std::uint32_t>(part_.instances.size() - 1);
    if (bodies.size() > 1) addChildren(index, bodies);
    return index;
  }

  /// Adds the bodies of a shape that turned out to be several, as instances below its own.
  void addChildren(std::uint32_t parent, const std::vector<std::uint32_t>& bodies) {
    for (const std::uint32_t body : bodies) {
      brep::Instance child = part_.instances[parent];
      child.parent = parent;
      child.body = body;
      child.name = part_.bodies[body].name;
      part_.instances.push_back(child);
    }
  }

  static bool isRigid(const gp_Trsf& pose) { return !pose.IsNegative() && std::abs(pose.ScaleFactor() - 1) < 1e-12; }

  /// Sets the pose of an instance. The rotation is made orthogonal to the last bit, as a part file requires.
  static void place(const gp_Trsf& pose, brep::Instance& instance) {
    if (!isRigid(pose)) return;  // the body was built with the pose included
    const gp_Quaternion turn = pose.GetRotation();
    const gp_Mat rows = turn.Normalized().GetMatrix();
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(4 * i);
      for (int j = 0; j < 3; ++j) instance.pose[at + static_cast<std::size_t>(j)] = rows(i + 1, j + 1);
      instance.pose[at + 3] = pose.TranslationPart().Coord(i + 1) * kMetres;
    }
  }

  /// Returns the indices of a node's bodies; none if nothing of them can be kept. Bodies are built once, but mirrored
  /// and scaled ones are built for each of their places.
  std::vector<std::uint32_t> bodiesOf(Node& node) {
    const std::string name = node.body_name.empty() ? node.name : node.body_name;
    if (!isRigid(node.pose)) {
      report_.steps.push_back(name + ": mirrored or scaled, so it was stored as a body of its own");
      return build(BRepBuilderAPI_Transform(node.shape, node.pose, true).Shape(), name, node.colour);
    }
    const auto key = std::pair(static_cast<const void*>(node.shape.TShape().get()), node.shape.Orientation());
    if (const auto known = bodies_.find(key); known != bodies_.end()) return known->second;
    return bodies_[key] = build(node.shape, name, node.colour);
  }

  std::vector<std::uint32_t> build(const TopoDS_Shape& shape, const std::string& name, std::uint32_t colour) {
    std::vector<TopoDS_Shape> bodies{shape};
    try {
      bodies = healed(shape, name, file_.colours, report_.steps);
    } catch (const Standard_Failure& failure) {
      report_.steps.push_back(name + ": healing failed (" + failure.DynamicType()->Name() +
                              "); the body stays as it is");
    }
    std::vector<std::uint32_t> built;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const std::string own = bodies.size() == 1 ? name : name + " " + std::to_string(i + 1);
      if (const std::uint32_t body = add(bodies[i], own, colour); body != kNone) built.push_back(body);
    }
    return built;
  }

  /// Adds one body. Returns its index, or kNone if none of its faces can be kept.
  std::uint32_t add(const TopoDS_Shape& whole, const std::string& name, std::uint32_t colour) {
    BodyBuilder builder(file_.colours, name, part_);
    const std::uint32_t body = builder.add(whole, nameIndex(name), colour);
    report_.recognised += builder.recognisedFaces();
    judgeOutlines(builder.outlines(), whole, name);
    if (part_.bodies[body].kind == brep::BodyKind::kSolid) judgeSides(whole, name);
    if (part_.bodies[body].face_count > 0) return body;
    part_.bodies.pop_back();
    return kNone;
  }

  /// Warns of faces that are trimmed elsewhere than at their edges.
  void judgeOutlines(const std::vector<OutlineOff>& outlines, const TopoDS_Shape& shape, const std::string& name) {
    constexpr double kAllowed = 1e-3, kLeast = 0.02;  // share of the diagonal of the body; [mm] not felt below
    Bnd_Box box;
    BRepBndLib::Add(shape, box, false);
    if (box.IsVoid() || box.IsOpen()) return;
    const double allowed = std::max(kLeast, kAllowed * std::sqrt(box.SquareExtent()));
    const auto count =
        std::count_if(outlines.begin(), outlines.end(), [&](const OutlineOff& off) { return off.by > allowed; });
    if (count == 0) return;
    const OutlineOff worst = *std::max_element(outlines.begin(), outlines.end(),
                                               [](const OutlineOff& a, const OutlineOff& b) { return a.by < b.by; });
    char text[160];
    if (count == 1)
      std::snprintf(text, sizeof text, "': the outline of face %zu is off by %.2g mm: ", worst.face, worst.by);
    else
      std::snprintf(text, sizeof text,
                    "': the outlines of %d faces are off, that of face %zu most, by %.2g mm: ", static_cast<int>(count),
                    worst.face, worst.by);
    part_.warnings.push_back(
        "'" + name + text +
        (worst.at_vertex ? "an edge does not end at its vertex" : "an edge lies elsewhere than its curve on the face") +
        ", so the face may have another shape there; compare the part with the CAD program");
  }

  /// Warns of a solid whose faces do not bound one volume. The test is slow for large solids, so for all of them
  /// together it gets no more time than the rest of the import has taken.
  void judgeSides(const TopoDS_Shape& solid, const std::string& name) {
    constexpr double kLeast = 0.5, kMost = 4;  // [s]
    const double others = static_cast<double>(std::clock()) / CLOCKS_PER_SEC - sides_s_;
    const double left = std::clamp(others, kLeast, kMost) - sides_s_;
    if (left <= 0) return;
    const auto begun = std::chrono::steady_clock::now();
    try {
      const SidesTried found = trySides(solid, left);
      if (found.doubtful())
        part_.warnings.push_back("'" + name + "': " + std::to_string(found.wrong) + " of " +
                                 std::to_string(found.tried) +
                                 " faces tried do not have the outside in front of them and the inside behind: Open "
                                 "CASCADE may have read another part of a surface than the file means; compare the "
                                 "part with the CAD program, and save the file again from there");
    } catch (const Standard_Failure&) {
      report_.steps.push_back(name + ": its sides could not be tested");
    }
    sides_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  }

  CadFile& file_;
  Report& report_;
  Part part_;
  std::map<std::string, std::uint32_t> names_;
  std::map<std::pair<const void*, TopAbs_Orientation>, std::vector<std::uint32_t>> bodies_;
  double sides_s_ = 0;  ///< [s] spent in judgeSides()
};

}  // namespace

Part buildPart(CadFile& file, Report& report) {
  return PartBuilder(file, report).run();
}

}  // namespace hapticd::cad
