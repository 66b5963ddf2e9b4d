// SPDX-License-Identifier: MIT
#include "import/triangles.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>

#include "document/reader.hpp"

namespace hapticd::importing {
namespace {

using Eigen::Vector3d;
constexpr std::size_t kMostTriangles = 20'000'000;
constexpr std::size_t kStlHead = 84, kStlTriangle = 50;  ///< [bytes]

/// Gives equal points the same index.
class Weld {
 public:
  explicit Weld(std::vector<Vector3d>& points) : points_(points) {}
  uint32_t at(const Vector3d& p) {
    const auto [known, added] = known_.try_emplace({p.x(), p.y(), p.z()}, static_cast<uint32_t>(points_.size()));
    if (added) points_.push_back(p);
    return known->second;
  }

 private:
  std::vector<Vector3d>& points_;
  std::map<std::array<double, 3>, uint32_t> known_;
};

void add(Triangles& mesh, uint32_t a, uint32_t b, uint32_t c) {
  if (a != b && b != c && c != a) mesh.corners.push_back({a, b, c});
}

Result<Triangles> parseBinaryStl(const std::string& bytes, std::size_t count) {
  Triangles mesh;
  Weld weld(mesh.points);
  for (std::size_t t = 0; t < count; ++t) {
    std::array<float, 9> xyz{};
    std::memcpy(xyz.data(), bytes.data() + kStlHead + kStlTriangle * t + 12, sizeof xyz);
    std::array<uint32_t, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) corner[k] = weld.at(Vector3d(xyz[3 * k], xyz[3 * k + 1], xyz[3 * k + 2]));
    add(mesh, corner[0], corner[1], corner[2]);
  }
  return mesh;
}

bool readPoint(std::istringstream& words, Vector3d& p) {
  std::string word;
  for (int k = 0; k < 3; ++k) {
    if (!(words >> word)) return false;
    const auto value = document::toNumber(word);
    if (!value || !std::isfinite(*value)) return false;
    p[k] = *value;
  }
  return true;
}

}  // namespace

Result<Triangles> parseObj(const std::string& text, const std::string& file) {
  Triangles mesh;
  std::istringstream lines(text);
  std::string line, kind;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string where = file + ":" + std::to_string(number) + ": ";
    std::istringstream words(line);
    if (!(words >> kind)) continue;
    if (kind == "v") {
      Vector3d p;
      if (!readPoint(words, p)) return Error{where + "expected v x y z, finite numbers"};
      mesh.points.push_back(p);
    } else if (kind == "f") {
      std::vector<uint32_t> corners;
      for (std::string word; words >> word;) {
        const auto index = document::toNumber(word.substr(0, word.find('/')));
        const double last = static_cast<double>(mesh.points.size());
        const double place = index && *index < 0 ? last + *index + 1 : index.value_or(0);
        if (!(place >= 1) || !(place <= last) || place != std::floor(place))
          return Error{where + "point '" + word + "', expected 1 to " + std::to_string(mesh.points.size())};
        corners.push_back(static_cast<uint32_t>(place) - 1);
      }
      if (corners.size() < 3) return Error{where + "expected f and at least three points"};
      for (std::size_t k = 2; k < corners.size(); ++k) add(mesh, corners[0], corners[k - 1], corners[k]);
      if (mesh.corners.size() > kMostTriangles) return Error{where + "more than 20,000,000 triangles"};
    }
  }
  if (mesh.corners.empty()) return Error{file + ": has no triangles, expected lines f i j k, a triangle each"};
  return mesh;
}

Result<Triangles> parseStl(const std::string& bytes, const std::string& file) {
  if (bytes.size() >= kStlHead) {
    uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof count);
    if (bytes.size() == kStlHead + kStlTriangle * std::size_t{count} && count > 0) {
      auto mesh = parseBinaryStl(bytes, count);
      for (const Vector3d& p : mesh->points)
        if (!p.allFinite()) return Error{file + ": a coordinate is not a finite number"};
      return mesh;
    }
  }
  Triangles mesh;
  Weld weld(mesh.points);
  std::istringstream lines(bytes);
  std::string line, kind;
  std::vector<uint32_t> corners;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    if (!(words >> kind) || kind != "vertex") continue;
    Vector3d p;
    if (!readPoint(words, p))
      return Error{file + ":" + std::to_string(number) + ": expected vertex x y z, finite numbers"};
    corners.push_back(weld.at(p));
    if (corners.size() < 3) continue;
    add(mesh, corners[0], corners[1], corners[2]);
    corners.clear();
  }
  if (mesh.corners.empty())
    return Error{file + ": has no triangles, expected a text STL (solid, facet, vertex x y z) or a whole binary one"};
  return mesh;
}

Result<void> orientClosed(Triangles& mesh, const std::string& file) {
  std::map<std::array<uint32_t, 2>, int> directed;
  for (const auto& c : mesh.corners)
    for (std::size_t k = 0; k < 3; ++k) ++directed[{c[k], c[(k + 1) % 3]}];
  std::size_t open = 0;
  for (const auto& [edge, count] : directed) {
    const auto back = directed.find({edge[1], edge[0]});
    open += count != 1 || back == directed.end() || back->second != 1 ? 1 : 0;
  }
  if (open > 0)
    return Error{file + ": " + std::to_string(open) +
                 " edges do not have one triangle on each side with the same orientation, expected a closed surface"};
  double volume = 0;
  for (const auto& c : mesh.corners) volume += mesh.points[c[0]].dot(mesh.points[c[1]].cross(mesh.points[c[2]])) / 6;
  if (!(std::fabs(volume) > 0))
    return Error{file + ": the surface encloses no volume, expected a closed surface that is not flat"};
  if (volume < 0)
    for (auto& c : mesh.corners) std::swap(c[1], c[2]);
  return {};
}

}  // namespace hapticd::importing
