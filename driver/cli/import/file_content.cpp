// SPDX-License-Identifier: MIT
#include "cli/import/file_content.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <system_error>

#include "base/file_beginning.hpp"
#include "base/file_ending.hpp"

namespace hapticd::cli {
namespace {

struct Kind {
  std::string_view begins, name;
  std::string_view endings;  ///< such as ".step .stp ", the usual one first; "" if hapticd reads no such file
  std::string_view fix;      ///< what the user can do with a file that hapticd does not read
};

constexpr Kind kKinds[] = {
    {"ISO-10303-21;", "a STEP file", ".step .stp ", ""},
    {"solid ", "a mesh (STL)", ".stl ", ""},
    {"ply\n", "a mesh (PLY)", ".ply ", ""},
    {"ply\r", "a mesh (PLY)", ".ply ", ""},
    {"DBRep_DrawableShape", "a BREP file of Open CASCADE", ".brep .brp .rle ", ""},
    {"CASCADE Topology", "a BREP file of Open CASCADE", ".brep .brp .rle ", ""},
    {"hapticd-part/", "a part, as import writes it", ".hpart ", ""},
    {"version https://git-lfs", "a pointer of Git LFS in place of the file", "", "fetch the file: git lfs pull"},
    {"<!DOCTYPE", "a web page", "", "download the file itself"},
    {"<html", "a web page", "", "download the file itself"},
    {"PK\x03\x04", "a ZIP archive", "", "unpack it first"},
    {"\x1f\x8b", "compressed (gzip)", "", "unpack it first"},
    {"glTF", "a mesh (glTF)", "", "export the mesh as .obj, .stl or .ply"},
};

std::string withoutMark(const std::string& bytes) {
  return bytes.starts_with("\xef\xbb\xbf") ? bytes.substr(3) : bytes;
}

/// Returns true for the first line of an IGES file: 80 columns, the last of which are S and the number 1.
bool isIges(std::string_view bytes) {
  constexpr std::size_t kSection = 72, kColumns = 80;
  if (bytes.size() < kColumns || bytes.substr(0, kColumns).find('\n') != std::string_view::npos) return false;
  const std::string_view number = bytes.substr(kSection + 1, kColumns - kSection - 1);
  return bytes[kSection] == 'S' && number.back() == '1' &&
         number.substr(0, number.size() - 1).find_first_not_of(" 0") == std::string_view::npos;
}

/// Returns true for the text of an OBJ file: its first line that is no comment and names nothing is a point.
bool isObj(const std::string& bytes) {
  std::istringstream in(bytes);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind;
    double x = 0, y = 0, z = 0;
    if (!(words >> kind) || kind[0] == '#' || kind == "mtllib" || kind == "o" || kind == "g") continue;
    return kind == "v" && static_cast<bool>(words >> x >> y >> z);
  }
  return false;
}

/// Returns true for a binary STL: its size is that of the number of triangles behind its first 80 bytes.
bool isBinaryStl(const std::string& bytes, const std::string& file) {
  constexpr std::size_t kHeader = 80, kTriangle = 50;
  std::uint32_t triangles = 0;
  if (bytes.size() < kHeader + sizeof triangles) return false;
  for (std::size_t i = 0; i < sizeof triangles; ++i)
    triangles |= std::uint32_t{static_cast<unsigned char>(bytes[kHeader + i])} << (8 * i);
  std::error_code error;
  return triangles > 0 &&
         std::filesystem::file_size(file, error) == kHeader + sizeof triangles + kTriangle * std::uintmax_t{triangles};
}

}  // namespace

std::string misnamed(const std::string& file) {
  constexpr Kind kIges{"", "an IGES file", ".iges .igs ", ""};
  const auto read = readBeginning(file, 512);
  if (!read) return "";
  if (read->empty()) return file + ": is empty\n  fix: export or download it anew";
  const std::string bytes = withoutMark(*read), ending = endingOf(file);
  const std::string words = bytes.substr(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
  const auto* found = std::find_if(std::begin(kKinds), std::end(kKinds),
                                   [&](const Kind& kind) { return words.starts_with(kind.begins); });
  if (found == std::end(kKinds) && isIges(bytes)) found = &kIges;
  constexpr Kind kStl{"", "a mesh (binary STL)", ".stl ", ""};
  if (found == std::end(kKinds) && isBinaryStl(bytes, file)) found = &kStl;
  constexpr Kind kObj{"", "a mesh (OBJ)", ".obj ", ""};
  if (found == std::end(kKinds) && isObj(bytes)) found = &kObj;
  if (found == std::end(kKinds)) return "";
  if (!ending.empty() && found->endings.find(ending + " ") != std::string_view::npos) return "";
  std::string text = file + ": is " + std::string(found->name) + ", by its first bytes";
  if (found->endings.empty()) return text + "\n  fix: " + std::string(found->fix);
  const std::string usual(found->endings.substr(0, found->endings.find(' ')));
  return text + (ending.empty() ? ", and its name has no ending" : ", and its name ends in '" + ending + "'") +
         "\n  fix: rename it to " + std::filesystem::path(file).replace_extension(usual).string();
}

}  // namespace hapticd::cli
