// SPDX-License-Identifier: MIT
/// `hapticd part info`: prints what a part file holds.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "base/counted.hpp"
#include "base/regular_file.hpp"
#include "base/shell_word.hpp"
#include "base/short_number.hpp"
#include "cli/part/feature.hpp"
#include "cli/part/poses.hpp"
#include "cli/support/command.hpp"
#include "kernels/brep/model/model.hpp"
#include "kernels/brep/search/tight_bounds.hpp"
#include "kernels/part/file.hpp"
#include "kernels/part/limit.hpp"
#include "kernels/part/names.hpp"

namespace hapticd::cli {
namespace {

using brep::kNone;
using brep::Part;
using Json = nlohmann::ordered_json;

constexpr const char* kEdgeNames[] = {"unclassified", "smooth", "convex",       "concave",
                                      "mixed",        "free",   "non-manifold", "pole"};
constexpr const char* kBodyNames[] = {"solid", "shell", "sheet", "mesh"};

std::string nameOf(const Part& part, std::uint32_t name) {
  return name == kNone ? "" : part.names[name];
}

Json countsOf(const std::map<std::string, std::size_t>& counts) {
  Json json = Json::object();
  for (const auto& [name, count] : counts) json[name] = count;
  return json;
}

std::size_t colouredIn(const Part& part, const brep::Body& body) {
  if (part.colours.empty()) return 0;
  const auto own = std::span(part.colours).subspan(body.first_triangle, body.triangle_count);
  return static_cast<std::size_t>(std::count_if(own.begin(), own.end(), [](const brep::CornerColours& colours) {
    return colours.corner != std::array<std::uint32_t, 3>{};
  }));
}

Json bodiesOf(const Part& part) {
  Json bodies = Json::array();
  for (const brep::Body& body : part.bodies)
    bodies.push_back({{"name", nameOf(part, body.name)},
                      {"kind", kBodyNames[static_cast<std::size_t>(body.kind)]},
                      {"closed", (body.flags & brep::kClosed) != 0},
                      {"faces", body.face_count},
                      {"edges", body.edge_count},
                      {"triangles", body.triangle_count},
                      {"coloured_triangles", colouredIn(part, body)}});
  return bodies;
}

Json instancesOf(const Part& part) {
  Json instances = Json::array();
  std::size_t feature = 0;
  for (const brep::Instance& instance : part.instances) {
    Json entry = {{"name", nameOf(part, instance.name)}};
    if (instance.parent != kNone) entry["parent"] = instance.parent;
    if (instance.body != kNone) {
      const brep::Body& body = part.bodies[instance.body];
      entry["body"] = instance.body;
      entry["first_feature"] = feature;
      feature += std::size_t{body.face_count} + body.triangle_count;
      entry["last_feature"] = feature - std::min<std::size_t>(feature, 1);
    }
    entry["position_m"] = {instance.pose[3], instance.pose[7], instance.pose[11]};
    instances.push_back(std::move(entry));
  }
  return instances;
}

Json describe(const Part& part, std::size_t bytes) {
  std::map<std::string, std::size_t> faces, edges;
  for (const brep::Face& face : part.faces)
    ++faces[brep::kSurfaceNames[static_cast<std::size_t>(part.surfaces[face.surface].kind)]];
  for (const brep::Edge& edge : part.edges) ++edges[kEdgeNames[static_cast<std::size_t>(edge.kind)]];
  Json losses = Json::array();
  for (const brep::Loss& loss : part.losses)
    losses.push_back({{"what", loss.what}, {"reason", loss.reason}, {"size_m", loss.size}});
  return {{"format", "hapticd-part/1"},
          {"bytes", bytes},
          {"source",
           {{"file", part.source.file},
            {"unit", part.source.unit},
            {"unit_assumed", part.source.unit_assumed},
            {"scale", part.source.scale},
            {"placed", part.source.placed},
            {"sha256", part.source.sha256}}},
          {"tolerance_m", part.tolerance},
          {"faces", part.faces.size()},
          {"face_kinds", countsOf(faces)},
          {"edges", part.edges.size()},
          {"edge_kinds", countsOf(edges)},
          {"triangles", part.triangles.size()},
          {"bodies", bodiesOf(part)},
          {"instances", instancesOf(part)},
          {"losses", losses},
          {"warnings", part.warnings}};
}

/// Adds the box of each body in its place: names alone seldom show which part of an assembly is which.
void addPlaces(Json& info, const brep::Model& model) {
  for (std::uint32_t i = 0; i < model.placements().size(); ++i) {
    const Eigen::AlignedBox3d box = brep::tightBounds(model, i);
    const Eigen::Vector3d& low = box.min();
    const Eigen::Vector3d size = box.sizes(), middle = box.center();
    Json& instance = info["instances"][model.placements()[i].instance];
    instance["box_m"] = {{"low", {low.x(), low.y(), low.z()}}, {"size", {size.x(), size.y(), size.z()}}};
    instance["middle_m"] = {middle.x(), middle.y(), middle.z()};
  }
}

/// Adds what is not in the file: the box around all bodies in their places, and the notes that loading the part gives.
void addMeasures(Json& info, Part part) {
  try {
    brep::ModelOptions options;
    options.empty_balls = false;
    const brep::Model model(std::move(part), options);
    const Eigen::AlignedBox3d box = brep::tightBounds(model);
    const Eigen::Vector3d& low = box.min();
    const Eigen::Vector3d size = box.sizes();
    info["box_m"] = {{"low", {low.x(), low.y(), low.z()}}, {"size", {size.x(), size.y(), size.z()}}};
    const Eigen::Vector3d middle = box.center();
    info["middle_m"] = {middle.x(), middle.y(), middle.z()};
    addPlaces(info, model);
    for (const PartPose& pose : centringPoses(box)) info["poses"][pose.name] = poseText(pose);
    for (const std::string& warning : model.warnings()) info["warnings"].push_back(warning);
  } catch (const std::invalid_argument& error) {
    info["warnings"].push_back(error.what());
  }
}

std::string listed(const Json& counts) {
  std::string text;
  for (const auto& [name, count] : counts.items())
    text += (text.empty() ? "" : ", ") + std::to_string(count.get<std::size_t>()) + " " + name;
  return text;
}

/// Returns the counts of edges as text. Without the loader's analysis, an importer's edges are not yet smooth, convex
/// or concave.
std::string edgesOf(const Json& info) {
  Json told = info["edge_kinds"];
  told.erase(kEdgeNames[0]);
  const std::string all = std::to_string(info["edges"].get<std::size_t>()), kinds = listed(told);
  return kinds.empty() ? all : all + ", of these " + kinds;
}

void printBodies(const Json& info) {
  for (const Json& body : info["bodies"]) {
    const std::string name = body["name"].get<std::string>();
    std::printf("  body %s: %s, %s, ", name.empty() ? "unnamed" : ("'" + name + "'").c_str(),
                body["kind"].get<std::string>().c_str(), body["closed"].get<bool>() ? "closed" : "open");
    const auto triangles = body["triangles"].get<std::size_t>(),
               coloured = body["coloured_triangles"].get<std::size_t>();
    if (triangles > 0)
      std::printf("%s%s\n", counted(triangles, "triangle").c_str(),
                  coloured == 0           ? ""
                  : coloured == triangles ? ", all with a colour"
                                          : (", " + std::to_string(coloured) + " with a colour").c_str());
    else
      std::printf("%s, %s\n", counted(body["faces"].get<std::size_t>(), "face").c_str(),
                  counted(body["edges"].get<std::size_t>(), "edge").c_str());
  }
}

/// [mm] Returns three lengths as text. @param digits the box around a curved body is up to some 0.1 % too large
std::string inMm(const Json& metres, const char* between, int digits) {
  std::string text;
  for (const Json& length : metres)
    text += (text.empty() ? "" : between) + withDigits(std::round(1e9 * length.get<double>()) * 1e-6 + 0.0, digits);
  return text;
}

void printInstances(const Json& info) {
  std::vector<int> depth;
  for (const Json& instance : info["instances"]) {
    depth.push_back(instance.contains("parent") ? depth[instance["parent"].get<std::size_t>()] + 1 : 0);
    const std::string name = instance["name"].get<std::string>();
    std::printf("  %*sinstance %s", 2 * depth.back(), "", name.empty() ? "unnamed" : ("'" + name + "'").c_str());
    if (instance.contains("body"))
      std::printf(": body %zu, features %zu to %zu", instance["body"].get<std::size_t>(),
                  instance["first_feature"].get<std::size_t>(), instance["last_feature"].get<std::size_t>());
    if (instance.contains("box_m"))
      std::printf(", %s mm, middle at (%s) mm", inMm(instance["box_m"]["size"], " x ", 3).c_str(),
                  inMm(instance["middle_m"], ", ", 4).c_str());
    std::printf("\n");
  }
}

/// Returns the file of a part, its unit, and how the import placed it.
std::string sourceOf(const Json& source) {
  std::string text = source["file"].get<std::string>() + ", unit " + source["unit"].get<std::string>();
  if (source["unit_assumed"].get<bool>()) text += " (assumed)";
  if (const auto scale = source["scale"].get<double>(); scale != 1) text += ", scaled by " + withDigits(scale, 6);
  const std::string placed = source["placed"].get<std::string>();
  return text + (placed.empty() ? "" : ", " + placed);
}

void print(const std::string& file, const Json& info, const std::vector<std::string>& losses) {
  std::printf("%s: %s, %zu bytes\n", file.c_str(), info["format"].get<std::string>().c_str(),
              info["bytes"].get<std::size_t>());
  std::printf("  from %s, tolerance %.3g m\n", sourceOf(info["source"]).c_str(), info["tolerance_m"].get<double>());
  if (info.contains("box_m")) {
    const Json &size = info["box_m"]["size"], &low = info["box_m"]["low"];
    const double most = std::max({size[0].get<double>(), size[1].get<double>(), size[2].get<double>()});
    const bool large = most >= 1;
    const auto in = [large](const Json& length) {
      return std::round(1e9 * length.get<double>()) * (large ? 1e-9 : 1e-6) + 0.0;
    };
    const char* unit = large ? "m" : "mm";
    const Json& middle = info["middle_m"];
    std::printf(
        "  size: %.4g x %.4g x %.4g %s, least corner at (%.4g, %.4g, %.4g) %s, middle at (%.4g, %.4g, %.4g) %s\n",
        in(size[0]), in(size[1]), in(size[2]), unit, in(low[0]), in(low[1]), in(low[2]), unit, in(middle[0]),
        in(middle[1]), in(middle[2]), unit);
    std::printf("  in a scene, to centre it:    %s\n", info["poses"]["centred"].get<std::string>().c_str());
    std::printf("  the same, and its z is up:   %s\n", info["poses"]["z_up"].get<std::string>().c_str());
  }
  if (info["faces"].get<std::size_t>() > 0) {
    std::printf("  faces: %s\n", listed(info["face_kinds"]).c_str());
    std::printf("  edges: %s\n", edgesOf(info).c_str());
  }
  printBodies(info);
  printInstances(info);
  for (const std::string& loss : losses) std::printf("  %s\n", loss.c_str());
  for (const Json& warning : info["warnings"]) std::printf("  %s\n", warning.get<std::string>().c_str());
}

int printFeature(const std::string& file, const Part& part, const std::string& asked) {
  const auto feature = featureCalled(part, asked);
  if (!feature)
    return fail(kBadInput, file + ": has no feature '" + asked +
                               "', expected a number, or a name as messages have it, such as '" +
                               brep::featureName(part, 0) + "'; hapticd part info " + shellWord(file) +
                               " says which features each instance has");
  std::printf("%s\n", brep::featureName(part, *feature).c_str());
  try {
    std::printf("  %s\n", featureText(part, *feature).c_str());
  } catch (const std::invalid_argument& error) {
    std::printf("  %s\n", error.what());
  }
  return kWorked;
}

int printAxes(const std::string& file, const Part& part) {
  try {
    const std::vector<std::string> lines = axisLines(part);
    for (const std::string& line : lines) std::printf("%s\n", line.c_str());
    if (lines.empty())
      std::printf(
          "%s: no face has an axis, as a cylinder, cone, torus or surface of revolution has: measure the pivot in the "
          "program that made the part\n",
          file.c_str());
  } catch (const std::invalid_argument& error) {
    return fail(kBadInput, file + ": " + error.what());
  }
  return kWorked;
}

/// What `part info` is asked.
struct InfoArguments {
  std::string file;
  bool json = false, axes = false;
  std::string feature;  ///< its number, or its name as messages have it
};

int partInfo(const InfoArguments& options) {
  const std::string& file = options.file;
  if (file.ends_with(".yaml") || file.ends_with(".yml"))
    return fail(kBadInput, file +
                               ": a YAML file, expected a part (.hpart); "
                               "a model file needs no import: a scene names it (geometry: " +
                               file + "), and hapticd check SCENE checks both");
  const auto bytes = readRegular(file, brep::kMostPartBytes);
  if (!bytes) return fail(kBadInput, file + ": " + bytes.error());
  try {
    Part part = brep::readPart(std::as_bytes(std::span(*bytes)), file);
    if (!options.feature.empty()) return printFeature(file, part, options.feature);
    if (options.axes) return printAxes(file, part);
    Json info = describe(part, bytes->size());
    const std::vector<std::string> losses = brep::lossLines(part);
    addMeasures(info, std::move(part));
    if (options.json)
      printJson(info);
    else
      print(file, info, losses);
  } catch (const brep::PartError& error) {
    return fail(kBadInput, error.what());
  }
  return kWorked;
}

}  // namespace

void addPart(const Command& app, int& exit_code) {
  const Command command =
      app.addSubcommand("part", "Work with part files, which `hapticd import` makes from CAD files and meshes.");
  command.requireSubcommand();
  command.footer("Example:\n  hapticd part info bracket.hpart");
  auto options = std::make_shared<InfoArguments>();
  const Command info = command.addSubcommand("info", "Show what a part file holds: bodies, instances, faces, losses.");
  info.addOption("part", options->file, "a part file (.hpart)").required();
  info.addFlag("--json", options->json, "print JSON");
  info.addOption(
          "--feature", options->feature,
          "print only this feature: its instance and face, its kind, size and place; its number (column feature of a "
          "trace), or its name, such as 'bolt: face 3'")
      .excludes("--json");
  info.addFlag("--axes", options->axes,
               "print only the axes of the round faces of each instance, as the keys of a scene that make a hinge")
      .excludes("--json")
      .excludes("--feature");
  info.footer(
      "Examples:\n  hapticd part info bracket.hpart\n"
      "  hapticd part info engine.hpart --axes    # where a body can turn");
  info.callback([options, &exit_code] { exit_code = partInfo(*options); });
}

}  // namespace hapticd::cli
