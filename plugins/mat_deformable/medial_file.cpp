#include "medial_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "traced_shape/document.hpp"
#include "traced_shape/model_file.hpp"

namespace hapticd {
namespace {

using Json = nlohmann::json;
constexpr std::size_t kMostPoints = 1'000'000;

Path below(Path path, const char* key) {
  path.push_back({key, 0});
  return path;
}
Path below(Path path, std::size_t index) {
  path.push_back({"", index});
  return path;
}

/// Reads the tree of one file; every wrong value becomes a problem and reading goes on.
class Reader {
 public:
  explicit Reader(Problems& problems) : problems_(problems) {}

  medial::BodyData read(const Json& root) {
    medial::BodyData data;
    if (!root.is_object()) {
      problems_.add({}, "expected a mapping with format and medial");
      return data;
    }
    checkKeys(root, {}, {"format", "name", "credit", "surfaces", "edges", "medial"});
    if (const auto format = root.find("format"); format == root.end() || *format != "hapticd-model/1")
      problems_.add({PathStep{"format", 0}}, "expected hapticd-model/1");
    const Path at = below(Path{}, "medial");
    const auto medial = root.find("medial");
    if (medial == root.end() || !medial->is_object()) {
      problems_.add(at, "expected a mapping with points, radius and stiffness");
      return data;
    }
    checkKeys(*medial, at, {"points", "radius", "stiffness", "damping", "mass"});
    if (!readPoints(*medial, below(at, "points"), data.grid)) return data;
    data.grid.radius = grid(*medial, at, "radius", data.grid, true);
    data.stiffness = grid(*medial, at, "stiffness", data.grid, true);
    data.damping = grid(*medial, at, "damping", data.grid, false);
    data.mass = grid(*medial, at, "mass", data.grid, false);
    return data;
  }

 private:
  bool readPoints(const Json& medial, const Path& at, medial::SkeletonGrid& grid) {
    const auto rows = medial.find("points");
    const bool good = rows != medial.end() && rows->is_array() && !rows->empty() && (*rows)[0].is_array() &&
                      !(*rows)[0].empty() && rows->size() * (*rows)[0].size() <= kMostPoints;
    if (!good) {
      problems_.add(at, "expected rows of [x, y, z] in m: [[[0, 0, 0], [0.1, 0, 0]], ...]");
      return false;
    }
    grid.count = {static_cast<int>(rows->size()), static_cast<int>((*rows)[0].size())};
    for (std::size_t i = 0; i < rows->size() && !problems_.full(); ++i) {
      if (!isRow((*rows)[i], below(at, i), grid)) continue;
      for (std::size_t j = 0; j < (*rows)[i].size() && !problems_.full(); ++j)
        grid.points.push_back(point((*rows)[i][j], below(below(at, i), j)));
    }
    return !problems_.any();
  }

  Eigen::Vector3d point(const Json& json, const Path& at) {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    if (!json.is_array() || json.size() != 3) {
      problems_.add(at, "expected [x, y, z] in m");
      return p;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = json[axis].is_number() ? json[axis].get<double>() : NAN;
      if (!std::isfinite(value)) problems_.add(below(at, axis), "expected a finite number");
      p[static_cast<Eigen::Index>(axis)] = value;
    }
    return p;
  }

  bool isRow(const Json& json, const Path& at, const medial::SkeletonGrid& grid) {
    const auto columns = static_cast<std::size_t>(grid.count[1]);
    if (json.is_array() && json.size() == columns) return true;
    problems_.add(at, "expected a row of " + std::to_string(columns) + ", like the first row of points");
    return false;
  }

  std::vector<double> grid(const Json& medial, const Path& parent, const char* key, const medial::SkeletonGrid& grid,
                           bool required) {
    const Path at = below(parent, key);
    const auto json = medial.find(key);
    const std::size_t total = grid.points.size(), rows = static_cast<std::size_t>(grid.count[0]);
    if (json == medial.end() || json->is_null()) {
      if (required) problems_.add(at, "missing, expected a number for each point, in rows like points");
      return {};
    }
    if (json->is_number()) return std::vector<double>(total, value(*json, at));
    std::vector<double> all;
    if (!json->is_array() || json->size() != rows) {
      problems_.add(at, "expected " + std::to_string(rows) + " rows, like points");
      return all;
    }
    for (std::size_t i = 0; i < rows && !problems_.full(); ++i) {
      if (!isRow((*json)[i], below(at, i), grid)) continue;
      for (std::size_t j = 0; j < (*json)[i].size() && !problems_.full(); ++j)
        all.push_back(value((*json)[i][j], below(below(at, i), j)));
    }
    return all;
  }

  double value(const Json& json, const Path& at) {
    const double number = json.is_number() ? json.get<double>() : NAN;
    if (!(number >= 0) || !std::isfinite(number)) problems_.add(at, "expected a finite number of at least 0");
    return number;
  }

  void checkKeys(const Json& json, const Path& at, std::initializer_list<const char*> known) {
    for (const auto& [key, item] : json.items()) {
      if (std::find(known.begin(), known.end(), key) != known.end()) continue;
      std::string expected;
      for (const char* name : known) expected += (expected.empty() ? "" : ", ") + std::string(name);
      problems_.add(below(at, key.c_str()), "unknown key, expected one of " + expected);
    }
  }

  Problems& problems_;
};

}  // namespace

medial::BodyData readMedialFile(const std::string& path) {
  const std::string text = readModelText(path);
  const Json root = parseDocument(text, path);
  Problems problems(path, text);
  medial::BodyData data = Reader(problems).read(root);
  problems.throwIfAny();
  return data;
}

}  // namespace hapticd
