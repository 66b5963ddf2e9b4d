// SPDX-License-Identifier: MIT
#include "medial_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "document/suggestion.hpp"
#include "kernels/medial/layer.hpp"
#include "ma_file.hpp"
#include "medial_warnings.hpp"
#include "traced_shape/document.hpp"
#include "traced_shape/model_file.hpp"

namespace hapticd {
namespace {

using Json = nlohmann::json;
constexpr std::size_t kMostPoints = 1'000'000;
constexpr double kMost = 1e6;        ///< [N/m], [kg] greatest stiffness and mass, as for the parameters
constexpr double kLeastMass = 1e-9;  ///< [kg] a smaller mass is surely a typing error; with 0 the body creeps
constexpr double kHardest = 1e9;     ///< [Pa] a harder body is not soft
constexpr double kThinnest = 10;     ///< greatest ratio of tip radius to thickness for which layerStiffness() is right
constexpr double kClaimMargin = 10;  ///< the host lets a shape damp this many times as much as its parameters say
constexpr double kLeastDamping = 5;  ///< [N s/m] the host accepts up to this for every body

Path below(Path path, const char* key) {
  path.push_back({key, 0});
  return path;
}
Path below(Path path, std::size_t index) {
  path.push_back({"", index});
  return path;
}

/// Reads the tree of one file. Every wrong value becomes a problem, and reading continues.
class Reader {
 public:
  Reader(Problems& problems, const Material& material)
      : problems_(problems),
        tip_(material.tip),
        most_damping_(std::max(kLeastDamping, kClaimMargin * material.damping)) {}

  void read(const Json& root, MedialFile& file) {
    if (!root.is_object()) return problems_.add({}, "expected a mapping with the keys format and medial");
    checkKeys(root, {}, {"format", "name", "credit", "surfaces", "edges", "medial"});
    const auto format = root.find("format");
    file.revision = format != root.end() && *format == "hapticd-model/2" ? 2 : 1;
    if (format == root.end() || (file.revision == 1 && *format != "hapticd-model/1"))
      problems_.add({PathStep{"format", 0}}, "expected hapticd-model/2 (or hapticd-model/1, for older files)");
    const Path at = below(Path{}, "medial");
    const auto medial = root.find("medial");
    if (medial == root.end() || !medial->is_object())
      return problems_.add(at, "expected a mapping with points, radius and stiffness, or vertices and stiffness");
    file.layered = medial->contains("young");
    if (medial->contains("vertices")) {
      readMesh(*medial, at, file.mesh.emplace());
    } else {
      readGrid(*medial, at, file.grid.emplace());
    }
  }

 private:
  void readGrid(const Json& medial, const Path& at, medial::BodyData& data) {
    checkKeys(medial, at,
              {"points", "radius", "stiffness", "damping", "mass", "young", "poisson", "thickness", "shear_reach"});
    if (!readPoints(medial, below(at, "points"), data.grid)) return;
    data.grid.radius = grid(medial, at, "radius", data.grid, true);
    const auto read = [&](const char* key, bool required) { return grid(medial, at, key, data.grid, required); };
    data.stiffness = stiffnessOf(medial, at, read);
    data.damping = grid(medial, at, "damping", data.grid, false);
    data.mass = grid(medial, at, "mass", data.grid, false);
    if (medial.contains("shear_reach"))
      data.shear_reach = value(medial["shear_reach"], below(at, "shear_reach"), "radius");
  }

  void readMesh(const Json& medial, const Path& at, medial::MeshBodyData& data) {
    checkKeys(medial, at,
              {"vertices", "edges", "triangles", "stiffness", "damping", "mass", "young", "poisson", "thickness"});
    const Json& vertices = medial["vertices"];
    const Path place = below(at, "vertices");
    if (!vertices.is_array() || vertices.empty() || vertices.size() > kMostPoints)
      return problems_.add(place, "expected a list with [x, y, z, radius] in m for each vertex");
    for (std::size_t i = 0; i < vertices.size() && !problems_.full(); ++i) {
      if (!vertices[i].is_array() || vertices[i].size() != 4) {
        problems_.add(below(place, i), "expected [x, y, z, radius] in m");
        continue;
      }
      medial::Sphere sphere;
      for (std::size_t k = 0; k < 3; ++k)
        sphere.center[static_cast<Eigen::Index>(k)] = finite(vertices[i][k], below(below(place, i), k));
      sphere.radius = value(vertices[i][3], below(below(place, i), 3), "radius");
      data.mesh.vertices.push_back(sphere);
    }
    readCorners(medial, below(at, "edges"), "edges", vertices.size(), data.mesh.edges);
    readCorners(medial, below(at, "triangles"), "triangles", vertices.size(), data.mesh.triangles);
    const auto read = [&](const char* key, bool required) { return list(medial, at, key, vertices.size(), required); };
    data.stiffness = stiffnessOf(medial, at, read);
    data.damping = list(medial, at, "damping", vertices.size(), false);
    data.mass = list(medial, at, "mass", vertices.size(), false);
  }

