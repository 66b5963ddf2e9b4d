// SPDX-License-Identifier: MIT
#include "model_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "document.hpp"
#include "document/suggestion.hpp"
#include "model_warnings.hpp"

namespace hapticd {
namespace {

using Json = nlohmann::json;
constexpr std::size_t kMostSurfaces = 1'000'000;

Path operator/(Path path, const char* key) {
  path.push_back({key, 0});
  return path;
}
Path operator/(Path path, std::size_t index) {
  path.push_back({"", index});
  return path;
}

/// Reads the tree of one file. Every wrong value becomes a problem, and reading continues.
class Reader {
 public:
  explicit Reader(Problems& problems) : problems_(problems) {}

  /// Reports of each surface whether its degrees, knots and points are right. Its weights are empty if they are wrong.
  const std::vector<bool>& sound() const { return sound_; }

  ModelFile read(const Json& root) {
    ModelFile file;
    if (!root.is_object()) {
      problems_.add({},
                    "this is not a model file: expected a mapping with the keys format and surfaces. Convert triangles "
                    "and CAD files to a part: hapticd import FILE -o PART.hpart. Convert Bezier patches (.bpt) to a "
                    "model file: hapticd import FILE -o MODEL.yaml");
      return file;
    }
    checkKeys(root, {}, {"format", "name", "credit", "surfaces", "edges", "medial"});
    if (const auto format = root.find("format"); format == root.end() || *format != "hapticd-model/1")
      problems_.add({PathStep{"format", 0}}, "expected hapticd-model/1");
    const Path at = Path{} / "surfaces";
    const auto surfaces = root.find("surfaces");
    if (surfaces == root.end() || !surfaces->is_array() || surfaces->empty() || surfaces->size() > kMostSurfaces) {
      problems_.add(at, surfaces == root.end() && root.contains("medial")
                            ? "missing: this file is a soft body (it has medial); use plugin: mat_deformable for it"
                            : "expected a list of one to " + std::to_string(kMostSurfaces) + " surfaces");
      return file;
    }
    file.surfaces.reserve(surfaces->size());
    for (std::size_t i = 0; i < surfaces->size() && !problems_.full(); ++i)
      file.surfaces.push_back(surface((*surfaces)[i], at / i));
    if (const auto edges = root.find("edges"); edges != root.end()) readEdges(*edges, Path{} / "edges", file);
    return file;
  }

 private:
  spline::SurfaceData surface(const Json& json, const Path& at) {
    spline::SurfaceData data;
    sound_.push_back(false);
    if (!json.is_object()) {
      problems_.add(at, "expected a mapping with the keys degree, knots and points");
      return data;
    }
    checkKeys(json, at, {"name", "degree", "knots", "points", "weights", "outward"});
    if (const Json* name = member(json, "name")) data.name = nameOf(*name, at / "name");
    spline::SoundParts parts;
    parts.degree = isRead([&] { readDegree(json, at / "degree", data); });
    readKnots(json, at / "knots", data, parts);
    parts.points = isRead([&] { readPoints(json, at / "points", data); });
    const Json* weights = member(json, "weights");
    if (weights != nullptr && !weights->is_null())
      parts.weights = isRead([&] { data.weights = numbers(*weights, at / "weights"); });
    if (const Json* outward = member(json, "outward")) {
      if (*outward != "reversed" && *outward != "forward")
        problems_.add(at / "outward", "expected reversed or forward");
      data.reversed = *outward == "reversed";
    }
    bool net = parts.degree && parts.points && parts.knots[0] && parts.knots[1], weighted = parts.weights;
    spline::checkParts(data, parts, [&](const std::string& where, const std::string& why) {
      const Path place = placeIn(data, at, where + ": ");
      const bool of_weights = place.size() > at.size() && place[at.size()].key == "weights";
      problems_.add(place, where + ": " + why + (of_weights ? "" : otherKnots(data)));
      (of_weights ? weighted : net) = false;
    });
    if (!weighted) data.weights.clear();  // wrong weights hide nothing else
    sound_.back() = net && !problems_.full();
    return data;
  }

  /// Returns true if a part of the file was read without a problem.
  template <class Read>
  bool isRead(const Read& read) {
    const std::size_t before = problems_.count();
    read();
    return problems_.count() == before;
  }

  std::string nameOf(const Json& json, const Path& at) {
    if (json.is_string()) return json.get<std::string>();
    if (json.is_number() || json.is_boolean()) return json.dump();
    if (json.is_null()) return {};
    problems_.add(at, "expected a text");
    return {};
  }

