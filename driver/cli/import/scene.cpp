// SPDX-License-Identifier: MIT
#include "cli/import/scene.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/file_ending.hpp"
#include "base/regular_file.hpp"
#include "base/shell_word.hpp"
#include "base/short_number.hpp"
#include "cli/support/command.hpp"
#include "cli/support/output_file.hpp"
#include "document/json_text.hpp"
#include "import/active_model.hpp"
#include "import/press_place.hpp"
#include "kernels/part/file.hpp"
#include "kernels/part/limit.hpp"
#include "kernels/part/names.hpp"

namespace hapticd::cli {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using importing::PressPlace;

constexpr double kBeforeTip = 0.04;  ///< [m] distance from there to the model
constexpr double kLarge = 0.5;       ///< [m] of a larger model the arm reaches only a part
constexpr double kSmall = 0.005;     ///< [m] a smaller model is hard to find with the tip
constexpr double kFitting = 0.15;    ///< [m] size of a model that is felt well
constexpr double kStiffness = 800;   ///< [N/m] of a rigid model, as the shipped scenes have it
constexpr double kPress = 0.004;     ///< [m] how far the hand presses: with about 1 N, which the motors can hold
constexpr double kFarAway = 9;       ///< [m] `check` warns of a position beyond 10 m
constexpr double kOffMiddle = 0.15;  ///< [m] how far beside the middle the arm can press
constexpr double kDeep = 0.03;       ///< [m] how far behind the side it can

/// Returns where the simulated arm holds its tip in the world [m].
Vector3d restOfTip() {
  return {0, 0, 0.09};
}

/// What the scene says of a model.
struct ModelFacts {
  PressPlace place;
  double stiffness = kStiffness;       ///< [N/m] of a rigid model
  bool open = false;                   ///< a part that is open
  std::vector<std::string> instances;  ///< of a part: the paths of those that have a body
};

/// Reads what a part says of itself. A model file has none of it.
Result<void> readPartFacts(const std::string& file, ModelFacts& facts) {
  if (endingOf(file) != ".hpart") return {};
  const auto bytes = readRegular(file, brep::kMostPartBytes);
  if (!bytes) return Error{file + ": " + bytes.error()};
  try {
    const brep::Part part = brep::readPart(std::as_bytes(std::span(*bytes)), file);
    for (std::uint32_t i = 0; i < part.instances.size(); ++i) {
      if (part.instances[i].body == brep::kNone) continue;
      const brep::Body& body = part.bodies[part.instances[i].body];
      facts.open = facts.open || body.kind == brep::BodyKind::kShell || (body.flags & brep::kClosed) == 0;
      facts.instances.push_back(brep::instancePath(part, i));
    }
  } catch (const brep::PartError& error) {
    return Error{error.what()};
  }
  return {};
}

/// [N/m] Returns the stiffness with which a tip does not go through the walls of a model, as its plugin advises; the
/// usual one if none is advised, or one with which the simulated arm trembles.
double stiffnessFor(const std::string& warnings) {
  constexpr std::string_view kAdvice = "stiffness: ";
  constexpr double kStiffest = 3000;
  const std::size_t at = warnings.find(kAdvice), end = warnings.find(" keeps the tip inside");
  if (at == std::string::npos || end == std::string::npos) return kStiffness;
  const double advised = std::strtod(warnings.c_str() + at + kAdvice.size(), nullptr);
  return advised > kStiffness && advised <= kStiffest ? advised : kStiffness;
}

Result<ModelFacts> factsOf(const FirstScene& first) {
  constexpr double kChordShare = 0.002;
  std::string warnings;
  const auto shape =
      importing::activated(first.soft ? "mat_deformable" : "nurbs_rigid", first.model, catalog(), "", 1, &warnings);
  if (!shape) return Error{shape.error()};
  const auto mesh = importing::tessellated(**shape, kChordShare);
  if (!mesh) return Error{mesh.error()};
  if (mesh->corners.empty()) return Error{"it has no surface"};
  ModelFacts facts{importing::pressPlace(*mesh), stiffnessFor(warnings), false, {}};
  if (const auto read = readPartFacts(first.model, facts); !read) return Error{read.error()};
  return facts;
}

/// Returns a text as YAML takes it, in quotes if it has characters that mean something there.
std::string yamlText(const std::string& text) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) || std::strchr("_-./", c) != nullptr || c >= 0x80; };
  const bool all = !text.empty() && text[0] != '-' && std::all_of(text.begin(), text.end(), plain);
  return all ? text : document::jsonLine(text);
}

/// Returns the name of a file for a comment.
std::string fileName(const std::string& file) {
  return brep::plainText(fs::path(file).filename().string());
}

/// Returns a name for the model: programs and `ctl` need one without spaces and signs.
std::string modelName(const std::string& file) {
  std::string name = fs::path(file).stem().string();
  for (char& c : name)
    if (const auto byte = static_cast<unsigned char>(c); !std::isalnum(byte) && c != '-' && byte < 0x80) c = '_';
  return name == "null" || name == "Null" || name == "NULL" ? "model" : name;
}