  /// Returns the stiffness of the file, or computes it from the elastic constants of a layer. `read` returns the values
  /// of a key.
  template <class Read>
  std::vector<double> stiffnessOf(const Json& medial, const Path& at, Read read) {
    if (!medial.contains("young")) {
      for (const char* key : {"poisson", "thickness"})
        if (medial.contains(key)) problems_.add(below(at, key), "is used only together with young");
      return read("stiffness", true);
    }
    if (medial.contains("stiffness"))
      problems_.add(below(at, "stiffness"), "expected either stiffness, or young, poisson and thickness");
    const std::vector<double> young = read("young", true), poisson = read("poisson", true);
    const std::vector<double> thickness = read("thickness", true);
    if (problems_.any()) return {};
    const auto pick = [](const std::vector<double>& values, std::size_t i) {
      return values[values.size() > 1 ? i : 0];
    };
    std::map<std::array<double, 2>, double> known;  // stiffness for a modulus of 1 Pa, by poisson and thickness
    std::vector<double> all;
    for (std::size_t i = 0; i < std::max({young.size(), poisson.size(), thickness.size()}); ++i) {
      const std::array<double, 2> layer{pick(poisson, i), pick(thickness, i)};
      const auto [found, fresh] = known.try_emplace(layer, 0);
      if (fresh) found->second = medial::layerStiffness({1, layer[0], layer[1]}, tip_);
      all.push_back(found->second * pick(young, i));
    }
    if (const double most = *std::max_element(all.begin(), all.end()); most > kMost)
      problems_.add(below(at, "young"),
                    "gives a stiffness of " + std::to_string(most) + " N/m, which is more than 1e6");
    return all;
  }

  /// Returns a vertex as the file gives it: 4, and not 4.0 as the tree has it.
  static std::string shown(const Json& corner) {
    if (!corner.is_number()) return corner.dump();
    char text[32];
    std::snprintf(text, sizeof text, "%.15g", corner.get<double>());
    return text;
  }

  template <std::size_t kCount>
  void readCorners(const Json& medial, const Path& at, const char* key, std::size_t vertices,
                   std::vector<std::array<int, kCount>>& out) {
    const auto rows = medial.find(key);
    if (rows == medial.end() || rows->is_null()) return;
    const std::string expected =
        "expected " + std::to_string(kCount) + " different vertices from 0 to " + std::to_string(vertices - 1);
    if (!rows->is_array()) return problems_.add(at, "expected a list; " + expected);
    for (std::size_t i = 0; i < rows->size() && !problems_.full(); ++i) {
      const Json& row = (*rows)[i];
      std::array<int, kCount> corners{};
      std::string wrong;
      bool good = row.is_array() && row.size() == kCount;
      for (std::size_t k = 0; good && k < kCount; ++k) {
        const double corner = row[k].is_number() ? row[k].get<double>() : -1;
        good = corner >= 0 && corner < static_cast<double>(vertices) && corner == std::floor(corner);
        if (!good) wrong = "vertex " + shown(row[k]) + " does not exist (vertices are counted from 0); ";
        if (good) corners[k] = static_cast<int>(corner);
        for (std::size_t before = 0; good && before < k; ++before) {
          good = corners[before] != corners[k];
          if (!good) wrong = "vertex " + shown(row[k]) + " stands there twice; ";
        }
      }
      if (!good) problems_.add(below(at, i), wrong + expected);
      out.push_back(corners);
    }
  }