  /// Returns the value of a surface that a message such as "surface 'lid': knots[u][2]: ..." is about.
  static Path placeIn(const spline::SurfaceData& data, const Path& at, const std::string& what) {
    const std::string before = "surface '" + (data.name.empty() ? std::string("unnamed") : data.name) + "': ";
    if (!what.starts_with(before)) return at;
    const std::string where = what.substr(before.size(), what.find(": ", before.size()) - before.size());
    const std::string key = where.substr(0, where.find('['));
    Path path = at;
    for (const char* known : {"knots", "points", "weights"})
      if (key == known) path = path / known;
    if (path.size() == at.size()) return at;
    for (std::size_t open = where.find('['); open != std::string::npos; open = where.find('[', open + 1)) {
      const std::string index = where.substr(open + 1, where.find(']', open) - open - 1);
      path = path / (index == "u" ? 0u : index == "v" ? 1u : std::strtoul(index.c_str(), nullptr, 10));
    }
    return path;
  }

  /// Returns what was probably meant by knots that do not fit the points.
  static std::string otherKnots(const spline::SurfaceData& data) {
    const auto fits = [&data](int more, int p, int q) {
      const int u = static_cast<int>(data.knots[0].size()) + more - p - 1;
      const int v = static_cast<int>(data.knots[1].size()) + more - q - 1;
      return u > p && v > q && static_cast<std::size_t>(u) * static_cast<std::size_t>(v) == data.points.size();
    };
    const int p = data.degree[0], q = data.degree[1];
    if (fits(0, p, q)) return "";
    if (fits(2, p, q)) return "; if the program leaves out the first and the last knot, as Rhino does, give both again";
    if (p != q && fits(0, q, p))
      return "; the knots fit degree: [" + std::to_string(q) + ", " + std::to_string(p) + "], along u and v";
    return "";
  }

  void readDegree(const Json& json, const Path& at, spline::SurfaceData& data) {
    const Json* degree = member(json, "degree");
    if (degree == nullptr || !degree->is_array() || degree->size() != 2)
      return problems_.add(at, "expected two whole numbers: the degrees along u and v");
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const Json& value = (*degree)[axis];
      const double number = value.is_number() ? value.get<double>() : 0;
      if (!(number >= 1 && number <= spline::kMaxDegree) || number != std::floor(number))
        return problems_.add(at / axis, "expected a whole number from 1 to " + std::to_string(spline::kMaxDegree));
      data.degree[axis] = static_cast<int>(number);
    }
  }

  void readKnots(const Json& json, const Path& at, spline::SurfaceData& data, spline::SoundParts& parts) {
    const Json* knots = member(json, "knots");
    parts.knots = {false, false};
    if (knots == nullptr || !knots->is_array() || knots->size() != 2)
      return problems_.add(at, "expected two lists of numbers: the knots along u and v");
    for (std::size_t axis = 0; axis < 2; ++axis)
      parts.knots[axis] = isRead([&] { data.knots[axis] = numbers((*knots)[axis], at / axis); });
  }

  void readPoints(const Json& json, const Path& at, spline::SurfaceData& data) {
    const Json* points = member(json, "points");
    if (points == nullptr || !points->is_array()) return problems_.add(at, "expected a list of [x, y, z] in m");
    data.points.reserve(points->size());
    for (std::size_t i = 0; i < points->size() && !problems_.full(); ++i) {
      const Json& point = (*points)[i];
      if (!point.is_array() || point.size() != 3) {
        problems_.add(at / i, "expected [x, y, z] in m");
        continue;
      }
      Eigen::Vector3d p;
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[static_cast<Eigen::Index>(axis)] = number(point[axis], at / i / axis);
      data.points.push_back(p);
    }
  }

  void readEdges(const Json& json, const Path& at, ModelFile& file) {
    if (json.is_null()) return;
    if (!json.is_array()) return problems_.add(at, "expected a list of {sides: [[surface, side], [surface, side]]}");
    for (std::size_t i = 0; i < json.size() && !problems_.full(); ++i) {
      const Json* sides = json[i].is_object() ? member(json[i], "sides") : nullptr;
      if (sides == nullptr || !sides->is_array() || sides->size() != 2) {
        problems_.add(at / i, "expected sides: [[surface, side], [surface, side]]");
        continue;
      }
      checkKeys(json[i], at / i, {"sides", "flipped"});
      const auto a = edgeEnd((*sides)[0], at / i / "sides" / std::size_t{0}, file);
      const auto b = edgeEnd((*sides)[1], at / i / "sides" / std::size_t{1}, file);
      const Json* flipped = member(json[i], "flipped");
      if (flipped != nullptr && !flipped->is_boolean()) problems_.add(at / i / "flipped", "expected true or false");
      if (a && b && a->surface == b->surface && a->side == b->side)
        problems_.add(at / i / "sides", "joins a side with itself, expected two different sides");
      if (a && b) file.edges.push_back({*a, *b, flipped != nullptr && flipped->is_boolean() && flipped->get<bool>()});
    }
  }

