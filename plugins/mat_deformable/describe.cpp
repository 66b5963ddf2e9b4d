// SPDX-License-Identifier: MIT
/// What a person should know of a body before they touch it.
#include <algorithm>
#include <cstdio>

#include "mat_deformable.hpp"

namespace hapticd {
namespace {

constexpr double kLarge = 1.5;           ///< [m] no arm reaches round a longer body
constexpr double kNoticed = 1.1;         ///< felt over told stiffness from which a hint is due
constexpr std::size_t kMostLines = 200;  ///< nobody reads more
constexpr double kHalfMillisecond =
    0.5e-3;  ///< [s] half a tick at 1 kHz: the damping that a spring needs whose force is held
constexpr double kSameStiffness = 1e-3;  ///< relative difference of places that are told together

/// Places of one stiffness, in the order of the file.
struct Group {
  std::size_t count = 0;
  FeltMaterial first;
};

/// Stiffest first.
std::vector<Group> grouped(std::vector<FeltMaterial> all) {
  std::stable_sort(all.begin(), all.end(),
                   [](const FeltMaterial& a, const FeltMaterial& b) { return a.told > b.told; });
  std::vector<Group> groups;
  for (const FeltMaterial& one : all) {
    const auto near = [](double a, double b) { return std::abs(a - b) <= kSameStiffness * std::abs(b); };
    if (groups.empty() || !near(one.told, groups.back().first.told) || !near(one.felt, groups.back().first.felt) ||
        !near(one.deep, groups.back().first.deep))
      groups.push_back({0, one});
    ++groups.back().count;
  }
  return groups;
}

/// `contact`: contact spring over the stiffness of a surface that is felt; 0: it is not.
std::string line(const Group& group, double contact) {
  const FeltMaterial& one = group.first;
  char text[320], spring[112] = "";
  if (contact > 0)
    std::snprintf(spring, sizeof spring, "; contact spring %.4g N/m, passive on an arm that damps %.3g N s/m",
                  contact * one.told, kHalfMillisecond * contact * one.told);
  const int length = std::snprintf(text, sizeof text,
                                   "felt %.4g N/m 1 mm deep, %.4g N/m 5 mm deep; the file says %.4g N/m%s: ", one.felt,
                                   one.deep, one.told, spring);
  const auto left = sizeof text - static_cast<std::size_t>(length);
  const Eigen::Array3d mm = 0.01 * (1e5 * one.place.array()).round() + 0.0;  // no -0
  if (group.count == 1)
    std::snprintf(text + length, left, "(%.4g, %.4g, %.4g) mm", mm.x(), mm.y(), mm.z());
  else
    std::snprintf(text + length, left, "%zu places, such as (%.4g, %.4g, %.4g) mm", group.count, mm.x(), mm.y(),
                  mm.z());
  return text;
}

}  // namespace

void MatDeformable::say(int level, const std::string& text) const {
  if (host() != nullptr && host()->log != nullptr) host()->log(host(), level, text.c_str());
}

void MatDeformable::describe(const MedialFile& file) const {
  if (host() == nullptr || host()->log == nullptr) return;
  const Description description = body_->describe(geometry_);
  say(description.warning ? HSP_LOG_WARNING : HSP_LOG_INFO, description.text);
  if (!(body_->greatestRadius() > 0)) say(HSP_LOG_WARNING, geometry_ + ": all radii are 0: nothing will be felt");
  describeMaterial(file);
  const double size = body_->bounds().sizes().maxCoeff();
  if (!(size > kLarge)) return;
  char text[128];
  std::snprintf(text, sizeof text, ": the body is %.3g m long, expected metres: was the file in millimetres?", size);
  say(HSP_LOG_WARNING, geometry_ + text);
}

/// A line for each stiffness at level debug, for who asks, and a hint where it is not what the file says.
void MatDeformable::describeMaterial(const MedialFile& file) const {
  double most = 1;
  std::size_t lines = 0;
  const medial::FeltSurface* const surface = body_->feltSurface();
  const double ratio = surface != nullptr ? surface->contactRatio() : 0;
  for (const Group& group : grouped(body_->feltMaterial())) {
    if (++lines <= kMostLines) say(HSP_LOG_DEBUG, line(group, ratio));
    if (group.first.told > 0) most = std::max(most, group.first.deep / group.first.told);
  }
  if (surface != nullptr) {
    const double contact = body_->greatestStiffness() * ratio;
    char text[192];
    std::snprintf(text, sizeof text,
                  "contact spring of the stiffest place %.4g N/m: passive by itself on an arm that damps %.3g N s/m at "
                  "1 kHz (K / 2 / rate); else limits.passivity guards it",
                  contact, kHalfMillisecond * contact);
    say(HSP_LOG_DEBUG, text);
  }
  if (file.grid && file.revision >= 2 && shear_offset_ != kUsualShearOffset)
    say(HSP_LOG_WARNING, geometry_ + ": shear_offset has no meaning for hapticd-model/2; use shear_distance");
  if (!(most > kNoticed)) return;
  char text[192];
  std::snprintf(text, sizeof text,
                "shear_offset makes a press 5 mm deep up to %.2g times as stiff as the file says; with shear_distance "
                "in its place the file is right",
                most);
  say(HSP_LOG_INFO, text);
}

}  // namespace hapticd
