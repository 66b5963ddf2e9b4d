// SPDX-License-Identifier: MIT
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "extreme_case.hpp"

namespace hapticd::extremes {
namespace {

using Json = nlohmann::json;

double numberOf(const Json& value) {
  return value.is_number() ? value.get<double>() : std::nan("");
}

Eigen::Vector3d vectorOf(const Json& value) {
  const auto coordinate = [&](std::size_t i) {
    if (value.is_null()) return std::nan("");
    if (value[i].is_string()) return std::stod(value[i].get<std::string>());
    return numberOf(value[i]);
  };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

/// True for paths on which the true nearest point jumps: two feet become equally near, and then the foot that is
/// followed is no longer the nearest.
bool isBifurcation(const std::string& name) {
  for (const char* word : {"through cylinder axis", "centre", "concave"})
    if (name.find(word) != std::string::npos) return true;
  return false;
}

}  // namespace

Case readCase(const std::filesystem::path& file) {
  std::ifstream in(file);
  const Json json = Json::parse(in);
  const Json& s = json.at("surface");
  Case c;
  c.name = json.at("name");
  c.bifurcation = isBifurcation(c.name);
  spline::SurfaceData surface;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    surface.degree[axis] = s.at("degree")[axis];
    surface.knots[axis] = s.at("knots")[axis].get<std::vector<double>>();
  }
  for (const Json& point : s.at("points")) surface.points.push_back(vectorOf(point));
  if (s.contains("weights") && !s["weights"].is_null()) surface.weights = s["weights"].get<std::vector<double>>();
  c.surfaces = {surface};
  c.rate = json.at("rate");
  c.started = true;
  c.start_u = json.at("start")[0];
  c.start_v = json.at("start")[1];
  for (const Json& point : json.at("probe")) c.probe.push_back(vectorOf(point));
  for (const Json& distance : json.at("distance")) c.distance.push_back(numberOf(distance));
  return c;
}

}  // namespace hapticd::extremes