/// Returns the path of a file as the scene names it: relative to the scene, if they share more than the root folder.
std::string pathFrom(const std::string& scene, const fs::path& file) {
  std::error_code error;
  const fs::path folder = fs::weakly_canonical(fs::absolute(scene), error).parent_path();
  const fs::path target = fs::weakly_canonical(fs::absolute(file), error);
  const fs::path relative = target.lexically_relative(folder);
  const auto first = [](const fs::path& path) { return *std::next(path.begin()); };
  const bool below = *relative.begin() != "..";
  return below || (folder.has_relative_path() && first(folder) == first(target)) ? relative.string() : target.string();
}

/// [m] Returns a vector as YAML, rounded to the micrometre, which no hand feels.
std::string listOf(const Vector3d& v) {
  const auto rounded = [](double x) { return withDigits(std::round(1e6 * x) * 1e-6 + 0.0, 9); };
  return "[" + rounded(v.x()) + ", " + rounded(v.y()) + ", " + rounded(v.z()) + "]";
}

std::string sizeText(const Vector3d& size) {
  const bool large = size.maxCoeff() >= 1;
  const auto in = [large](double length) { return shortNumber(large ? length : 1e3 * length); };
  return in(size.x()) + " x " + in(size.y()) + " x " + in(size.z()) + (large ? " m" : " mm");
}

/// [m] Returns where the model belongs in the world: the middle of the side that is pressed before the resting tip; or
/// the pressed place, if the arm could not reach it from there.
Vector3d positionOf(const PressPlace& place) {
  const Vector3d middle = place.middleOfSide(), aside = place.point - middle;
  const bool far = aside.norm() > kOffMiddle || -aside.dot(place.normal) > kDeep;
  return restOfTip() - kBeforeTip * place.normal - (far ? place.point : middle);
}

std::string handLines(const PressPlace& place, const Vector3d& position) {
  const double thick = (place.point - place.box.min()).dot(place.normal);
  constexpr double kFlat = 1e-4;  // [m] a sheet has no back out of which the hand could come
  const double rise = thick < kFlat ? kPress : std::min(kPress, 0.9 * thick);
  return fmt::format(
      "# The hand that holds the simulated arm: it presses by `rise` [m] at `center`, `rate` times a second. The "
      "frame\n"
      "# of the arm has its origin at z = 0.09 of the world. With --view the hand follows the mouse: drag the tip.\n"
      "hand: {{script: press, center: {}, normal: {}, radius: 0, rise: {}, rate: 0.5}}\n",
      listOf(position + place.point - restOfTip()), listOf(place.normal), withDigits(rise, 3));
}

/// Returns a line of the parameters, or one that has no effect before its # is removed.
std::string parameterLine(const std::string& setting, const std::string& comment) {
  return fmt::format("      {:<24} # {}\n", setting, comment);
}

/// The feel of the model. A soft body in a model file brings its own.
std::string feelLines(const FirstScene& first, double stiffness) {
  if (first.soft && endingOf(first.model) != ".ma")
    return "      # stiffness, damping and mass are in the geometry file\n";
  if (first.soft)
    return parameterLine("stiffness: 400", "N/m; smaller is softer") +
           parameterLine("damping: 0.5", "N s/m, of each sphere") + parameterLine("mass: 0.01", "kg, of each sphere") +
           parameterLine("dynamics: felt", "the hand feels the body as it moves; off: a body at rest");
  return parameterLine("stiffness: " + shortNumber(stiffness),
                       stiffness > kStiffness ? "N/m; with less the tip comes out behind the thinnest wall"
                                              : "N/m; smaller is softer") +
         parameterLine("damping: 2", "N s/m, against the speed of a press") +
         parameterLine("# friction_static: 0.3", "with friction_dynamic: 0.2; without both the surface is slippery");
}

/// A hint for an assembly; "" for a single part.
std::string instanceLines(const FirstScene& first, const ModelFacts& facts) {
  if (facts.instances.size() < 2) return "";
  return fmt::format(
      "      # This is the whole assembly of {} parts. One of them alone, as a model that can move:\n"
      "      # instance: {}   # all names: hapticd part info {}\n"
      "      # The others, in a second model with the same pose, which stands still:\n"
      "      # without: {}\n",
      facts.instances.size(), yamlText(facts.instances.front()), shellWord(fileName(first.model)),
      yamlText(facts.instances.front()));
}

/// A small ball about the tip for solids that may touch each other; "" for a single one, and for what is open.
std::string ballLine(const FirstScene& first, const ModelFacts& facts) {
  if (first.soft || facts.open || facts.instances.size() < 2) return "";
  return parameterLine("tip_radius: 0.0002", "m; where parts touch, a ball is stopped by each, a point by one of them");
}

