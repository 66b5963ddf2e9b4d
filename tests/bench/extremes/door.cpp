// SPDX-License-Identifier: MIT
/// A case as a user would trace it: a scene, a model file and a probe path for `hapticd trace`.
#include <fmt/format.h>
#include <stdlib.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "extreme_case.hpp"

namespace hapticd::extremes {
namespace {

using Eigen::Vector3d;
using Json = nlohmann::json;
namespace fs = std::filesystem;

/// A folder that goes with the object.
class Folder {
 public:
  Folder() {
    std::string path = (fs::temp_directory_path() / "extremes-XXXXXX").string();
    if (mkdtemp(path.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = path;
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  fs::path operator/(const char* name) const { return path_ / name; }

 private:
  fs::path path_;
};

Json modelOf(const Case& c) {
  Json surfaces = Json::array();
  for (const spline::SurfaceData& data : c.surfaces) {
    Json surface = {{"name", "surface" + std::to_string(surfaces.size())},
                    {"degree", data.degree},
                    {"knots", data.knots},
                    {"points", Json::array()}};
    for (const Vector3d& point : data.points) surface["points"].push_back({point.x(), point.y(), point.z()});
    if (!data.weights.empty()) surface["weights"] = data.weights;
    if (data.reversed) surface["outward"] = "reversed";
    surfaces.push_back(std::move(surface));
  }
  return {{"format", "hapticd-model/1"}, {"surfaces", std::move(surfaces)}};
}

Json sceneOf(const Case& c) {
  Json parameters = {{"geometry", "model.json"}, {"stiffness", 1000}, {"sides", "both"}};
  if (c.walk) parameters["contact_hysteresis"] = 0;
  if (c.direct_steps > 0) {
    parameters["method"] = "dpt";
    parameters["iterations"] = c.direct_steps;
  }
  return {{"hapticd", 1},
          {"servo", {{"rate", c.rate}, {"activation_radius", 0.3}}},
          {"models", {{{"name", "extreme"}, {"plugin", "nurbs_rigid"}, {"parameters", parameters}}}}};
}

void writePath(const Case& c, const fs::path& file) {
  std::ofstream out(file);
  out << "t,x,y,z\n";
  for (std::size_t i = 0; i < c.probe.size(); ++i)
    out << fmt::format("{:.17g},{:.17g},{:.17g},{:.17g}\n", static_cast<double>(i) / c.rate, c.probe[i].x(),
                       c.probe[i].y(), c.probe[i].z());
}

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

std::vector<Answer> readTrace(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  std::map<std::string, std::size_t> column;
  for (const std::string& name : cellsOf(line)) column.emplace(name, column.size());
  std::vector<Answer> answers;
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = cellsOf(line);
    const auto number = [&](const char* name) { return std::strtod(cells.at(column.at(name)).c_str(), nullptr); };
    Answer& answer = answers.emplace_back();
    answer.point = {number("px"), number("py"), number("pz")};
    answer.normal = {number("nx"), number("ny"), number("nz")};
    answer.traced = answer.point.allFinite();
    answer.evaluations = static_cast<int>(number("iterations"));
  }
  return answers;
}

}  // namespace

std::vector<Answer> traceThroughDoor(const Case& c, const fs::path& hapticd) {
  const Folder folder;
  std::ofstream(folder / "model.json") << modelOf(c);
  std::ofstream(folder / "scene.yaml") << sceneOf(c);
  writePath(c, folder / "probe.csv");
  const std::string command =
      fmt::format("'{}' trace '{}' --probe '{}' --out '{}' 2>'{}'", hapticd.string(), (folder / "scene.yaml").string(),
                  (folder / "probe.csv").string(), (folder / "out.csv").string(), (folder / "said").string());
  if (std::system(command.c_str()) != 0) {
    std::ifstream in(folder / "said");
    throw std::runtime_error(std::string(std::istreambuf_iterator<char>(in), {}));
  }
  return readTrace(folder / "out.csv");
}

Case moved(const Case& c, std::mt19937& random) {
  std::normal_distribution<double> any(0, 1);
  const double w = any(random), x = any(random), y = any(random), z = any(random);
  const Eigen::Quaterniond R = Eigen::Quaterniond(w, x, y, z).normalized();
  const Vector3d shift(0.5 * any(random), 0.5 * any(random), 0.5 * any(random));
  Case other = c;
  for (spline::SurfaceData& surface : other.surfaces)
    for (Vector3d& point : surface.points) point = R * point + shift;
  for (Vector3d& probe : other.probe) probe = R * probe + shift;
  return other;
}

}  // namespace hapticd::extremes
