// SPDX-License-Identifier: MIT
#include "cad_import/assembly.hpp"

#include <BRep_Builder.hxx>
#include <Quantity_ColorRGBA.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_Location.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "kernels/part/names.hpp"

namespace hapticd::cad {
namespace {

constexpr std::size_t kMostNodes = 1'000'000;
constexpr int kDeepest = 200;

std::string nameOf(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return "";
  const TCollection_ExtendedString& wide = name->Get();
  std::string text(static_cast<std::size_t>(wide.LengthOfCString()) + 1, '\0');
  Standard_PCharacter at = text.data();
  wide.ToUTF8CString(at);
  text.resize(text.find('\0'));
  if (text.rfind("=>[", 0) == 0) return "";  // Open CASCADE gives this name to references that have none
  // Open CASCADE gives these names to shapes that have none.
  for (const char* kind : {"COMPOUND", "COMPSOLID", "SOLID", "SHELL", "FACE"})
    if (text == kind) return "";
  if (text.rfind("Open CASCADE STEP translator", 0) == 0) return "";  // and this one to files that it writes without
  return brep::plainText(std::move(text));
}

/// Open CASCADE gives the number of the reference to a component without a name. It says nothing to a person.
bool isNumber(const std::string& name) {
  return !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
}

/// Returns what a label stands for: the shape that it refers to, or itself.
TDF_Label shapeOf(const TDF_Label& label) {
  TDF_Label shape = label;
  if (XCAFDoc_ShapeTool::IsReference(label)) XCAFDoc_ShapeTool::GetReferredShape(label, shape);
  return shape;
}

/// Returns the names of the components of an assembly. One without a name has that of its shape, and its number behind
/// it where several would have the same name.
std::vector<std::string> namesOf(const TDF_LabelSequence& components) {
  std::map<std::string, int> nameless;
  for (const TDF_Label& component : components)
    if (const std::string own = nameOf(component); own.empty() || isNumber(own)) ++nameless[nameOf(shapeOf(component))];
  std::vector<std::string> names;
  for (const TDF_Label& component : components) {
    const std::string own = nameOf(component), shape = nameOf(shapeOf(component));
    if ((own.empty() || isNumber(own)) && !shape.empty())
      names.push_back(nameless[shape] > 1 && !own.empty() ? shape + " " + own : shape);
    else
      names.push_back(own);
  }
  return names;
}

std::uint32_t packed(const Quantity_ColorRGBA& colour) {
  Standard_Real rgb[3];
  colour.GetRGB().Values(rgb[0], rgb[1], rgb[2], Quantity_TOC_sRGB);
  const auto byte = [](double share) { return static_cast<std::uint32_t>(std::lround(255 * share)) & 255u; };
  return byte(rgb[0]) | byte(rgb[1]) << 8 | byte(rgb[2]) << 16 | byte(static_cast<double>(colour.Alpha())) << 24;
}

/// Returns the faces of a shape that belong to no shell, in the groups (nested compounds) of the file: a group is often
/// one part.
TopoDS_Compound looseFacesOf(const TopoDS_Shape& shape) {
  TopoDS_Compound loose;
  const BRep_Builder builder;
  builder.MakeCompound(loose);
  if (shape.ShapeType() == TopAbs_FACE) builder.Add(loose, shape);
  if (shape.ShapeType() != TopAbs_COMPOUND) return loose;
  for (TopoDS_Iterator at(shape); at.More(); at.Next()) {
    if (at.Value().ShapeType() == TopAbs_FACE) builder.Add(loose, at.Value());
    if (at.Value().ShapeType() != TopAbs_COMPOUND) continue;
    const TopoDS_Compound group = looseFacesOf(at.Value());
    if (TopoDS_Iterator(group).More()) builder.Add(loose, group);
  }
  return loose;
}

/// Returns first the solids, then the shells that belong to no solid, then the faces that belong to no shell, as one
/// compound.
std::vector<TopoDS_Shape> piecesOf(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Shape> pieces;
  for (TopExp_Explorer at(shape, TopAbs_SOLID); at.More(); at.Next()) pieces.push_back(at.Current());
  for (TopExp_Explorer at(shape, TopAbs_SHELL, TopAbs_SOLID); at.More(); at.Next()) pieces.push_back(at.Current());
  const TopoDS_Compound loose = looseFacesOf(shape);
  if (TopoDS_Iterator(loose).More()) pieces.push_back(loose);
  return pieces;
}

class Tree {
 public:
  Tree(const Handle(TDocStd_Document) & document, CadFile& file)
      : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        colours_(XCAFDoc_DocumentTool::ColorTool(document->Main())),
        file_(file) {}

