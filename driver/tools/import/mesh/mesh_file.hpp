// SPDX-License-Identifier: MIT
/// Triangle meshes from OBJ, STL and PLY files.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"

namespace hapticd::importing {

inline constexpr std::size_t kMostTriangles = 20'000'000;

/// The triangles of a file, in the unit of the file. Points that are equal bit for bit are stored once.
struct MeshFile {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<std::uint32_t, 3>> corners;  ///< polygons are cut into triangles
  std::vector<std::string> objects;   ///< names of the objects of the file that have triangles; empty if it names none
  std::vector<std::uint32_t> object;  ///< object of each triangle; empty if the file names none
  /// The colours of the corners of each triangle, as in brep::CornerColours; empty if the file has none.
  std::vector<std::array<std::uint32_t, 3>> colours;
  std::vector<std::string> remarks;  ///< what is odd about the file and did not stop the reader
};

/// Reads a file that a mesh names, in the folder of the mesh or below it. The error follows the name in a message.
using ReadBeside = std::function<Result<std::string>(const std::string& name)>;

/// [main] Reads a mesh. Messages begin with `name`, whose ending gives the format (.obj, .stl, .ply in any case).
/// Errors give the line if there are lines. A mark of UTF-8
/// at the start is passed over.
/// @param read_beside reads files of materials; without it, the materials of an OBJ file have no colours
Result<MeshFile> parseMesh(std::string_view bytes, const std::string& name, const ReadBeside& read_beside = {});

/// [main] Each of these reads a mesh of one format.
Result<MeshFile> parseObjMesh(std::string_view bytes, const std::string& name, const ReadBeside& read_beside = {});
Result<MeshFile> parseStlMesh(std::string_view bytes, const std::string& name);
Result<MeshFile> parsePlyMesh(std::string_view bytes, const std::string& name);

/// [any] Returns whether a file name has the ending of a mesh.
bool isMeshFile(const std::string& name);

}  // namespace hapticd::importing