  std::optional<trace::EdgeEnd> edgeEnd(const Json& json, const Path& at, const ModelFile& file) {
    static constexpr std::array<const char*, trace::kSides> kSideNames = {"u0", "u1", "v0", "v1"};
    if (json.is_array() && json.size() == 2 && json[1].is_string()) {
      int surface = -1;
      for (std::size_t i = 0; i < file.surfaces.size(); ++i)
        if ((json[0].is_string() && json[0] == file.surfaces[i].name) ||
            (json[0].is_number() && json[0].get<double>() == static_cast<double>(i)))
          surface = static_cast<int>(i);
      for (int side = 0; side < trace::kSides; ++side)
        if (surface >= 0 && json[1] == kSideNames[static_cast<std::size_t>(side)]) return trace::EdgeEnd{surface, side};
    }
    std::vector<std::string> names;
    for (const spline::SurfaceData& surface : file.surfaces)
      if (!surface.name.empty()) names.push_back(surface.name);
    const bool is_name = json.is_array() && json.size() == 2 && json[0].is_string();
    if (is_name && std::find(names.begin(), names.end(), json[0].get<std::string>()) == names.end())
      problems_.add(at / std::size_t{0}, "there is no surface \"" + json[0].get<std::string>() +
                                             "\", expected a name or index of a surface" +
                                             document::suggestion(json[0].get<std::string>(), names));
    else if (is_name && json[1].is_string())
      problems_.add(at / std::size_t{1},
                    "there is no side \"" + json[1].get<std::string>() + "\", expected u0, u1, v0 or v1");
    else
      problems_.add(at, "expected [surface, side]: a name or index of a surface, and u0, u1, v0 or v1");
    return std::nullopt;
  }

  /// Returns the value of a key, or of a misspelt one, which was reported as unknown; nullptr if there is none.
  static const Json* member(const Json& json, const char* key) {
    static const std::set<std::string> kKeys{"name",    "degree",  "knots", "points",
                                             "weights", "outward", "sides", "flipped"};
    if (const auto found = json.find(key); found != json.end()) return &*found;
    for (const auto& [name, value] : json.items())
      if (!kKeys.contains(name) && !document::suggestion(name, {key}).empty()) return &value;
    return nullptr;
  }

  double number(const Json& json, const Path& at) {
    const double value = json.is_number() ? json.get<double>() : NAN;
    if (!std::isfinite(value)) problems_.add(at, "expected a finite number");
    return value;
  }

  std::vector<double> numbers(const Json& json, const Path& at) {
    std::vector<double> all;
    if (!json.is_array()) {
      problems_.add(at, "expected a list of numbers");
      return all;
    }
    if (std::any_of(json.begin(), json.end(), [](const Json& item) { return item.is_array(); })) {
      problems_.add(at, "a list of rows, expected one flat list of numbers");
      return all;
    }
    all.reserve(json.size());
    for (std::size_t i = 0; i < json.size() && !problems_.full(); ++i) {
      const Json& value = json[i];
      if (value.is_number() && std::isfinite(value.get<double>())) {
        all.push_back(value.get<double>());
      } else {
        all.push_back(number(value, at / i));
      }
    }
    return all;
  }

  void checkKeys(const Json& json, const Path& at, std::initializer_list<const char*> known) {
    for (const auto& [key, value] : json.items()) {
      if (std::find(known.begin(), known.end(), key) != known.end()) continue;
      const std::vector<std::string> names(known.begin(), known.end());
      problems_.add(at / key.c_str(), "unknown key, expected one of " + document::listed(names, names.size()) +
                                          document::suggestion(key, names));
    }
  }

  Problems& problems_;
  std::vector<bool> sound_;
};

}  // namespace

ModelFile readModelFile(const std::string& path) {
  return parseModelFile(readModelText(path), path);
}

/// Returns what is doubtful in a file with problems. If all surfaces were read, this includes how they lie beside each
/// other; with wrong edges, it is unknown which sides shall join although they miss each other.
static std::vector<std::string> oddOf(const ModelFile& file, const std::vector<bool>& sound, const Problems& problems,
                                      const std::string& text, const std::string& name) {
  std::vector<std::string> odd = warnOfSurfaces(file, sound, text, name);
  const bool all = std::find(sound.begin(), sound.end(), false) == sound.end();
  if (sound.empty() || !all || problems.about("weights")) return odd;
  try {
    const trace::Model model(file.surfaces, {.edges = file.edges});
    if (!problems.about("edges")) odd = warnOfModel(file, model, text, name);
    const std::vector<std::string> turned = warnOfJoints(file, model, text, name);
    odd.insert(odd.end(), turned.begin(), turned.end());
  } catch (const std::exception&) {
    return odd;  // what cannot be joined is reported once the other problems are corrected
  }
  return odd;
}

ModelFile parseModelFile(const std::string& text, const std::string& name) {
  Problems problems(name, text);
  const Json root = parseDocument(text, name, problems);
  Reader reader(problems);
  ModelFile file = reader.read(root);
  if (problems.any()) problems.throwIfAny(oddOf(file, reader.sound(), problems, text, name));
  return file;
}

}  // namespace hapticd
