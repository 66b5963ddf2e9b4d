// SPDX-License-Identifier: MIT
/// The materials of an OBJ file: the colours (Kd) of its files of materials (.mtl), which stand beside it.
#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "mesh_import/mesh_file.hpp"

namespace hapticd::importing {

class ObjMaterials {
 public:
  explicit ObjMaterials(const ReadBeside& read) : read_(read) {}

  /// [main] Takes the rest of a line `mtllib`: one name, which may have blanks, or several that end in .mtl.
  void addLibrary(std::string_view names);

  /// [main] Takes the rest of a line `usemtl`. The triangles that follow have this material.
  void use(std::string_view name);

  /// [main] Called after triangles were added: they have the present material. @param triangles all so far
  void coverTo(std::size_t triangles) { material_.resize(triangles, present_); }
  std::uint32_t present() const { return present_; }
  void goBackTo(std::uint32_t material) { present_ = material; }

  /// [main] Reads the files of materials. Returns the colours of the corners of all triangles, or nothing if none has a
  /// colour, and notes in `remarks` which colours are missing.
  std::vector<std::array<std::uint32_t, 3>> colours(std::vector<std::string>& remarks);

 private:
  void readLibrary(const std::string& name, std::vector<std::string>& remarks);
  void tellColourless(std::vector<std::string>& remarks) const;

  const ReadBeside& read_;
  std::vector<std::string> libraries_;
  std::set<std::string> known_libraries_;
  std::map<std::string, std::uint32_t, std::less<>> numbers_;  ///< of materials, from 1
  std::vector<std::uint32_t> material_;                        ///< of each triangle; 0 if it has none
  std::vector<std::uint32_t> colour_;                          ///< of each material; 0 if it is not known
  std::uint32_t present_ = 0;
  std::size_t textures_ = 0;
  bool all_read_ = true;
};

}  // namespace hapticd::importing
