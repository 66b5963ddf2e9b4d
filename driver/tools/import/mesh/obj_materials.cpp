// SPDX-License-Identifier: MIT
#include "mesh_import/obj_materials.hpp"

#include <algorithm>

#include "base/counted.hpp"
#include "base/file_ending.hpp"
#include "mesh_import/mesh_colours.hpp"
#include "mesh_import/mesh_text.hpp"

namespace hapticd::importing {
namespace {

constexpr std::size_t kMostLibraries = 16;  ///< files of materials that are read

std::string trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\v\f");
  return begin == std::string_view::npos
             ? ""
             : std::string(text.substr(begin, text.find_last_not_of(" \t\v\f") + 1 - begin));
}

/// Returns the words of a line if all of them end in .mtl, else the whole line: most programs do not quote blanks.
std::vector<std::string> namesIn(std::string_view line) {
  Words words(line);
  std::vector<std::string> names;
  words.nextLine();
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) names.emplace_back(word);
  if (std::all_of(names.begin(), names.end(), [](const std::string& name) { return endingOf(name) == ".mtl"; }))
    return names;
  return {trimmed(line)};
}

/// True for a name that stays in the folder of the mesh, with the separators of any system.
bool staysBeside(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  const bool drive = name.size() > 1 && name[1] == ':';
  if (name.starts_with('/') || drive) return false;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find('/', begin), name.size());
    if (name.substr(begin, end - begin) == "..") return false;
    begin = end + 1;
  }
  return std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < ' '; });
}

/// Reads the colour of a line Kd. One number is a grey.
std::uint32_t nextColour(Words& words) {
  const auto red = finiteNumber(words.next());
  if (!red) return 0;  // a spectrum, or CIE XYZ
  const std::string_view second = words.next();
  if (second.empty()) return colourWord(*red, *red, *red);
  const auto green = finiteNumber(second), blue = finiteNumber(words.next());
  return green && blue ? colourWord(*red, *green, *blue) : 0;
}

}  // namespace

void ObjMaterials::addLibrary(std::string_view names) {
  for (const std::string& name : namesIn(names)) {
    if (name.empty() || !known_libraries_.insert(name).second) continue;
    libraries_.push_back(name);
  }
}

void ObjMaterials::use(std::string_view name) {
  const std::string key = trimmed(name);
  present_ = key.empty() ? 0 : numbers_.try_emplace(key, static_cast<std::uint32_t>(numbers_.size() + 1)).first->second;
}

std::vector<std::array<std::uint32_t, 3>> ObjMaterials::colours(std::vector<std::string>& remarks) {
  if (numbers_.empty() || !read_) return {};
  colour_.assign(numbers_.size() + 1, 0);
  for (std::size_t i = 0; i < std::min(libraries_.size(), kMostLibraries); ++i) readLibrary(libraries_[i], remarks);
  if (libraries_.size() > kMostLibraries) {
    remarks.push_back("only the first " + std::to_string(kMostLibraries) + " of " + std::to_string(libraries_.size()) +
                      " files of materials were read");
    all_read_ = false;
  }
  if (textures_ > 0)
    remarks.push_back(counted(textures_, "material has a picture", "materials have a picture") +
                      " (map_Kd), which is not kept: only the colour (Kd) is");
  if (all_read_) tellColourless(remarks);
  std::vector<std::array<std::uint32_t, 3>> colours;
  colours.reserve(material_.size());
  for (const std::uint32_t material : material_) {
    const std::uint32_t word = colour_[material];
    colours.push_back({word, word, word});
  }
  if (std::all_of(colour_.begin(), colour_.end(), [](std::uint32_t word) { return word == 0; })) colours.clear();
  return colours;
}

/// Reads the colours of one file of materials. Nothing in it can name a further one.
void ObjMaterials::readLibrary(const std::string& name, std::vector<std::string>& remarks) {
  const std::string file = "the file of materials '" + plainWord(name) + "'";
  if (!staysBeside(name)) {
    all_read_ = false;
    return remarks.push_back(file +
                             " is not read, because it is not in the folder of the mesh: put it there, and name " +
                             "it in the line mtllib without a folder");
  }
  std::string path = name;
  std::replace(path.begin(), path.end(), '\\', '/');
  const auto text = read_(path);
  if (!text) {
    all_read_ = false;
    return remarks.push_back(file + ": " + text.error() + "; its colours are missing");
  }
  std::uint32_t material = 0;
  for (Words words(*text); words.nextLine();) {
    const std::string_view kind = words.next();
    if (kind == "newmtl") {
      const auto known = numbers_.find(trimmed(words.restOfLine()));
      material = known != numbers_.end() ? known->second : 0;
    }
    if (material == 0) continue;  // no triangle has it
    if (kind == "Kd") colour_[material] = nextColour(words);
    textures_ += kind == "map_Kd" ? 1 : 0;
  }
}

void ObjMaterials::tellColourless(std::vector<std::string>& remarks) const {
  std::size_t count = 0;
  std::string first;
  for (const auto& [name, number] : numbers_) {
    if (colour_[number] != 0) continue;
    if (count++ == 0) first = name;
  }
  if (count == 0) return;
  remarks.push_back(counted(count, "material has", "materials have") + " no colour, such as '" + plainWord(first) +
                    "': " +
                    (libraries_.empty() ? "the file names no file of materials (mtllib)"
                                        : "expected newmtl with Kd and three numbers in the file of materials"));
}

}  // namespace hapticd::importing