  void run() {
    TDF_LabelSequence roots;
    shapes_->GetFreeShapes(roots);
    for (const TDF_Label& root : roots) walk(root, "", gp_Trsf(), -1, 0, 0);
  }

 private:
  std::uint32_t colourOf(const TDF_Label& label) const {
    Quantity_ColorRGBA colour;
    for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen})
      if (colours_->GetColor(label, type, colour)) return packed(colour);
    return 0;
  }

  void colourParts(const TDF_Label& label) {
    TDF_LabelSequence parts;
    XCAFDoc_ShapeTool::GetSubShapes(label, parts);
    for (const TDF_Label& part : parts)
      if (const std::uint32_t colour = colourOf(part); colour != 0)
        file_.colours[XCAFDoc_ShapeTool::GetShape(part).TShape().get()] = colour;
  }

  void walk(const TDF_Label& label, const std::string& name, gp_Trsf pose, int parent, std::uint32_t colour,
            int depth) {
    if (depth > kDeepest) throw CadError("its assemblies are nested more than 200 levels deep; expected at most 200");
    const TDF_Label shape = shapeOf(label);
    if (XCAFDoc_ShapeTool::IsReference(label)) pose.Multiply(XCAFDoc_ShapeTool::GetLocation(label).Transformation());
    Node node;
    node.body_name = nameOf(shape);
    node.name = name;
    if (node.name.empty()) node.name = node.body_name;
    node.parent = parent;
    node.pose = pose;
    node.colour = colourOf(label);
    if (node.colour == 0) node.colour = colourOf(shape);
    if (node.colour == 0) node.colour = colour;
    if (!XCAFDoc_ShapeTool::IsAssembly(shape)) {
      colourParts(shape);
      return addShape(XCAFDoc_ShapeTool::GetShape(shape), node, file_);
    }
    const auto index = static_cast<int>(file_.nodes.size());
    file_.nodes.push_back(node);
    TDF_LabelSequence components;
    XCAFDoc_ShapeTool::GetComponents(shape, components);
    const std::vector<std::string> names = namesOf(components);
    std::size_t at = 0;
    for (const TDF_Label& component : components) walk(component, names[at++], pose, index, node.colour, depth + 1);
  }

  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colours_;
  CadFile& file_;
};

}  // namespace

void addShape(const TopoDS_Shape& shape, Node node, CadFile& file) {
  if (shape.IsNull()) return;
  const std::vector<TopoDS_Shape> pieces = piecesOf(shape);
  if (file.nodes.size() + pieces.size() >= kMostNodes)
    throw CadError("it has more than 1,000,000 instances; expected fewer: export a simpler assembly");
  const gp_Trsf pose = node.pose;
  const std::string name = node.name, body_name = node.body_name.empty() ? name : node.body_name;
  if (pieces.size() > 1) {
    const int parent = static_cast<int>(file.nodes.size());
    file.nodes.push_back(node);
    node.parent = parent;
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    node.shape = pieces[i].Located(TopLoc_Location());
    node.pose = pose * pieces[i].Location().Transformation();
    const auto own = file.colours.find(pieces[i].TShape().get());
    Node& added = file.nodes.emplace_back(node);
    if (own != file.colours.end()) added.colour = own->second;
    if (pieces.size() == 1) continue;
    added.name = added.body_name = body_name.empty() ? "" : body_name + " " + std::to_string(i + 1);
  }
}

void readTree(const Handle(TDocStd_Document) & document, CadFile& file) {
  Tree(document, file).run();
}

}  // namespace hapticd::cad
