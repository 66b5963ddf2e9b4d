// SPDX-License-Identifier: MIT
#include "document/foreign_file.hpp"

#include <algorithm>
#include <filesystem>

#include "base/file_ending.hpp"
#include "base/shell_word.hpp"

namespace hapticd::document {

namespace {

struct Kind {
  std::string_view ending, begins, name;
};

/// The kinds of files, recognised by their ending or their first words; kinds without first words only by the ending.
/// If several kinds match, the first one counts.
constexpr Kind kKinds[] = {{".step", "ISO-10303-21", "a STEP file"},
                           {".stp", "ISO-10303-21", "a STEP file"},
                           {".iges", "", "an IGES file"},
                           {".igs", "", "an IGES file"},
                           {".brep", "DBRep_Drawable", "a B-rep"},
                           {".brp", "", "a B-rep"},
                           {".stl", "solid ", "a mesh (STL)"},
                           {".ply", "ply\n", "a mesh (PLY)"},
                           {".obj", "", "a mesh (OBJ)"}};

constexpr std::string_view kRecording = "\x89HDF";  ///< the first bytes of an HDF5 file

}  // namespace

std::string foreignFile(std::string_view text, const std::string& file) {
  const std::string ending = endingOf(file);
  const std::string command = "; to write such a scene, run: hapticd import " + shellWord(file) + " --scene SCENE.yaml";
  if (ending == ".ma" && !text.empty())
    return "a soft body (medial mesh), expected YAML: use it as the geometry of mat_deformable" + command;
  if (ending == ".hpart")
    return "a part, expected YAML: use it as the geometry of nurbs_rigid (for a soft body use a .ma file)" + command;
  if (text.substr(0, kRecording.size()) == kRecording)
    return "a recording (HDF5), expected YAML: to run it again, use hapticd replay " + shellWord(file) +
           "; to read what happened, hapticd explain; to draw it, hapticd plot; to look at it, hapticd view";
  const auto is = [&](const Kind& kind) {
    return ending == kind.ending || (!kind.begins.empty() && text.substr(0, kind.begins.size()) == kind.begins);
  };
  const auto* const found = std::find_if(std::begin(kKinds), std::end(kKinds), is);
  if (found == std::end(kKinds)) return "";
  const std::string stem = std::filesystem::path(file).stem().string(), part = stem + ".hpart";
  const bool mesh = found->name.find("mesh") != found->name.npos;
  const std::string soft =
      mesh ? "for a soft body (mat_deformable), convert it with hapticd import --medial " + shellWord(file)
           : "a soft body (mat_deformable) needs a closed mesh of it instead: hapticd import "
             "--medial MESH.stl";
  return std::string(found->name) + ", expected YAML: convert it with hapticd import " + shellWord(file) + " -o " +
         shellWord(part) + " and write geometry: " + part +
         " for nurbs_rigid (--scene SCENE.yaml writes such a scene); " + soft + " -o " + shellWord(stem + ".ma");
}

}  // namespace hapticd::document