  std::vector<double> list(const Json& medial, const Path& parent, const char* key, std::size_t total, bool required) {
    const Path at = below(parent, key);
    const auto json = medial.find(key);
    if (json == medial.end() || json->is_null()) {
      if (required && !isMisspelt(medial, key))
        problems_.add(at, "this key is missing; give a number, or one for each vertex");
      return {};
    }
    if (json->is_number()) return {value(*json, at, key)};
    std::vector<double> all;
    if (!json->is_array() || json->size() != total) {
      problems_.add(at, "expected a number, or " + std::to_string(total) + " numbers, one for each vertex");
      return all;
    }
    for (std::size_t i = 0; i < total && !problems_.full(); ++i) all.push_back(value((*json)[i], below(at, i), key));
    return all;
  }

  double finite(const Json& json, const Path& at) {
    const double number = json.is_number() ? json.get<double>() : NAN;
    if (!(std::abs(number) <= kFarthestPoint)) problems_.add(at, "expected a number between -1e6 and 1e6 m");
    return number;
  }

  /// Returns false if even the number of points is unknown. Otherwise reading continues after a wrong point, so that
  /// the other problems are found too.
  bool readPoints(const Json& medial, const Path& at, medial::SkeletonGrid& grid) {
    const auto rows = medial.find("points");
    const bool good = rows != medial.end() && rows->is_array() && !rows->empty() && (*rows)[0].is_array() &&
                      !(*rows)[0].empty() && rows->size() * (*rows)[0].size() <= kMostPoints;
    if (!good) {
      problems_.add(at, "expected rows of [x, y, z] in m: [[[0, 0, 0], [0.1, 0, 0]], ...]");
      return false;
    }
    if (std::all_of(rows->begin(), rows->end(), isPoint)) {  // read on as if it were one row
      problems_.add(at,
                    "a list of points, expected rows of points, "
                    "with one more bracket: [[[0, 0, 0], [0.1, 0, 0]], ...]");
      grid.count = {1, static_cast<int>(rows->size())};
      for (std::size_t j = 0; j < rows->size(); ++j) grid.points.push_back(point((*rows)[j], below(at, j)));
      return true;
    }
    grid.count = {static_cast<int>(rows->size()), static_cast<int>((*rows)[0].size())};
    for (std::size_t i = 0; i < rows->size() && !problems_.full(); ++i) {
      if (!isRow((*rows)[i], below(at, i), grid)) continue;
      for (std::size_t j = 0; j < (*rows)[i].size() && !problems_.full(); ++j)
        grid.points.push_back(point((*rows)[i][j], below(below(at, i), j)));
    }
    return true;
  }

  static bool isPoint(const Json& json) {
    return json.is_array() && json.size() == 3 &&
           std::all_of(json.begin(), json.end(), [](const Json& axis) { return axis.is_number(); });
  }

