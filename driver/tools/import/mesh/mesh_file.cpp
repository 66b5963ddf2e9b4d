// SPDX-License-Identifier: MIT
#include "mesh_import/mesh_file.hpp"

#include "base/file_ending.hpp"

namespace hapticd::importing {

bool isMeshFile(const std::string& name) {
  const std::string ending = endingOf(name);
  return ending == ".obj" || ending == ".stl" || ending == ".ply";
}

Result<MeshFile> parseMesh(std::string_view bytes, const std::string& name, const ReadBeside& read_beside) {
  const std::string ending = endingOf(name);
  if (!isMeshFile(name)) return Error{name + ": the name is not that of a mesh, expected .obj, .stl or .ply"};
  if (bytes.empty()) return Error{name + ": is empty"};
  if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff"))
    return Error{name + ": is text in UTF-16, expected UTF-8 or ASCII: save it again with that encoding"};
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);  // the mark that some editors put before UTF-8
  if (ending == ".obj") return parseObjMesh(bytes, name, read_beside);
  if (ending == ".ply") return parsePlyMesh(bytes, name);
  return parseStlMesh(bytes, name);
}

}  // namespace hapticd::importing
