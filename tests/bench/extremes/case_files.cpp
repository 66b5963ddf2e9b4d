// SPDX-License-Identifier: MIT
#include "case_files.hpp"

#include <fmt/format.h>
#include <stdlib.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace hapticd::extremes {
namespace {

using Eigen::Vector3d;
using Json = nlohmann::json;
namespace fs = std::filesystem;

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

Json sceneOf(const Case& c, const std::string& device) {
  Json parameters = {{"geometry", "model.json"}, {"stiffness", 1000}, {"sides", "both"}};
  if (c.walk) parameters["contact_hysteresis"] = 0;
  if (c.direct_steps > 0) {
    parameters["method"] = "dpt";
    parameters["iterations"] = c.direct_steps;
  }
  Json scene = {{"hapticd", 1},
                {"servo", {{"rate", c.rate}, {"activation_radius", 0.3}}},
                {"models", {{{"name", "extreme"}, {"plugin", "nurbs_rigid"}, {"parameters", parameters}}}}};
  if (!device.empty()) scene["device"] = device;
  return scene;
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

}  // namespace

CaseFiles::CaseFiles(const Case& c, const std::string& device) {
  std::string path = (fs::temp_directory_path() / "extremes-XXXXXX").string();
  if (mkdtemp(path.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = path;
  std::ofstream(path_ / "model.json") << modelOf(c);
  std::ofstream(path_ / "scene.yaml") << sceneOf(c, device);
  writePath(c, path_ / "probe.csv");
}

CaseFiles::~CaseFiles() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void CaseFiles::run(const std::string& command) const {
  const std::string whole =
      fmt::format("(cd '{}' && {}) >'{}' 2>&1", path_.string(), command, (path_ / "said").string());
  if (std::system(whole.c_str()) == 0) return;
  std::ifstream in(path_ / "said");
  throw std::runtime_error(std::string(std::istreambuf_iterator<char>(in), {}));
}

Table::Table(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  for (const std::string& name : cellsOf(line)) columns_.emplace(name, columns_.size());
  while (std::getline(in, line)) {
    std::vector<double>& row = rows_.emplace_back();
    for (const std::string& cell : cellsOf(line))
      row.push_back(cell.empty() ? NAN : std::strtod(cell.c_str(), nullptr));
  }
}

Answer Table::answer(std::size_t row) const {
  Answer answer;
  answer.point = {at(row, "px"), at(row, "py"), at(row, "pz")};
  answer.normal = {at(row, "nx"), at(row, "ny"), at(row, "nz")};
  answer.traced = answer.point.allFinite();
  answer.evaluations = static_cast<int>(at(row, "iterations"));
  return answer;
}

}  // namespace hapticd::extremes
