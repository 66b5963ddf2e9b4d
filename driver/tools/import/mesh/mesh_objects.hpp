// SPDX-License-Identifier: MIT
/// Splits a mesh into the objects that its file names.
#pragma once
#include <string>
#include <vector>

#include "mesh_import/mesh_file.hpp"

namespace hapticd::importing {

struct MeshObject {
  std::string name;  ///< empty if the file names no objects
  MeshFile mesh;     ///< only its triangles, and their points
};

/// [main] Returns the objects of a mesh, in the order of the file. Objects whose borders share edges belong together,
/// because only together they enclose something: they are one object, with the name of the first, which is noted in
/// `remarks`.
std::vector<MeshObject> objectsOf(const MeshFile& mesh, std::vector<std::string>& remarks);

}  // namespace hapticd::importing
