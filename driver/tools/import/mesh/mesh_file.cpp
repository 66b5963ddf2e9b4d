// SPDX-License-Identifier: MIT
#include "mesh_import/mesh_file.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>

#include "mesh_import/mesh_words.hpp"

namespace hapticd::importing {
namespace {

using Eigen::Vector3d;
constexpr std::size_t kStlHead = 84, kStlTriangle = 50;  ///< [bytes]

std::string endingOf(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  std::string ending = dot == std::string::npos ? "" : name.substr(dot + 1);
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

Error tooMany(const std::string& where) {
  return Error{where + "more than 20,000,000 triangles"};
}

/// Reads an OBJ index, which counts from 1, or backward from the last point if it is negative.
std::optional<std::uint32_t> objIndex(std::string_view word, std::size_t points) {
  word = word.substr(0, word.find('/'));
  std::int64_t index = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
  if (error != std::errc() || end != word.data() + word.size()) return {};
  if (index < 0) index += static_cast<std::int64_t>(points) + 1;
  if (index < 1 || index > static_cast<std::int64_t>(points)) return {};
  return static_cast<std::uint32_t>(index - 1);
}

Result<MeshFile> parseBinaryStl(std::string_view bytes, std::size_t count, const std::string& name) {
  if (count > kMostTriangles) return tooMany(name + ": ");
  MeshFile mesh;
  Weld weld(mesh.points);
  mesh.corners.reserve(count);
  for (std::size_t t = 0; t < count; ++t) {
    std::array<float, 9> xyz{};
    std::memcpy(xyz.data(), bytes.data() + kStlHead + kStlTriangle * t + 12, sizeof xyz);
    std::array<std::uint32_t, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d p(xyz[3 * k], xyz[3 * k + 1], xyz[3 * k + 2]);
      if (!p.allFinite()) return Error{name + ": triangle " + std::to_string(t) + ": a coordinate is not finite"};
      corner[k] = weld.at(p);
    }
    mesh.corners.push_back(corner);
  }
  return mesh;
}

Result<MeshFile> parseTextStl(std::string_view bytes, const std::string& name) {
  MeshFile mesh;
  Weld weld(mesh.points);
  Words words(bytes);
  std::array<std::uint32_t, 3> corner{};
  std::size_t count = 0;
  while (words.nextLine()) {
    const std::string_view kind = words.next();
    if (kind == "facet" || kind == "endfacet") count = 0;
    if (kind != "vertex") continue;
    const auto p = nextPoint(words);
    if (!p) return Error{name + ":" + std::to_string(words.lineNumber()) + ": expected vertex x y z, finite numbers"};
    corner[count] = weld.at(*p);
    if (++count < 3) continue;
    count = 0;
    mesh.corners.push_back(corner);
    if (mesh.corners.size() > kMostTriangles) return tooMany(name + ": ");
  }
  if (mesh.corners.empty())
    return Error{name + ": has no triangles, expected a text STL (solid, facet, vertex x y z) or a whole binary one"};
  return mesh;
}

}  // namespace

bool isMeshFile(const std::string& name) {
  const std::string ending = endingOf(name);
  return ending == "obj" || ending == "stl" || ending == "ply";
}

Result<MeshFile> parseMesh(std::string_view bytes, const std::string& name) {
  const std::string ending = endingOf(name);
  if (ending == "obj") return parseObjMesh(bytes, name);
  if (ending == "ply") return parsePlyMesh(bytes, name);
  if (ending == "stl") return parseStlMesh(bytes, name);
  return Error{name + ": the name is not that of a mesh, expected .obj, .stl or .ply"};
}

Result<MeshFile> parseObjMesh(std::string_view bytes, const std::string& name) {
  MeshFile mesh;
  Weld weld(mesh.points);
  std::vector<std::uint32_t> points;  // index of each point of the file after equal points were joined
  std::vector<std::uint32_t> polygon;
  Words words(bytes);
  while (words.nextLine()) {
    const std::string_view kind = words.next();
    if (kind != "v" && kind != "f") continue;
    const auto where = [&] { return name + ":" + std::to_string(words.lineNumber()) + ": "; };
    if (kind == "v") {
      const auto p = nextPoint(words);
      if (!p) return Error{where() + "expected v x y z, finite numbers"};
      points.push_back(weld.at(*p));
      continue;
    }
    polygon.clear();
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      const auto index = objIndex(word, points.size());
      if (!index)
        return Error{where() + "point '" + std::string(word) + "', expected 1 to " + std::to_string(points.size())};
      polygon.push_back(points[*index]);
    }
    if (polygon.size() < 3) return Error{where() + "expected f and at least three points"};
    for (std::size_t k = 2; k < polygon.size(); ++k) mesh.corners.push_back({polygon[0], polygon[k - 1], polygon[k]});
    if (mesh.corners.size() > kMostTriangles) return tooMany(where());
  }
  if (mesh.corners.empty()) return Error{name + ": has no triangles, expected lines f i j k"};
  return mesh;
}

Result<MeshFile> parseStlMesh(std::string_view bytes, const std::string& name) {
  if (bytes.size() >= kStlHead) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof count);
    if (bytes.size() == kStlHead + kStlTriangle * std::size_t{count} && count > 0)
      return parseBinaryStl(bytes, count, name);
    if (bytes.substr(0, 5) != "solid")
      return Error{name + ": a binary STL of " + std::to_string(count) + " triangles has " +
                   std::to_string(kStlHead + kStlTriangle * std::size_t{count}) + " bytes, and this file has " +
                   std::to_string(bytes.size()) + ": it is damaged, or no STL"};
  }
  return parseTextStl(bytes, name);
}

}  // namespace hapticd::importing
