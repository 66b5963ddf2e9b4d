// SPDX-License-Identifier: MIT
#include "cad_import/report.hpp"

#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "base/counted.hpp"
#include "base/short_number.hpp"
#include "kernels/part/names.hpp"

namespace hapticd::cad {
namespace {

using brep::kNone;
using brep::Part;
using Json = nlohmann::ordered_json;

struct Counts {
  std::size_t placed = 0, faces = 0;  ///< number of bodies that have an instance, and of their faces
  std::map<std::string, std::size_t> kinds;
};

Counts countsOf(const Part& part) {
  Counts counts;
  for (const brep::Instance& instance : part.instances) {
    if (instance.body == kNone) continue;
    ++counts.placed;
    counts.faces += part.bodies[instance.body].face_count;
  }
  for (const brep::Face& face : part.faces)
    ++counts.kinds[brep::kSurfaceNames[static_cast<std::size_t>(part.surfaces[face.surface].kind)]];
  return counts;
}

/// Returns the size of the part, such as "80 x 60 x 20 mm, ".
std::string sizeText(const Report& report) {
  const Eigen::AlignedBox3d& box = report.measures.box;
  if (box.isEmpty()) return "";
  const bool large = box.sizes().maxCoeff() >= 1;
  const Eigen::Vector3d size = box.sizes() * (large ? 1 : 1000);
  char text[100];
  std::snprintf(text, sizeof text, "%.4g x %.4g x %.4g %s, ", size.x(), size.y(), size.z(), large ? "m" : "mm");
  return text;
}

Json sizeJson(const Report& report) {
  if (report.measures.box.isEmpty()) return nullptr;
  const Eigen::Vector3d size = report.measures.box.sizes();
  return {size.x(), size.y(), size.z()};
}

std::string unitText(const brep::Source& source) {
  std::string text = "unit " + source.unit + (source.unit_assumed ? " (assumed)" : "");
  if (source.scale != 1) text += ", scaled by " + withDigits(source.scale, 6);
  return text + (source.placed.empty() ? "" : ", " + source.placed);
}

}  // namespace

std::string oddSizeOf(const Part& part, const Report& report, const std::string& out) {
  constexpr double kTooLarge = 5, kTooSmall = 1e-3;  // [m] as for meshes and in `check`
  if (report.measures.box.isEmpty()) return "";
  const double size = report.measures.box.diagonal().norm();
  if (size <= kTooLarge && size >= kTooSmall) return "";
  const bool large = size > kTooLarge, scaled = part.source.scale != 1;
  char text[80];
  std::snprintf(text, sizeof text, ": %.3g %s large from corner to corner, too %s for a hand; ",
                size * (large ? 1 : 1000), large ? "m" : "mm", large ? "large" : "small");
  return "warning: " + out + text +
         (scaled ? "is --scale right? It is a factor on top of the unit of the file\n"
                 : "if the unit of the file is wrong, add --scale, a factor on top of it, such as --scale " +
                       std::string(large ? "0.001" : "1000") + "\n");
}

std::vector<std::string> stepsOf(const Report& report) {
  std::vector<std::string> lines;
  if (report.recognised > 0)
    lines.push_back(counted(report.recognised, "spline face is", "spline faces are") +
                    " really a plane, cylinder, cone or sphere, and stored as such");
  lines.insert(lines.end(), report.steps.begin(), report.steps.end());
  return lines;
}

std::string textOf(const Part& part, const Report& report, const std::string& out) {
  constexpr std::size_t kMostLines = 40;
  const Counts counts = countsOf(part);
  std::string text = out + ": " + counted(part.faces.size(), "face") + " in " +
                     counted(part.bodies.size(), "body", "bodies") + ", " + counted(counts.placed, "instance") +
                     " with " + counted(counts.faces, "face") + ", " + sizeText(report) + unitText(part.source) + "\n ";
  for (const auto& [kind, count] : counts.kinds)
    text += (text.back() == ' ' ? " " : ", ") + std::to_string(count) + " " + kind;
  text += "\n";
  std::size_t lines = 0;
  const auto add = [&](const std::string& line) {
    if (++lines <= kMostLines) text += "  " + line + "\n";
  };
  for (const auto& said : {stepsOf(report), part.warnings, report.measures.notes})
    for (const std::string& line : said) add(line);
  bool lost = false;
  for (const std::string& line : brep::lossLines(part)) {
    add(line);
    lost = lost || line.starts_with("lost: ");
  }
  if (lines > kMostLines)
    text += "  and " + std::to_string(lines - kMostLines) + " more lines: --json lists them all\n";
  if (!lost) text += "  nothing was lost\n";
  return text;
}

std::string jsonOf(const Part& part, const Report& report, const std::string& out) {
  const Counts counts = countsOf(part);
  Json losses = Json::array();
  for (const brep::Loss& loss : part.losses) {
    losses.push_back({{"what", loss.what}, {"reason", loss.reason}, {"size_m", loss.size}});
    if (loss.face != kNone) losses.back()["face"] = loss.face;
  }
  std::vector<std::string> warnings = part.warnings;
  warnings.insert(warnings.end(), report.measures.notes.begin(), report.measures.notes.end());
  const Json json = {{"part", out},
                     {"unit", part.source.unit},
                     {"unit_assumed", part.source.unit_assumed},
                     {"scale", part.source.scale},
                     {"placed", part.source.placed},
                     {"size_m", sizeJson(report)},
                     {"bodies", part.bodies.size()},
                     {"instances", counts.placed},
                     {"faces", part.faces.size()},
                     {"faces_placed", counts.faces},
                     {"face_kinds", counts.kinds},
                     {"edges", part.edges.size()},
                     {"tolerance_m", part.tolerance},
                     {"recognised", report.recognised},
                     {"steps", report.steps},
                     {"warnings", warnings},
                     {"losses", losses},
                     {"seconds", report.seconds}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace hapticd::cad
