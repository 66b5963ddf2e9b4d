// SPDX-License-Identifier: MIT
/// Writes to the log what a person should know about a body before touching it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string_view>
#include <tuple>
#include <utility>

#include "kernels/medial/passive.hpp"
#include "mat_deformable.hpp"
#include "traced_shape/model_file.hpp"

namespace hapticd {
namespace {

/// ratio of the felt stiffness to the file's stiffness above which a hint is given
constexpr double kNoticed = 1.1;
constexpr std::size_t kMostLines = 200;  ///< most lines in the log; nobody reads more
/// multiple of K T / 2, the damping of the arm that the contact spring alone needs; only a swinging mass needs more
/// than this
constexpr double kSwings = 2;
/// most attempts to find a sufficient damping; the first one is kLittle times the critical damping, and each of the
/// others is kMore times the one before
constexpr int kGuesses = 30;
constexpr double kLittle = 1e-3, kMore = 1.3;
constexpr double kSameStiffness = 1e-3;  ///< places with a smaller relative difference are reported together

/// Places with the same material.
struct Group {
  std::size_t count = 0;
  FeltMaterial first;
  medial::Tissue tissue;
};

struct Place {
  FeltMaterial felt;
  medial::Tissue tissue;
};

bool alike(const Place& a, const Group& b) {
  const auto near = [](double x, double y) { return std::abs(x - y) <= kSameStiffness * std::abs(y); };
  return near(a.felt.told, b.first.told) && near(a.felt.felt, b.first.felt) && near(a.felt.deep, b.first.deep) &&
         near(a.tissue.damping, b.tissue.damping) && near(a.tissue.mass, b.tissue.mass);
}

/// Returns what distinguishes materials, the stiffness first.
auto materialOf(const Place& one) {
  return std::tuple{one.felt.told, one.felt.felt, one.felt.deep, one.tissue.damping, one.tissue.mass};
}

/// Groups places with the same material, the stiffest first.
std::vector<Group> grouped(std::vector<Place> all) {
  std::sort(all.begin(), all.end(), [](const Place& a, const Place& b) { return materialOf(a) > materialOf(b); });
  std::vector<Group> groups;
  for (const Place& one : all) {
    if (groups.empty() || !alike(one, groups.back())) groups.push_back({0, one.felt, one.tissue});
    ++groups.back().count;
  }
  return groups;
}

/// Returns the damping [N s/m] that an arm needs so that its contact with a surface whose force is held for a tick is
/// passive.
double neededDamping(const medial::Tissue& tissue, double ratio, double tick) {
  return medial::passiveDamping(medial::dampedForTick(medial::elementOf(tissue, ratio), tick), tick);
}

/// The damping that an arm needs because of the mass behind the surface.
struct Swing {
  medial::Tissue tissue;
  /// [N s/m] needed damping; the same as a multiple of what the contact spring alone needs
  double need = 0, times = 0;
};
Swing swingOf(const medial::Tissue& tissue, double ratio, double tick) {
  const double need = neededDamping(tissue, ratio, tick);
  return {tissue, need, need / (0.5 * tick * medial::elementOf(tissue, ratio).contact)};
}

/// Returns the damping of the tissue [N s/m] with which an arm needs at most kSwings times the damping that the contact
/// spring alone needs.
double enoughDamping(medial::Tissue tissue, double ratio, double tick) {
  tissue.damping = std::max(tissue.damping, kLittle * std::sqrt(tissue.stiffness * tissue.mass));
  for (int i = 0; i < kGuesses && swingOf(tissue, ratio, tick).times > kSwings; ++i) tissue.damping *= kMore;
  const double unit = std::pow(10, std::floor(std::log10(tissue.damping)) - 1);  // rounded up to two digits
  return unit * std::ceil(tissue.damping / unit);
}

std::string springText(const medial::Tissue& tissue, double ratio, double tick) {
  const double contact = medial::elementOf(tissue, ratio).contact, need = neededDamping(tissue, ratio, tick);
  char text[128];
  if (std::isfinite(need))
    std::snprintf(text, sizeof text, "; contact spring %.4g N/m, passive on an arm that damps %.3g N s/m", contact,
                  need);
  else
    std::snprintf(text, sizeof text,
                  "; contact spring %.4g N/m, not passive on any arm, because the mass has no damping", contact);
  return text;
}

/// Returns a line of the log about a group of places.
/// @param who source of the stiffness, such as "the file"
/// @param spring text about the contact spring of a felt surface; "" if the surface is not felt
std::string line(const Group& group, const char* who, const std::string& spring) {
  const FeltMaterial& one = group.first;
  char text[320];
  const int length =
      std::snprintf(text, sizeof text, "felt %.4g N/m 1 mm deep, %.4g N/m 5 mm deep; %s says %.4g N/m%s: ", one.felt,
                    one.deep, who, one.told, spring.c_str());
  const auto left = sizeof text - static_cast<std::size_t>(length);
  const Eigen::Array3d mm = 0.01 * (1e5 * one.place.array()).round() + 0.0;  // + 0.0 avoids -0
  if (group.count == 1)
    std::snprintf(text + length, left, "(%.4g, %.4g, %.4g) mm", mm.x(), mm.y(), mm.z());
  else
    std::snprintf(text + length, left, "%zu places, such as (%.4g, %.4g, %.4g) mm", group.count, mm.x(), mm.y(),
                  mm.z());
  return text;
}

/// Returns a warning: a ball touches, but the stiffness is that of a flat tip of another radius.
std::string otherTip(double flat, double ball) {
  char text[256];
  std::snprintf(
      text, sizeof text,
      "tip_radius: the ball that touches has %.4g mm, but young, poisson and thickness were converted for a flat tip "
      "of radius %.4g mm: if both are the same tip, write also probe_radius: %.4g",
      1e3 * ball, 1e3 * flat, ball);
  return text;
}

/// Returns the default of a parameter.
double usual(std::string_view id) {
  for (const auto& field : MatDeformable::fields())
    if (id == field.param.id) return field.param.def;
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

MedialFile MatDeformable::readFile() const {
  try {
    return stiffened(stiffness_scale_, readMedialFile(geometry_, {stiffness_, damping_, mass_, probe_radius_}));
  } catch (const ModelFileError& error) {
    for (const std::string& odd : error.odd) writeLog(HSP_LOG_WARNING, "geometry: " + odd);
    throw;
  }
}

void MatDeformable::describe(const MedialFile& file, double tick) const {
  const Description description = body_->describe(geometry_);
  writeLog(description.warning ? HSP_LOG_WARNING : HSP_LOG_INFO, description.text);
  if (!(drawn().greatestRadius() > 0) && tip_radius_ == 0)
    writeLog(HSP_LOG_WARNING, geometry_ + ": all radii are 0, so nothing will be felt; give radii above 0, in m");
  describeMaterial(file, tick);
  for (const std::string& odd : file.odd) writeLog(HSP_LOG_WARNING, "geometry: " + odd);
  describeDynamics(file);
  // Materials in the scene are only for files without materials. Otherwise they have no effect, which nobody would
  // notice.
  for (const auto& [id, given] : {std::pair("stiffness", stiffness_), std::pair("mass", mass_)})
    if (!geometry_.ends_with(".ma") && given != usual(id))
      writeLog(
          HSP_LOG_WARNING,
          std::string(id) + ": has no effect: " + geometry_ +
              " gives the materials of its points; this parameter is only for a medial mesh without materials (.ma)");
  if (file.grid && rings_ != static_cast<int>(usual("rings")))
    writeLog(HSP_LOG_WARNING, "rings: has no effect: only a medial mesh has rings; for a grid, set influence");
  if (friction_static_ > 0 && friction_static_ < friction_dynamic_)
    writeLog(
        HSP_LOG_WARNING,
        "friction_static: has no effect, because friction_dynamic is greater; friction_dynamic must not be greater");
  const double size = body_->bounds().sizes().maxCoeff();
  if (!(size > medial::kLargestUsual)) return;
  char text[128];
  std::snprintf(text, sizeof text, ": the body is %.3g m long; lengths must be in m: is the file in millimetres?",
                size);
  writeLog(HSP_LOG_WARNING, geometry_ + text);
}

/// Writes which dynamics is in use, and warns if a mass was given that nobody feels.
void MatDeformable::describeDynamics(const MedialFile& file) const {
  const Dynamics dynamics = dynamicsOf(file);
  const bool by_file = dynamics_ == kAsFile, without = geometry_.ends_with(".ma");
  std::string text = "dynamics: ";
  text += dynamics == kFelt   ? "felt: the force includes mass, damping and relaxation of the body"
          : dynamics == kSeen ? "seen: the body swings when it is drawn, but the hand feels a body at rest"
                              : "off: the body follows the probe at once, and the force is that of a body at rest";
  if (by_file)
    text += std::string(without ? " (the default for .ma files" : " (the default for files of this format") +
            (dynamics == kSeen ? "; with dynamics: felt the hand feels it)" : ")");
  writeLog(HSP_LOG_DEBUG, text);
  if (dynamics != kFelt && relaxation_share_ > 0)
    writeLog(HSP_LOG_WARNING, std::string("relaxation.share: has no effect: dynamics is ") +
                                  (dynamics == kSeen ? "seen" : "off") +
                                  "; to feel the relaxation, set dynamics to felt");
  if (without && by_file && dynamics == kSeen && mass_ != usual("mass"))
    writeLog(
        HSP_LOG_WARNING,
        "mass: has no effect on the force, because dynamics is `seen` by default for .ma files; to feel the mass, set "
        "dynamics to felt");
}

medial::Tissue MatDeformable::tissueAt(const MedialFile& file, std::size_t point) const {
  const auto at = [point](const std::vector<double>& all) {
    return all.empty() ? 0 : all[all.size() == 1 ? 0 : point];
  };
  const auto of = [&](const auto& body) {
    return medial::Tissue{at(body.stiffness), at(body.damping), at(body.mass), relaxation_share_, relaxation_time_};
  };
  return file.grid ? of(*file.grid) : of(*file.mesh);
}

/// Returns what gives the stiffness of the body, such as "the file".
std::string MatDeformable::sourceOf(const MedialFile& file) const {
  char text[96];
  std::snprintf(text, sizeof text, "young for a flat tip of radius %.4g mm", 1e3 * probe_radius_);
  const std::string source = geometry_.ends_with(".ma") ? "the scene" : file.layered ? text : "the file";
  if (stiffness_scale_ == 1) return source;
  std::snprintf(text, sizeof text, ", times %.4g,", stiffness_scale_);
  return source + text;
}

/// Writes a line for each material at level debug, and a hint if a hand feels another stiffness than the file says.
void MatDeformable::describeMaterial(const MedialFile& file, double tick) const {
  double most = 1;
  const bool felt = body_->feltSurface() != nullptr;
  std::vector<Place> places;
  for (const FeltMaterial& one : body_->feltMaterial()) places.push_back({one, tissueAt(file, places.size())});
  std::size_t lines = 0;
  for (const Group& group : grouped(std::move(places))) {
    if (++lines <= kMostLines)
      writeLog(HSP_LOG_DEBUG,
               line(group, sourceOf(file).c_str(), felt ? springText(group.tissue, contact_ratio_, tick) : ""));
    if (group.first.told > 0) most = std::max(most, group.first.deep / group.first.told);
  }
  if (felt) describeContact(file, tick);
  if (file.layered && tip_radius_ > 0 && tip_radius_ != probe_radius_)
    writeLog(HSP_LOG_WARNING, otherTip(probe_radius_, tip_radius_));
  if (file.grid && file.revision >= 2 && shear_offset_ != kUsualShearOffset)
    writeLog(HSP_LOG_WARNING,
             geometry_ + ": shear_offset has no effect on files of format hapticd-model/2; use shear_distance");
  if (!(most > kNoticed)) return;
  char text[192];
  std::snprintf(text, sizeof text,
                "shear_offset makes a press 5 mm deep up to %.2g times as stiff as the file says; use shear_distance "
                "instead to feel the stiffness of the file",
                most);
  writeLog(HSP_LOG_INFO, text);
}

/// Finds the material whose swinging mass needs the greatest damping of an arm. Warns if the mass has so little damping
/// that hardly any arm is passive on it.
void MatDeformable::describeContact(const MedialFile& file, double tick) const {
  double most = 0;
  Swing worst;
  for (const medial::Tissue& tissue : distinct(file)) {
    const Swing swing = swingOf(tissue, contact_ratio_, tick);
    most = std::max(most, swing.need);
    if (swing.times > worst.times) worst = swing;
  }
  char text[320];
  if (std::isfinite(most)) {
    std::snprintf(text, sizeof text,
                  "the whole body is passive on an arm with a damping of at least %.3g N s/m at %.4g Hz; with less, "
                  "limits.passivity must guard it",
                  most, 1 / tick);
    writeLog(HSP_LOG_DEBUG, text);
  }
  if (!(worst.times > kSwings)) return;
  char arm[96] = "it is not passive on any arm";
  if (std::isfinite(worst.times))
    std::snprintf(arm, sizeof arm, "an arm needs %.3g times the damping that the spring alone needs", worst.times);
  std::snprintf(text, sizeof text,
                ": a mass of %.3g kg swings almost undamped against the contact spring of %.4g N/m: at %.4g Hz %s; "
                "give it a damping of at least %.2g N s/m",
                worst.tissue.mass, medial::elementOf(worst.tissue, contact_ratio_).contact, 1 / tick, arm,
                enoughDamping(worst.tissue, contact_ratio_, tick));
  writeLog(HSP_LOG_WARNING, geometry_ + text);
}

std::vector<medial::Tissue> MatDeformable::distinct(const MedialFile& file) const {
  std::vector<medial::Tissue> all;
  for (std::size_t i = 0, count = body_->feltMaterial().size(); i < count && all.size() < kMostLines; ++i) {
    const medial::Tissue one = tissueAt(file, i);
    const auto same = [&one](const medial::Tissue& t) {
      return t.stiffness == one.stiffness && t.damping == one.damping && t.mass == one.mass;
    };
    if (one.stiffness > 0 && std::none_of(all.begin(), all.end(), same)) all.push_back(one);
  }
  return all;
}

}  // namespace hapticd
