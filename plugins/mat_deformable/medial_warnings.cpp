// SPDX-License-Identifier: MIT
#include "medial_warnings.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "kernels/dynamics/plausible_mass.hpp"
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
    if (!center.allFinite() || !std::isfinite(radius)) return;  // of a file with problems
    const Eigen::Vector3d around = Eigen::Vector3d::Constant(radius);
    box.extend(Eigen::AlignedBox3d(center - around, center + around));
  };
  if (file.mesh)
    for (const medial::Sphere& sphere : file.mesh->mesh.vertices) add(sphere.center, sphere.radius);
  if (file.grid)
    for (std::size_t i = 0; i < file.grid->grid.points.size(); ++i)
      add(file.grid->grid.points[i], i < file.grid->grid.radius.size() ? file.grid->grid.radius[i] : 0);
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

/// Returns the number in the middle of a list.
double middleOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Warns of single radii that are far larger than the others, at their own places. @return false if there are none
bool warnOfRadii(const MedialFile& file, const Json& medial, Problems& odd) {
  constexpr double kTimes = 100;  // with less, a body with a thin rim could be meant
  std::vector<double> all;
  if (file.grid) all = file.grid->grid.radius;
  if (file.mesh)
    for (const medial::Sphere& sphere : file.mesh->mesh.vertices) all.push_back(sphere.radius);
  const double usual = all.empty() ? 0 : middleOf(all);
  const auto rows = medial.find("radius");
  const bool listed =
      file.mesh || (rows != medial.end() && rows->is_array() && !rows->empty() && rows->front().is_array());
  bool found = false;
  for (std::size_t i = 0; listed && usual > 0 && i < all.size(); ++i) {
    if (!(all[i] > kTimes * usual)) continue;
    Path at = medialAt(file.mesh ? "vertices" : "radius");
    const std::size_t columns = file.mesh ? 1 : rows->front().size();
    at.push_back({"", i / columns});
    at.push_back({"", file.mesh ? 3 : i % columns});
    odd.add(at, written("%.4g m, but most radii are about %.3g m; the value must be in m: %.4g mm is %.4g m", all[i],
                        usual, all[i], all[i] / 1000));
    found = true;
  }
  return found;
}

void warnOfMass(const MedialFile& file, const Eigen::AlignedBox3d& box, Problems& odd) {
  constexpr double kHuge = 5;  // [m] a larger body is meant in mm
  const std::vector<double>& mass = file.grid ? file.grid->mass : file.mesh->mass;
  const std::size_t points = file.grid ? file.grid->grid.points.size() : file.mesh->mesh.vertices.size();
  const double unit = box.sizes().maxCoeff() > kHuge ? 1e-3 : 1;
  double all = 0;
  for (const double one : mass) all += one;
  if (mass.size() == 1) all *= static_cast<double>(points);
  if (all > dynamics::kEasyMass && all > dynamics::kDensest * box.volume() * unit * unit * unit)
    odd.add(medialAt("mass"), written("the points have %.3g kg in all, in a body %.3g m large%s; each value must be in "
                                      "kg: %.3g g is %.3g kg",
                                      all, box.diagonal().norm() * unit, unit < 1 ? " (if its lengths are in mm)" : "",
                                      largest(mass), largest(mass) / 1000));
}

/// Warns of a modulus that is too low for a solid, where the stiffness that it gives is unknown.
void warnOfModulus(const Json& medial, Problems& odd) {
  constexpr double kSoftest = 100;  // [Pa] softer than any tissue
  if (const double young = largest(medial["young"]); young < kSoftest)
    odd.add(medialAt("young"), written("%.4g Pa is softer than any tissue; the value must be in Pa (1 kPa is 1000 Pa; "
                                       "soft tissue has 2e3 to 1e5 Pa)",
                                       young));
}

void warnOfStiffness(const MedialFile& file, const Json& medial, Problems& odd) {
  constexpr double kUnfelt = 5;  // [N/m] a press of 10 mm gives 0.05 N, less than the friction of most arms
  const std::vector<double>& stiffness = file.grid ? file.grid->stiffness : file.mesh->stiffness;
  const bool young = medial.contains("young");
  if (stiffness.empty()) return young ? warnOfModulus(medial, odd) : void();
  const double most = *std::max_element(stiffness.begin(), stiffness.end());
  if (!(most < kUnfelt)) return;
  odd.add(medialAt(young ? "young" : "stiffness"),
          young ? written("%.4g Pa gives %.3g N/m, which cannot be felt: 1 mm gives %.3g N; the value must be in Pa (1 "
                          "kPa is 1000 Pa; soft tissue has 2e3 to 1e5 Pa)",
                          largest(medial["young"]), most, most * 1e-3)
                : written("%.4g N/m cannot be felt: 1 mm gives %.3g N; the value must be in N/m (1 N/mm is 1000 N/m)",
                          most, most * 1e-3));
}

}  // namespace

std::vector<std::string> warnOfMedialFile(const MedialFile& file, const Json& root, const Problems& problems,
                                          const std::string& text, const std::string& name) {
  Problems odd(name, text);
  if (!file.grid && !file.mesh) return {};
  const Json& medial = root["medial"];
  const Eigen::AlignedBox3d box = boxOf(file);
  const double size = box.isEmpty() ? 0 : box.diagonal().norm();
  const bool sized = size > 0 && !problems.about("points") && !problems.about("vertices") && !problems.about("radius");
  const auto read = [&](const char* key) { return medial.contains(key) && !problems.about(key); };
  for (const char* key : {"thickness", "shear_reach"})
    if (sized && read(key) && largest(medial[key]) > size)
      odd.add(medialAt(key),
              written("%.4g m is more than the size of the body, %.3g m; the value must be in m: %.4g mm is %.4g m",
                      largest(medial[key]), size, largest(medial[key]), largest(medial[key]) / 1000));
  if (sized && read("mass")) warnOfMass(file, box, odd);
  if (read("stiffness") || read("young")) warnOfStiffness(file, medial, odd);
  if (sized && warnOfRadii(file, medial, odd)) return odd.texts();
  // A file without problems gets this warning from the body that is made of it.
  if (problems.any() && sized && size > medial::kLargestUsual)
    odd.add({{"medial", 0}},
            written("the body is %.3g m large; lengths must be in m: %.3g mm is %.3g m", size, size, size / 1000));
  return odd.texts();
}

}  // namespace hapticd