std::string modelLines(const FirstScene& first, const ModelFacts& facts) {
  const PressPlace& place = facts.place;
  std::string text = fmt::format(
      "models:\n  - name: {}\n    plugin: {}\n"
      "    # {} large. Is that wrong? Import it anew with --scale or --fit.{}\n"
      "    # `position` [m] puts it 4 cm before the resting tip. If you change it, change `center` of the hand as "
      "well.\n"
      "    pose: {{position: {}}}\n    parameters:\n",
      modelName(first.model), first.soft ? "mat_deformable" : "nurbs_rigid", sizeText(place.box.sizes()),
      first.placement.up == 'y' ? " Does its z point up? Add --up z." : "", listOf(positionOf(place)));
  text += parameterLine("geometry: " + yamlText(pathFrom(first.scene, first.model)), "paths are relative to this file");
  if (!first.soft && (facts.open || !place.faces_hand))
    text += parameterLine("sides: both", "an open shell, felt from both sides");
  return text + feelLines(first, facts.stiffness) + ballLine(first, facts) + instanceLines(first, facts);
}

std::string textOf(const FirstScene& first, const ModelFacts& facts) {
  std::string text = fmt::format(
      "# A scene to start from, written by `hapticd import {} --scene {}`.\n"
      "# Lengths are in m; x points right, y up, z toward you. After each change: hapticd check {}\n"
      "hapticd: 1\nservo: {{rate: 1000}}\n",
      shellWord(fileName(first.from)), shellWord(fileName(first.scene)), shellWord(fileName(first.scene)));
  if (const auto device = host::shippedFile("devices/simulated-premium15.yaml"))
    text += "# A simulated arm. The device file of a real one goes here (hapticd device new).\ndevice: " +
            yamlText(pathFrom(first.scene, *device)) + "\n";
  return text + handLines(facts.place, positionOf(facts.place)) + modelLines(first, facts);
}

/// Warns of a model that the arm cannot reach, or that the tip hardly finds, and says which size would fit.
void warnOfFit(const FirstScene& first, const Vector3d& size) {
  const double most = size.maxCoeff();
  if (most <= kLarge && most >= kSmall) return;
  const std::string scale =
      first.placement.fit > 0 ? "" : ", or --scale " + shortNumber(first.placement.scale * kFitting / most);
  std::fprintf(stderr, "warning: %s: is %s large, and %s\n  fix: rm %s, then import it anew with --fit %s%s\n",
               first.model.c_str(), sizeText(size).c_str(),
               most > kLarge ? "the arm reaches only a part of it" : "a tip hardly finds it",
               shellWord(first.scene).c_str(), withDigits(kFitting, 3).c_str(), scale.c_str());
}

/// Warns of a model whose own coordinates are so large that the scene must move it by metres.
void warnOfPlace(const FirstScene& first, const Vector3d& middle) {
  if (middle.norm() <= kFarAway || first.placement.center) return;
  std::fprintf(stderr,
               "warning: %s: is %s m from the origin of its own coordinates, so `check` takes its position for one in "
               "another unit\n  fix: rm %s, then import it anew with --center\n",
               first.model.c_str(), shortNumber(middle.norm()).c_str(), shellWord(first.scene).c_str());
}

}  // namespace

std::string whyNoScene(const std::string& scene, const std::string& model) {
  std::error_code error;
  if (endingOf(scene) != ".yaml" && endingOf(scene) != ".yml")
    return scene + ": a scene is YAML, expected a name that ends in .yaml";
  if (model == "-") return "--scene needs a file to name, expected the name of a file for --out, not -";
  if (fs::exists(fs::symlink_status(scene, error))) return scene + " exists already, expected the name of a new file";
  if (const std::string wrong = whyNotWritable(scene); !wrong.empty()) return wrong;
  if (fs::weakly_canonical(fs::absolute(scene), error) == fs::weakly_canonical(fs::absolute(model), error))
    return scene + ": is the file that --out names, expected another file";
  return "";
}

int writeFirstScene(const FirstScene& first) {
  const auto facts = factsOf(first);
  if (!facts && first.from == first.model)
    return fail(kBadInput, first.model + ": no scene can be made: " + facts.error());
  if (!facts) return fail(kFailed, first.model + " is written, but no scene for it: " + facts.error());
  if (const auto written = writeWhole(first.scene, textOf(first, *facts)); !written)
    return fail(kFailed, written.error());
  warnOfFit(first, facts->place.box.sizes());
  warnOfPlace(first, facts->place.box.center());
  if (first.silent) return kWorked;
  const std::string scene = shellWord(first.scene);
  std::printf("%s\n\nthen:\n  hapticd check %s               # after each change\n  hapticd run %s --view\n",
              first.scene.c_str(), scene.c_str(), scene.c_str());
  return kWorked;
}

}  // namespace hapticd::cli
