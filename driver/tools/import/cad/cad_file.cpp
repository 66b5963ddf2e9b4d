// SPDX-License-Identifier: MIT
#include "cad_import/cad_file.hpp"

#include <BRepTools_ShapeSet.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <IGESData_BasicEditor.hxx>
#include <IGESData_IGESModel.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>
#include <XCAFApp_Application.hxx>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>
#include <unordered_set>

#include "cad_import/assembly.hpp"
#include "cad_import/iges_losses.hpp"
#include "cad_import/losses.hpp"
#include "cad_import/progress.hpp"

namespace hapticd::cad {
namespace {

Handle(TDocStd_Document) newDocument() {
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  return document;
}

/// Returns the short name of a unit, such as "mm" for "millimetre"; an unknown unit is returned in lower case.
std::string shortUnit(std::string unit) {
  std::transform(unit.begin(), unit.end(), unit.begin(), [](unsigned char c) { return std::tolower(c); });
  const std::pair<const char*, const char*> known[] = {{"millimetre", "mm"}, {"millimeter", "mm"}, {"centimetre", "cm"},
                                                       {"centimeter", "cm"}, {"metre", "m"},       {"meter", "m"},
                                                       {"inch", "in"},       {"inches", "in"},     {"foot", "ft"},
                                                       {"micrometre", "um"}, {"kilometre", "km"}};
  for (const auto& [name, symbol] : known)
    if (unit == name) return symbol;
  return unit;
}

/// Notes that the file states no unit. Open CASCADE takes millimetres then.
void assumeUnit(CadFile& cad) {
  cad.unit = "mm";
  cad.unit_assumed = true;
  cad.remarks.emplace_back(kNoUnit);
}

double millimetresIn(const std::string& unit) {
  const std::pair<const char*, double> known[] = {{"mm", 1},     {"cm", 10},   {"m", 1000}, {"in", 25.4},
                                                  {"ft", 304.8}, {"um", 1e-3}, {"km", 1e6}};
  for (const auto& [symbol, size] : known)
    if (unit == symbol) return size;
  return 1;
}

std::string noShapes(const std::vector<brep::Loss>& losses) {
  const std::string text = "there are no shapes in it";
  return losses.empty() ? text : text + "; " + losses.front().what + ": " + losses.front().reason;
}

constexpr std::string_view kMark = "\xef\xbb\xbf";  ///< byte order mark, which some editors write before UTF-8 text

/// Reads a STEP file. Open CASCADE refuses a file that begins with a byte order mark, so the mark is skipped. Files
/// that it refers to are found beside it only if its path begins at the root.
bool parseStep(const std::string& file, bool marked, STEPCAFControl_Reader& reader) {
  const std::string path = std::filesystem::absolute(file).string();
  if (!marked) return reader.ReadFile(path.c_str()) == IFSelect_RetDone;
  std::ifstream in(file, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(kMark.size()));
  return reader.ChangeReader().ReadStream(path.c_str(), in) == IFSelect_RetDone;
}

/// Returns why Open CASCADE may have refused a STEP file. @param start the first bytes of the file
std::string stepFault(const std::string& file, std::string_view start) {
  if (start.find("ISO-10303-21") == start.npos) return "it is not a STEP file: its first line is not ISO-10303-21;";
  constexpr std::streamoff kEnd = 4096;
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  in.seekg(std::max(std::streamoff{0}, static_cast<std::streamoff>(in.tellg()) - kEnd));
  const std::string end((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (end.find("END-ISO-10303-21") == end.npos)
    return "it is a STEP file that ends too early: its last line END-ISO-10303-21; is missing; expected a whole file";
  return "it is a damaged STEP file: a line breaks the rules of ISO 10303-21; write the file again from its source";
}

/// Notes that the shapes of a STEP file without faces are triangles (AP242), which Open CASCADE 7.6 does not read.
void findTriangles(const std::string& file, CadFile& cad) {
  for (const Node& node : cad.nodes)
    if (!node.shape.IsNull() && TopExp_Explorer(node.shape, TopAbs_FACE).More()) return;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.find("TRIANGULATED_FACE") != line.npos || line.find("TRIANGULATED_SURFACE_SET") != line.npos) {
      cad.losses.insert(cad.losses.begin(), {"its tessellated shapes",
                                             "they are triangles, which are not read from STEP; export exact "
                                             "surfaces, or an STL, OBJ or PLY file",
                                             0, brep::kNone});
      return;
    }
}

void readStep(const std::string& file, CadFile& cad) {
  STEPCAFControl_Reader reader;
  reader.SetNameMode(true);
  reader.SetColorMode(true);
  reader.SetLayerMode(true);
  std::string start(512, '\0');
  std::ifstream(file, std::ios::binary).read(start.data(), static_cast<std::streamsize>(start.size()));
  if (!parseStep(file, start.starts_with(kMark), reader)) throw CadError(stepFault(file, start));
  findMissingEntities(reader.ChangeReader().WS(), cad.losses);
  findOddEntities(reader.ChangeReader().WS(), cad.remarks);
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.ChangeReader().FileUnits(lengths, angles, solid_angles);
  if (!lengths.IsEmpty() && !lengths.First().IsEmpty())
    cad.unit = shortUnit(lengths.First().ToCString());
  else if (cad.remarks.empty())
    assumeUnit(cad);
  cad.unit_assumed = std::find(cad.remarks.begin(), cad.remarks.end(), kNoUnit) != cad.remarks.end();
  Handle(TDocStd_Document) document = newDocument();
  const Handle(Progress) progress = new Progress("reading shapes");
  const bool made = reader.Transfer(document, progress->Start());
  findMissingFiles(reader, cad.losses);
  if (made) readTree(document, cad);
  findLostFaces(reader.ChangeReader().WS(), millimetresIn(cad.unit), cad.losses);
  findMadeSolids(reader.ChangeReader().WS(), cad.losses);
  findChangedCopies(reader.ChangeReader().WS(), cad.losses);
  findTriangles(file, cad);
  if (!made) throw CadError(noShapes(cad.losses));
}

/// Returns true if the last section of an IGES file is there: one line with a T in column 73. Open CASCADE accepts a
/// file without it, so a file that was cut off would be read as if it were complete.
bool endsAsIges(const std::string& file) {
  constexpr std::size_t kSection = 72;
  std::ifstream in(file);
  std::string line, last;
  while (std::getline(in, line))
    if (line.size() > kSection) last = line;
  return last.size() > kSection && last[kSection] == 'T';
}

/// Reads the unit of an IGES file. The header gives the unit as a number and as a name. The name counts only if the
/// number is 3 (IGES 5.3, global parameters 14 and 15).
void readIgesUnit(const IGESData_GlobalSection& section, CadFile& cad) {
  constexpr const char* kUnits[] = {"in", "mm", "", "ft", "mi", "m", "km", "mil", "um", "cm", "uin"};
  constexpr int kByName = 3;
  int number = section.UnitFlag();
  if (number < 0 || number > static_cast<int>(std::size(kUnits)))
    throw CadError("its unit has the number " + std::to_string(number) +
                   "; expected 1 to 11 (IGES 5.3, global parameter 14), such as 2 for millimetres");
  if (number == kByName)
    number = section.UnitName().IsNull() ? 0 : IGESData_BasicEditor::UnitNameFlag(section.UnitName()->ToCString());
  if (number == 0 || number == kByName) return assumeUnit(cad);
  cad.unit = kUnits[number - 1];
}

/// Notes a scale of an IGES file. It is meant for drawings, and Open CASCADE leaves it out.
void noteIgesScale(const IGESData_GlobalSection& section, CadFile& cad) {
  const double scale = section.Scale();
  if (!(scale > 0) || scale == 1) return;
  char text[160];
  std::snprintf(text, sizeof text,
                "the file states a scale of %.6g of its model to the thing, which was left out: if the size is wrong, "
                "import it with --scale %.6g",
                scale, 1 / scale);
  cad.remarks.emplace_back(text);
}

void readIges(const std::string& file, CadFile& cad) {
  IGESCAFControl_Reader reader;
  reader.SetNameMode(true);
  reader.SetColorMode(true);
  reader.SetLayerMode(true);
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) throw CadError("it is not an IGES file, or it is damaged");
  if (!endsAsIges(file)) throw CadError("it ends too early: the line of section T is missing; expected a whole file");
  const auto model = Handle(IGESData_IGESModel)::DownCast(reader.Model());
  if (!model.IsNull()) readIgesUnit(model->GlobalSection(), cad), noteIgesScale(model->GlobalSection(), cad);
  Handle(TDocStd_Document) document = newDocument();
  const Handle(Progress) progress = new Progress("reading shapes");
  const bool made = reader.Transfer(document, progress->Start());
  findLostIges(reader.WS(), cad.losses);
  if (!made) throw CadError(noShapes(cad.losses));
  readTree(document, cad);
}

/// Returns true if a word is what C's printf() writes for a value that is not finite: "nan", "-inf", "1.#QNAN" and the
/// like.
bool isNoNumber(std::string word) {
  std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
  if (word.find("#qnan") != word.npos || word.find("#inf") != word.npos || word.find("#ind") != word.npos) return true;
  if (word[0] == '+' || word[0] == '-') word.erase(0, 1);
  return word == "nan" || word.starts_with("nan(") || word == "inf" || word == "infinity";
}

/// Fails if a coordinate is not finite, because Open CASCADE would then compute for ever.
void refuseNoNumbers(const std::string& file) {
  std::ifstream in(file);
  std::string line, word;
  for (std::size_t number = 1; std::getline(in, line); ++number)
    for (std::istringstream words(line); words >> word;)
      if (isNoNumber(word))
        throw CadError("line " + std::to_string(number) + ": '" + word +
                       "' stands where a number belongs; "
                       "expected finite coordinates: write the file again from its source");
}

/// Returns the shapes of a BREP file that belong to no other shape and have faces.
TopoDS_Shape mainShapes(const BRepTools_ShapeSet& set) {
  std::unordered_set<const void*> parts;
  for (int i = 1; i <= set.NbShapes(); ++i)
    for (TopoDS_Iterator at(set.Shape(i)); at.More(); at.Next()) parts.insert(at.Value().TShape().get());
  TopoDS_Compound all;
  const BRep_Builder builder;
  builder.MakeCompound(all);
  for (int i = set.NbShapes(); i >= 1; --i)
    if (const TopoDS_Shape& shape = set.Shape(i);
        !parts.contains(shape.TShape().get()) && TopExp_Explorer(shape, TopAbs_FACE).More())
      builder.Add(all, shape);
  return all;
}

/// Reads the shapes of a BREP file. Some programs write the set of all shapes without its last line, which names the
/// main one.
TopoDS_Shape shapeOfBrep(std::istream& in, std::vector<std::string>& remarks) {
  TopoDS_Shape shape;
  BRepTools_ShapeSet set{BRep_Builder()};
  const Handle(Progress) progress = new Progress("reading shapes");
  set.Read(in, progress->Start());
  in.exceptions(std::ios::goodbit);
  in >> std::ws;
  if (in.eof() && set.NbShapes() > 0) {
    remarks.emplace_back("the file names no main shape, so the shapes that belong to no other were taken");
    return mainShapes(set);
  }
  in.exceptions(std::ios::failbit | std::ios::badbit);
  set.Read(shape, in);
  return shape;
}

/// Fails if a BREP file is of the binary form, which begins with an empty line and these words.
void refuseBinary(const std::string& file) {
  constexpr std::string_view kStart = "\nOpen CASCADE Topology";
  std::string start(kStart.size(), '\0');
  std::ifstream(file, std::ios::binary).read(start.data(), static_cast<std::streamsize>(start.size()));
  if (start == kStart)
    throw CadError(
        "it is a BREP file in binary form, which is not read; expected the form of text: write it again as text, or as "
        "STEP");
}

/// Fails if a face has triangles and no surface, because Open CASCADE's repairs would crash.
void refuseBareTriangles(const TopoDS_Shape& shape) {
  std::size_t faces = 0, bare = 0;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next(), ++faces)
    bare += BRep_Tool::Surface(TopoDS::Face(at.Current())).IsNull() ? 1 : 0;
  if (bare > 0)
    throw CadError("it has faces of triangles without a surface (" + std::to_string(bare) + " of " +
                   std::to_string(faces) + "); expected surfaces: export these, or write an STL, OBJ or PLY file");
}

void readBrep(const std::string& file, CadFile& cad) {
  refuseBinary(file);
  refuseNoNumbers(file);
  TopoDS_Shape shape;
  // At the end of an incomplete file Open CASCADE's reader would loop for ever, so the stream throws there.
  std::ifstream in(file);
  try {
    in.exceptions(std::ios::failbit | std::ios::badbit);
    shape = shapeOfBrep(in, cad.remarks);
  } catch (const std::ios::failure&) {
    throw CadError(
        "it is not a BREP file of Open CASCADE, or it is damaged: "
        "it ends too early, or has words where numbers belong");
  }
  if (shape.IsNull()) throw CadError("it is not a BREP file of Open CASCADE, or it is damaged");
  refuseBareTriangles(shape);
  assumeUnit(cad);
  Node node;
  node.name = node.body_name = std::filesystem::path(file).stem().string();
  addShape(shape, node, cad);
}

/// Gathers the loose faces of a file format without solids (IGES) in one compound, so that they can be sewn.
void gatherLooseFaces(CadFile& cad, const std::string& name) {
  TopoDS_Compound all;
  const BRep_Builder builder;
  builder.MakeCompound(all);
  int gathered = 0;
  std::vector<Node> kept;
  for (const Node& node : cad.nodes) {
    const bool loose = node.parent < 0 && !node.shape.IsNull() && node.shape.ShapeType() == TopAbs_COMPOUND;
    if (loose) {
      builder.Add(all, node.shape.Moved(TopLoc_Location(node.pose)));
      if (node.colour != 0)
        for (TopExp_Explorer at(node.shape, TopAbs_FACE); at.More(); at.Next())
          cad.colours.emplace(at.Current().TShape().get(), node.colour);
      ++gathered;
    } else {
      kept.push_back(node);
    }
  }
  if (gathered < 2) return;
  std::swap(cad.nodes, kept);
  for (Node& node : cad.nodes)  // if there are assemblies, removing nodes would make their indices of parents wrong
    if (node.parent >= 0) return std::swap(cad.nodes, kept);
  Node node;
  node.name = node.body_name = name;
  node.shape = all;
  cad.nodes.push_back(node);
}

/// Names what the file leaves without a name after the assembly that holds it, or after the file. Otherwise neither
/// messages nor scenes could refer to it.
void nameNodes(CadFile& cad, const std::string& file) {
  std::vector<int> unnamed(cad.nodes.size(), 0);
  for (Node& node : cad.nodes) {
    const auto parent = static_cast<std::size_t>(node.parent);
    if (node.name.empty())
      node.name = node.parent < 0 ? file : cad.nodes[parent].name + " " + std::to_string(++unnamed[parent]);
    if (node.body_name.empty()) node.body_name = node.name;
  }
}

}  // namespace

CadFile readCad(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  CadFile cad;
  cad.unit = "mm";  // unless the file states another
  if (ending == ".step" || ending == ".stp")
    readStep(file, cad);
  else if (ending == ".iges" || ending == ".igs")
    readIges(file, cad);
  else if (ending == ".brep" || ending == ".brp" || ending == ".rle")
    readBrep(file, cad);
  else
    throw CadError("expected a name that ends in .step, .stp, .iges, .igs, .brep, .brp or .rle");
  const std::string name = std::filesystem::path(file).stem().string();
  gatherLooseFaces(cad, name);
  nameNodes(cad, name);
  return cad;
}

}  // namespace hapticd::cad
