// SPDX-License-Identifier: MIT
#include "medial_advice.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>

#include "traced_shape/document.hpp"

namespace hapticd {
namespace {

using Json = nlohmann::json;

template <class... T>
std::string written(const char* format, T... values) {
  char text[320];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

Path medialAt(const char* key) {
  return {{"medial", 0}, {key, 0}};
}

Eigen::AlignedBox3d boxOf(const MedialFile& file) {
  Eigen::AlignedBox3d box;
  const auto add = [&box](const Eigen::Vector3d& center, double radius) {
    const Eigen::Vector3d around = Eigen::Vector3d::Constant(radius);
    box.extend(Eigen::AlignedBox3d(center - around, center + around));
  };
  if (file.mesh)
    for (const medial::Sphere& sphere : file.mesh->mesh.vertices) add(sphere.center, sphere.radius);
  if (file.grid)
    for (std::size_t i = 0; i < file.grid->grid.points.size(); ++i)
      add(file.grid->grid.points[i], file.grid->grid.radius[i]);
  return box;
}

/// Returns the largest number in a value or in nested lists.
double largest(const Json& value) {
  if (value.is_number()) return value.get<double>();
  double most = 0;
  if (value.is_array())
    for (const Json& item : value) most = std::max(most, largest(item));
  return most;
}

void adviseMass(const MedialFile& file, const Eigen::AlignedBox3d& box, Problems& odd) {
  // [kg/m^3] denser than any metal; [kg] less than this is never reported
  constexpr double kDensest = 25'000, kEasy = 3;
  const std::vector<double>& mass = file.grid ? file.grid->mass : file.mesh->mass;
  const std::size_t points = file.grid ? file.grid->grid.points.size() : file.mesh->mesh.vertices.size();
  double all = 0;
  for (const double one : mass) all += one;
  if (mass.size() == 1) all *= static_cast<double>(points);
  const double volume = box.volume();
  if (all > kEasy && all > kDensest * volume)
    odd.add(
        medialAt("mass"),
        written("the points have %.3g kg in all, in a body %.3g m large; each value must be in kg: %.3g g is %.3g kg",
                all, box.diagonal().norm(), largest(mass), largest(mass) / 1000));
}

void adviseStiffness(const MedialFile& file, const Json& medial, Problems& odd) {
  constexpr double kUnfelt = 5;  // [N/m] a press of 10 mm gives 0.05 N, less than the friction of most arms
  const std::vector<double>& stiffness = file.grid ? file.grid->stiffness : file.mesh->stiffness;
  const double most = stiffness.empty() ? 0 : *std::max_element(stiffness.begin(), stiffness.end());
  if (!(most < kUnfelt)) return;
  const bool young = medial.contains("young");
  odd.add(medialAt(young ? "young" : "stiffness"),
          young ? written("%.4g Pa gives %.3g N/m, which cannot be felt: 1 mm gives %.3g N; the value must be in Pa (1 "
                          "kPa is 1000 Pa; soft tissue has 2e3 to 1e5 Pa)",
                          largest(medial["young"]), most, most * 1e-3)
                : written("%.4g N/m cannot be felt: 1 mm gives %.3g N; the value must be in N/m (1 N/mm is 1000 N/m)",
                          most, most * 1e-3));
}

}  // namespace

std::vector<std::string> adviseMedial(const MedialFile& file, const Json& medial, const std::string& text,
                                      const std::string& name) {
  Problems odd(name, text);
  const Eigen::AlignedBox3d box = boxOf(file);
  const double size = box.diagonal().norm();
  for (const char* key : {"thickness", "shear_reach"})
    if (medial.contains(key) && largest(medial[key]) > size)
      odd.add(medialAt(key),
              written("%.4g m is more than the size of the body, %.3g m; the value must be in m: %.4g mm is %.4g m",
                      largest(medial[key]), size, largest(medial[key]), largest(medial[key]) / 1000));
  adviseMass(file, box, odd);
  adviseStiffness(file, medial, odd);
  return odd.texts();
}

}  // namespace hapticd
