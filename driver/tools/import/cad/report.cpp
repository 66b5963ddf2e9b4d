// SPDX-License-Identifier: MIT
#include "cad_import/report.hpp"

#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

namespace hapticd::cad {
namespace {

using brep::kNone;
using brep::Part;
using Json = nlohmann::ordered_json;

constexpr const char* kSurfaceNames[] = {"plane",    "cylinder",  "cone",       "sphere", "torus",
                                         "B-spline", "extrusion", "revolution", "offset"};

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
    ++counts.kinds[kSurfaceNames[static_cast<std::size_t>(part.surfaces[face.surface].kind)]];
  return counts;
}

std::string plural(std::size_t count, const char* what, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? what : many);
}

std::string metresText(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g m", length);
  return text;
}

}  // namespace

std::string textOf(const Part& part, const Report& report, const std::string& out) {
  constexpr std::size_t kMostLines = 40;
  const Counts counts = countsOf(part);
  std::string text = out + ": " + plural(part.faces.size(), "face", "faces") + " in " +
                     plural(part.bodies.size(), "body", "bodies") + ", " +
                     plural(counts.placed, "instance", "instances") + " with " + plural(counts.faces, "face", "faces") +
                     ", unit " + part.source.unit + "\n ";
  for (const auto& [kind, count] : counts.kinds)
    text += (text.back() == ' ' ? " " : ", ") + std::to_string(count) + " " + kind;
  text += "\n";
  std::size_t lines = 0;
  const auto add = [&](const std::string& line) {
    if (++lines <= kMostLines) text += "  " + line + "\n";
  };
  if (report.recognised > 0)
    add(plural(report.recognised, "spline face is", "spline faces are") +
        " really a plane, cylinder, cone or sphere, and stored as such");
  for (const std::string& step : report.steps) add(step);
  for (const std::string& warning : part.warnings) add(warning);
  for (const brep::Loss& loss : part.losses)
    add("lost: " + loss.what + ": " + loss.reason + (loss.size > 0 ? " (" + metresText(loss.size) + ")" : ""));
  if (lines > kMostLines)
    text += "  and " + std::to_string(lines - kMostLines) + " more lines: --json lists them all\n";
  if (part.losses.empty()) text += "  nothing was lost\n";
  return text;
}

std::string jsonOf(const Part& part, const Report& report, const std::string& out) {
  const Counts counts = countsOf(part);
  Json losses = Json::array();
  for (const brep::Loss& loss : part.losses) {
    losses.push_back({{"what", loss.what}, {"reason", loss.reason}, {"size_m", loss.size}});
    if (loss.face != kNone) losses.back()["face"] = loss.face;
  }
  const Json json = {{"part", out},
                     {"unit", part.source.unit},
                     {"bodies", part.bodies.size()},
                     {"instances", counts.placed},
                     {"faces", part.faces.size()},
                     {"faces_placed", counts.faces},
                     {"face_kinds", counts.kinds},
                     {"edges", part.edges.size()},
                     {"tolerance_m", part.tolerance},
                     {"recognised", report.recognised},
                     {"steps", report.steps},
                     {"warnings", part.warnings},
                     {"losses", losses},
                     {"seconds", report.seconds}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace hapticd::cad
