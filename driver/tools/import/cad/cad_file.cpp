// SPDX-License-Identifier: MIT
#include "cad_import/cad_file.hpp"

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <IGESData_IGESModel.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFApp_Application.hxx>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "cad_import/assembly.hpp"
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

double millimetresIn(const std::string& unit) {
  const std::pair<const char*, double> known[] = {{"mm", 1},     {"cm", 10},   {"m", 1000}, {"in", 25.4},
                                                  {"ft", 304.8}, {"um", 1e-3}, {"km", 1e6}};
  for (const auto& [symbol, size] : known)
    if (unit == symbol) return size;
  return 1;
}

void readStep(const std::string& file, CadFile& cad) {
  STEPCAFControl_Reader reader;
  reader.SetNameMode(true);
  reader.SetColorMode(true);
  reader.SetLayerMode(true);
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone)
    throw CadError("it is not a STEP file, or it is damaged (expected ISO-10303-21 with shapes in it)");
  findMissingEntities(reader.ChangeReader().WS(), cad.losses);
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.ChangeReader().FileUnits(lengths, angles, solid_angles);
  cad.unit = lengths.IsEmpty() ? "mm" : shortUnit(lengths.First().ToCString());
  Handle(TDocStd_Document) document = newDocument();
  const Handle(Progress) progress = new Progress("reading shapes");
  if (!reader.Transfer(document, progress->Start())) throw CadError("there are no shapes in it");
  readTree(document, cad);
  findLostFaces(reader.ChangeReader().WS(), millimetresIn(cad.unit), cad.losses);
}

/// Returns true if the file has the last section of an IGES file, which is one line with a T in column 73. The reader
/// does not notice if it is missing.
bool endsAsIges(const std::string& file) {
  constexpr std::size_t kSection = 72;
  std::ifstream in(file);
  std::string line, last;
  while (std::getline(in, line))
    if (line.size() > kSection) last = line;
  return last.size() > kSection && last[kSection] == 'T';
}

void readIges(const std::string& file, CadFile& cad) {
  IGESCAFControl_Reader reader;
  reader.SetNameMode(true);
  reader.SetColorMode(true);
  reader.SetLayerMode(true);
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) throw CadError("it is not an IGES file, or it is damaged");
  if (!endsAsIges(file)) throw CadError("it ends too early: the line of section T is missing; expected a whole file");
  const auto model = Handle(IGESData_IGESModel)::DownCast(reader.Model());
  if (!model.IsNull() && !model->GlobalSection().UnitName().IsNull())
    cad.unit = shortUnit(model->GlobalSection().UnitName()->ToCString());
  Handle(TDocStd_Document) document = newDocument();
  const Handle(Progress) progress = new Progress("reading shapes");
  if (!reader.Transfer(document, progress->Start())) throw CadError("there are no shapes in it");
  readTree(document, cad);
  findLostFaces(reader.WS(), 1, cad.losses);
}

/// Returns true if a word is C's text for a value that is not finite: "nan", "-inf", "1.#QNAN" and the like.
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
                       "' stands where a number belongs; expected finite coordinates: write the file again from its "
                       "source");
}

void readBrep(const std::string& file, CadFile& cad) {
  refuseNoNumbers(file);
  TopoDS_Shape shape;
  const BRep_Builder builder;
  const Handle(Progress) progress = new Progress("reading shapes");
  // The reader loops for ever if a word is missing, so the stream is made to throw.
  std::ifstream in(file);
  try {
    in.exceptions(std::ios::failbit | std::ios::badbit);
    BRepTools::Read(shape, in, builder, progress->Start());
  } catch (const std::ios::failure&) {
    throw CadError(
        "it is not a BREP file of Open CASCADE, or it is damaged: it ends too early, or has words where numbers "
        "belong");
  }
  if (shape.IsNull()) throw CadError("it is not a BREP file of Open CASCADE, or it is damaged");
  cad.unit = "mm";
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
  for (Node& node : cad.nodes)  // with assemblies, indices of parents would be wrong without the removed roots
    if (node.parent >= 0) return std::swap(cad.nodes, kept);
  Node node;
  node.name = node.body_name = name;
  node.shape = all;
  cad.nodes.push_back(node);
}

}  // namespace

CadFile readCad(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  CadFile cad;
  cad.unit = "mm";
  if (ending == ".step" || ending == ".stp")
    readStep(file, cad);
  else if (ending == ".iges" || ending == ".igs")
    readIges(file, cad);
  else if (ending == ".brep" || ending == ".rle")
    readBrep(file, cad);
  else
    throw CadError("expected a name that ends in .step, .stp, .iges, .igs, .brep or .rle");
  const std::string name = std::filesystem::path(file).stem().string();
  gatherLooseFaces(cad, name);
  for (Node& node : cad.nodes) {
    if (node.parent < 0 && node.name.empty()) node.name = name;
    if (node.parent < 0 && node.body_name.empty()) node.body_name = node.name;
  }
  return cad;
}

}  // namespace hapticd::cad