  Eigen::Vector3d point(const Json& json, const Path& at) {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    if (!json.is_array() || json.size() != 3) {
      problems_.add(at, "expected [x, y, z] in m");
      return p;
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[static_cast<Eigen::Index>(axis)] = finite(json[axis], below(at, axis));
    return p;
  }

  bool isRow(const Json& json, const Path& at, const medial::SkeletonGrid& grid) {
    const auto columns = static_cast<std::size_t>(grid.count[1]);
    if (json.is_array() && json.size() == columns) return true;
    problems_.add(at, "expected a row of " + std::to_string(columns) + " values, as in the first row of points");
    return false;
  }

  /// Returns true if the file has a key that resembles this one. It was reported as unknown.
  static bool isMisspelt(const Json& medial, const std::string& key) {
    for (const auto& [name, value] : medial.items())
      if (name != key && !document::suggestion(name, {key}).empty()) return true;
    return false;
  }

  std::vector<double> grid(const Json& medial, const Path& parent, const char* key, const medial::SkeletonGrid& grid,
                           bool required) {
    const Path at = below(parent, key);
    const auto json = medial.find(key);
    const std::size_t total = grid.points.size(), rows = static_cast<std::size_t>(grid.count[0]);
    if (json == medial.end() || json->is_null()) {
      if (required && !isMisspelt(medial, key))
        problems_.add(at,
                      "this key is missing; give a number, or rows like those of points with a number for each point");
      return {};
    }
    if (json->is_number()) return std::vector<double>(total, value(*json, at, key));
    std::vector<double> all;
    if (!json->is_array() || json->size() != rows) {
      problems_.add(at, "expected a number, or " + std::to_string(rows) + " rows, as many as points has");
      return all;
    }
    for (std::size_t i = 0; i < rows && !problems_.full(); ++i) {
      if (!isRow((*json)[i], below(at, i), grid)) continue;
      for (std::size_t j = 0; j < (*json)[i].size() && !problems_.full(); ++j)
        all.push_back(value((*json)[i][j], below(below(at, i), j), key));
    }
    return all;
  }

  double value(const Json& json, const Path& at, std::string_view key) {
    const double number = json.is_number() ? json.get<double>() : NAN;
    if (!(number >= 0) || !std::isfinite(number)) {
      problems_.add(at, "expected a finite number of at least 0");
    } else if (key == "radius" && number > kFarthestPoint) {
      problems_.add(at, "expected at most 1e6 m");
    } else if (key == "young" && number > kHardest) {
      problems_.add(at, "expected at most 1e9 Pa");
    } else if (key == "poisson" && number > 0.5) {
      problems_.add(at, "expected 0 to 0.5");
    } else if (key == "thickness" && !(number >= tip_ / kThinnest && number <= kFarthestPoint)) {
      char text[128];
      std::snprintf(text, sizeof text, "expected at least %g m, a tenth of probe_radius", tip_ / kThinnest);
      problems_.add(at, text);
    } else if (key == "stiffness" && number > kMost) {
      problems_.add(at, "expected at most 1e6 N/m");
    } else if (key == "mass" && (number > kMost || (number > 0 && number < kLeastMass))) {
      problems_.add(at, "expected 0, or 1e-9 to 1e6 kg");
    } else if (key == "damping" && number > most_damping_) {
      char text[192];
      std::snprintf(
          text, sizeof text,
          "expected at most %g N s/m (ten times the parameter `damping` of the scene, at least 5), or the host may "
          "switch the body off; lower this value, or set `damping` to %g",
          most_damping_, std::min(number, kMost));
      problems_.add(at, number > kMost ? "expected at most 1e6 N s/m" : text);
    }
    return number;
  }

  void checkKeys(const Json& json, const Path& at, std::initializer_list<const char*> known) {
    for (const auto& [key, item] : json.items()) {
      if (std::find(known.begin(), known.end(), key) != known.end()) continue;
      const std::vector<std::string> names(known.begin(), known.end());
      problems_.add(below(at, key.c_str()), "unknown key, expected one of " + document::listed(names, names.size()) +
                                                document::suggestion(key, names));
    }
  }

  Problems& problems_;
  double tip_;           ///< [m] radius of the flat tip, see Material
  double most_damping_;  ///< [N s/m] greatest damping that a file may give
};

}  // namespace

MedialFile readMedialFile(const std::string& path, const Material& material) {
  return parseMedialFile(readModelText(path), path, material);
}

MedialFile parseMedialFile(const std::string& text, const std::string& name, const Material& material) {
  MedialFile file;
  if (name.ends_with(".ma")) {
    file.mesh = medial::MeshBodyData{parseMa(text, name), {material.stiffness}, {material.damping}, {material.mass}};
  } else {
    Problems problems(name, text);
    const Json root = parseDocument(text, name, problems);
    Reader(problems, material).read(root, file);
    if (problems.any()) problems.throwIfAny(warnOfMedialFile(file, root, problems, text, name));
    file.odd = warnOfMedialFile(file, root, problems, text, name);
  }
  const auto some = [](const std::vector<double>& values) {
    return std::any_of(values.begin(), values.end(), [](double x) { return x > 0; });
  };
  if (file.grid) file.swings = some(file.grid->mass), file.damps = some(file.grid->damping);
  if (file.mesh) file.swings = some(file.mesh->mass), file.damps = some(file.mesh->damping);
  return file;
}

MedialFile stiffened(double factor, MedialFile file) {
  std::vector<double>& all = file.grid ? file.grid->stiffness : file.mesh->stiffness;
  for (double& one : all) one *= factor;
  const double most = all.empty() ? 0 : *std::max_element(all.begin(), all.end());
  if (most <= kMost) return file;
  char text[128];
  std::snprintf(text, sizeof text,
                "stiffness_scale: a stiffness would be %.4g N/m, expected at most 1e6 N/m: give a smaller factor",
                most);
  throw std::invalid_argument(text);
}

MedialFile grownBy(double radius, MedialFile file) {
  if (file.grid) file.grid->grid.ball = radius;
  if (file.mesh)
    for (medial::Sphere& sphere : file.mesh->mesh.vertices) sphere.radius += radius;
  return file;
}

}  // namespace hapticd
