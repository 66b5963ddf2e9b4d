// SPDX-License-Identifier: MIT
/// Tracing of a part, which a traced shape uses instead of a model file.
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <span>
#include <stdexcept>
#include <vector>

#include "document/suggestion.hpp"
#include "kernels/part/file.hpp"
#include "kernels/part/names.hpp"
#include "traced_shape.hpp"

namespace hapticd {
namespace {

/// Returns a warning about a size or a place that is surely a mistake, or "".
std::string oddPlace(const Eigen::AlignedBox3d& box, const hsp_pose& pose) {
  constexpr double kHuge = 5, kTiny = 1e-3, kFar = 2;  // [m] sizes and distances beyond these are unusual
  const double size = box.diagonal().norm();
  char text[160];
  if (size > kHuge || size < kTiny) {
    std::snprintf(
        text, sizeof text,
        "it is %.3g %s large from corner to corner, too %s for a hand; is it in a wrong unit? (see --scale of "
        "hapticd import)",
        size > kHuge ? size : 1e3 * size, size > kHuge ? "m" : "mm", size > kHuge ? "large" : "small");
    return text;
  }
  const Eigen::Quaterniond turn(pose.orientation[0], pose.orientation[1], pose.orientation[2], pose.orientation[3]);
  const Eigen::Vector3d origin = turn.conjugate() * -Eigen::Vector3d(pose.position);
  const double away = box.exteriorDistance(origin);
  if (away <= kFar) return "";
  std::snprintf(text, sizeof text,
                "its nearest point is %.3g m from the world's origin, where no arm reaches it; give the model a pose "
                "nearer to the origin",
                away);
  return text;
}

/// Returns one line per instance with the range of its features.
std::vector<std::string> instancesOf(const brep::Model& part) {
  constexpr size_t kMost = 100;
  std::vector<std::string> lines;
  for (const brep::Placement& place : part.placements()) {
    if (lines.size() == kMost) {
      lines.push_back("and " + std::to_string(part.placements().size() - kMost) + " more instances");
      break;
    }
    const brep::Body& body = part.part().bodies[place.body];
    const uint32_t count = body.face_count + body.triangle_count;
    lines.push_back(
        "features " + std::to_string(place.first_feature) + " to " + std::to_string(place.first_feature + count - 1) +
        ": " + brep::instancePath(part.part(), place.instance) + (body.triangle_count > 0 ? ", triangles" : ", faces"));
  }
  return lines;
}

/// Returns a warning about faces that the import has lost, or "". A solid without one of its faces is an open shell.
std::string lostOf(const brep::Part& part) {
  if (part.losses.empty()) return "";
  const size_t more = part.losses.size() - 1;
  return "the import lost " + part.losses.front().what +
         (more > 0 ? " and " + std::to_string(more) + " more" : std::string()) +
         ", so a solid may feel like an open shell; `hapticd part info` lists everything that was lost";
}

/// Returns the name and the path of each instance.
std::vector<std::string> namesIn(const brep::Part& part) {
  std::vector<std::string> names;
  for (uint32_t i = 0; i < part.instances.size(); ++i)
    for (const std::string& name : {brep::instancePath(part, i), brep::instanceName(part, i)}) names.push_back(name);
  return names;
}

/// Refuses a name that no instance has, if one was probably meant, and says which. Only kernels know instances, but
/// they know nothing of misspelt words.
void refuseMisspelt(const std::vector<std::string>& names, const std::string& parameter, const std::string& wanted) {
  if (wanted.empty() || std::find(names.begin(), names.end(), wanted) != names.end()) return;
  const std::string meant = document::suggestionOfName(wanted, names);
  if (!meant.empty())
    throw std::invalid_argument(parameter + ": there is no '" + wanted + "'" + meant +
                                "; hapticd part info lists the names of all instances");
}

/// Returns the names in a list that is separated by commas. A name may have commas itself: then it stands alone.
std::vector<std::string> listedNames(const std::string& list, const std::vector<std::string>& names) {
  if (list.empty()) return {};
  if (std::find(names.begin(), names.end(), list) != names.end()) return {list};
  std::vector<std::string> listed;
  for (size_t at = 0; at <= list.size();) {
    const size_t end = std::min(list.find(',', at), list.size());
    const size_t first = std::min(list.find_first_not_of(' ', at), end);
    if (first < end) listed.push_back(list.substr(first, list.find_last_not_of(' ', end - 1) + 1 - first));
    at = end + 1;
  }
  return listed;
}

}  // namespace

/// [main] Returns the name of a feature, as hsp_ext_names requires.
int64_t TracedShape::nameOf(uint32_t feature, char* text, uint64_t cap) const {
  if (!part_) return 0;
  const std::string name = part_->featureName(feature);
  std::copy_n(name.begin(), std::min<uint64_t>(cap, name.size()), text);
  return static_cast<int64_t>(name.size());
}

void TracedShape::loadPart(const std::string& bytes, const hsp_activation& activation, hsp_report& report) {
  if (!takes_parts_)
    throw std::invalid_argument("geometry: " + geometry_ +
                                " is a part, but this plugin needs a model file (only nurbs_rigid takes parts)");
  if (method_ == 0)
    throw std::invalid_argument(
        "method: dpt works only on surfaces without trims, from one foot to the next, but a part is searched as a "
        "whole in every tick; use method: newton");
  brep::ModelOptions options;
  options.form = evaluation_ == 0 ? spline::Form::kTable : spline::Form::kNet;
  brep::Part part = brep::readPart(std::as_bytes(std::span(bytes)), geometry_);
  const std::string lost = lostOf(part);
  const std::vector<std::string> names = namesIn(part);
  options.instance = instance_;
  options.without = listedNames(without_, names);
  refuseMisspelt(names, "instance", instance_);
  for (const std::string& name : options.without) refuseMisspelt(names, "without", name);
  part_ = std::make_unique<brep::Model>(std::move(part), options);
  const auto warn = [this](const std::string& what) { writeLog(HSP_LOG_WARNING, geometry_ + ": " + what); };
  if (!lost.empty()) warn(lost);
  for (const std::string& warning : part_->warnings()) warn(warning);
  if (const std::string odd = oddPlace(part_->bounds(), activation.pose); !odd.empty()) warn(odd);
  for (const std::string& line : instancesOf(*part_)) writeLog(HSP_LOG_DEBUG, line);
  if (sides_ == kFront && part_->open())
    warn(
        "is not closed, but with sides: front everything behind it counts as solid; "
        "give sides: both, or leave sides out");
  if (sides_ == kAuto) sides_ = part_->open() ? kBoth : kFront;
  const uint32_t probes = std::max(activation.max_probes, 1u);
  part_tracers_.clear();
  part_tracers_.reserve(probes);
  for (uint32_t i = 0; i < probes; ++i) part_tracers_.emplace_back(*part_);
  report.size_m = part_->bounds().diagonal().norm();
  report.locked_bytes = part_->bytes();
}

Touch TracedShape::tracePart(const hsp_probe& probe, const hsp_step& step, hsp_contact& contact) noexcept HSP_RT {
  Touch touch;
  const uint32_t index = indexOf(probe, step);
  if (index >= part_tracers_.size()) {
    touch.status = HSP_E_ARG;
    return touch;
  }
  if ((probe.flags & (HSP_IN_INVALID | HSP_IN_JUMP)) != 0) forgetContact(index);
  if ((probe.flags & HSP_IN_INVALID) != 0) return touch;
  brep::SearchBudget budget;
  if (step.max_iterations > 0) budget.elements = static_cast<int>(std::clamp<uint32_t>(step.max_iterations, 8, 256));
  const auto foot_at = [&, rule = contactRule()](const Eigen::Vector3d& p) {
    return part_tracers_[index].step(p, rule, budget);
  };
  return answer(footOf(probe, index, foot_at), contact);
}

}  // namespace hapticd
