// SPDX-License-Identifier: MIT
#include "diagnostics/device/device_twin.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "diagnostics/device/rest_pose.hpp"
#include "diagnostics/reading/given_values.hpp"

namespace hapticd::diagnostics {
namespace {

using document::Node;

/// Returns a node as one line of YAML in the form in which a person writes it, without quotes that the file lacks.
std::string flowText(const Node& node) {
  std::string text;
  if (node.isMap()) {
    for (const document::Entry& entry : node.entries)
      text += (text.empty() ? "" : ", ") + flowText(entry.key) + ": " + flowText(entry.value);
    return "{" + text + "}";
  }
  if (node.isSequence()) {
    for (const Node& item : node.items) text += (text.empty() ? "" : ", ") + flowText(item);
    return "[" + text + "]";
  }
  return node.isScalar() && !node.quoted ? node.scalar : document::toJson(node);
}

const Node kNothing{};

const Node& below(const Node& node, std::string_view key) {
  const Node* found = node.isMap() ? node.find(key) : nullptr;
  return found != nullptr ? *found : kNothing;
}

template <size_t N>
bool listed(const std::array<std::string_view, N>& keys, const std::string& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// Returns a map without some of its keys, as one line of YAML.
template <size_t N>
std::string flowWithout(Node map, const std::array<std::string_view, N>& keys) {
  std::erase_if(map.entries, [&](const document::Entry& entry) { return listed(keys, entry.key.scalar); });
  return flowText(map);
}

/// Returns the block `arm`. Keys that the simulated arm lacks are left out, and `origin` of a chain becomes
/// `base_position`.
std::string armOfTwin(const Node& arm, bool chain) {
  static constexpr std::array<std::string_view, 10> kSame{
      "kind",       "lengths", "angles",  "masses",           "limits",
      "max_torque", "dh",      "centers", "base_orientation", "tool_position"};
  std::string text = "  arm:\n";
  for (const document::Entry& entry : arm.entries) {
    const std::string& key = entry.key.scalar;
    const std::string name = key == "origin" && chain ? "base_position" : key;
    if (listed(kSame, key) || key == "origin") text += "    " + name + ": " + flowText(entry.value) + "\n";
  }
  return text;
}

/// Returns the encoder counts per turn of each joint, from the scales of the positions; empty if they cannot be found.
/// Positions that the arm sends as floating-point numbers have no counts.
std::vector<double> countsOf(const Node& parameters) {
  std::vector<double> counts;
  for (const Node& field : below(below(below(parameters, "wire"), "input"), "fields").items) {
    if (below(field, "is").scalar != "position") continue;
    const auto scale = document::toNumber(below(field, "scale").scalar);
    const auto degrees = document::toNumber(below(field, "scale_degrees").scalar);
    const double turn = scale ? 2 * M_PI / std::abs(*scale) : degrees ? 360 / std::abs(*degrees) : 0;
    const auto joint = document::toNumber(below(field, "joint").scalar).value_or(0);
    if (below(field, "type").scalar.starts_with("f")) return {};
    if (!(turn >= 1 && turn <= 1e9) || !(joint >= 1 && joint <= 16)) return {};
    counts.resize(std::max(counts.size(), static_cast<size_t>(joint)), turn);
    counts[static_cast<size_t>(joint) - 1] = turn;
  }
  return counts;
}

constexpr std::array<std::string_view, 4> kCapabilities{"max_force", "continuous_force", "max_stiffness", "mass"};

std::string deviceOf(const Node& device, double rate) {
  std::string text = fmt::format("  device: {{rate: {:g}", rate);
  for (const document::Entry& entry : device.entries)
    if (listed(kCapabilities, entry.key.scalar)) text += ", " + entry.key.scalar + ": " + flowText(entry.value);
  return text + "}\n";
}

/// Returns the world's origin in the device frame, because the scenes have their shapes there.
Eigen::Vector3d originOf(const Node& mount) {
  const std::vector<double> p = numbersOf(mount.find("position"), 3), q = numbersOf(mount.find("orientation"), 4);
  if (p.empty()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d position(p[0], p[1], p[2]);
  if (q.empty()) return -position;
  return -(Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().conjugate() * position);
}

constexpr double kHandBegins = 0.07;  ///< [m] the hand's radius and approach from the world's origin

/// Where the twin stands, and in which direction its hand presses.
struct TwinPose {
  std::string mount, hand;  ///< as YAML, "" if nothing is needed; hand is the text after `center` in the block `hand`
  bool pressing = true;     ///< false: the tip has no straight line along which to press
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
};

std::string listOf(const Eigen::Vector3d& v) {
  // All digits, because the arm's tip must begin on its plane; a remainder of rounding counts as 0.
  const auto digits = [](double x) { return fmt::format("{}", std::abs(x) < 1e-14 ? 0.0 : x); };
  return "[" + digits(v.x()) + ", " + digits(v.y()) + ", " + digits(v.z()) + "]";
}

/// Returns words for a pose, such as "joints at 0.3, -1.2 rad" or "each joint in the middle of arm.limits".
std::string poseOf(const RestPose& rest, bool limits) {
  if (rest.middle) return limits ? "each joint in the middle of arm.limits" : "each joint at 0";
  return fmt::format("joints at {:g} rad", fmt::join(rest.joints, ", "));
}

/// For a flat arm, or one of fewer than three joints: the hand pushes it along its plane, starting exactly where it
/// rests.
TwinPose standOfFlat(const RestPose& rest, const std::string& pose) {
  TwinPose stand;
  stand.center = rest.tip - kHandBegins * rest.push;
  stand.mount = fmt::format(
      "mount: {{position: {}}}    # the arm's file has none: "
      "with {} this puts its tip 7 cm beside the shapes' middle, {}\n",
      listOf(-stand.center), pose, rest.flat ? "in the plane in which it moves" : "in a direction in which it moves");
  stand.pressing = rest.flat;
  stand.hand = ", normal: " + listOf(rest.push);
  return stand;
}

/// [m] Returns how high the tip of a delta is over its base with its arms in the middle of their usual range.
double middleOfDelta(const Node& arm) {
  constexpr double kMiddle = 0.55;  // rad
  std::vector<double> lengths = numbersOf(arm.find("lengths"), 8);
  if (lengths.empty()) lengths = {0.060, 0.1025, 0.01443, 0.01125, 0.01125, -0.025, 0.040, -0.02309};  // a Falcon's
  const double a = lengths[0], b = lengths[1], along = lengths[2] - lengths[6] - a * std::cos(kMiddle);
  const double aside = lengths[5] + lengths[7], reach = lengths[3] + lengths[4] + std::sqrt(b * b - aside * aside);
  return std::sqrt(reach * reach - along * along) + a * std::sin(kMiddle);
}

/// For a delta without a mount: the middle of its reach is 5 cm in front of the shapes' middle, as for the Falcon.
void standOfDelta(const Node& arm, TwinPose& stand) {
  const double high = std::round(middleOfDelta(arm) * 1e3) * 1e-3;
  if (!std::isfinite(high) || arm.find("origin") != nullptr || arm.find("base_orientation") != nullptr) return;
  stand.center = Eigen::Vector3d(0, 0, high - 0.05);
  stand.mount = fmt::format(
      "mount: {{position: [0, 0, {:g}]}}    # the arm's file has none: this puts the middle of its reach 5 cm in front "
      "of the shapes' middle\n",
      -stand.center.z());
}

/// Returns where the twin stands: at the mount of its arm. A chain or a delta without a mount gets one that puts its
/// tip where scenes expect a hand.
TwinPose standOf(const Node& mount, const Node& arm, const std::string& kind) {
  TwinPose stand;
  stand.center = originOf(mount);
  if (mount.isMap()) stand.mount = "mount: " + flowText(mount) + "\n";
  if (!mount.isMap() && kind == "delta") standOfDelta(arm, stand);
  if (mount.isMap() || kind != "chain") return stand;
  const RestPose rest = restPoseOf(arm);
  const std::string pose = poseOf(rest, !below(arm, "limits").items.empty());
  if (rest.freedom < 3) return standOfFlat(rest, pose);
  const auto rounded = [](double v) { return std::round(v * 1e6) * 1e-6 + 0.0; };
  const Eigen::Vector3d at = (Eigen::Vector3d(0, 0, 0.09) - rest.tip).unaryExpr(rounded);
  stand.center = -at;
  stand.mount = fmt::format(
      "mount: {{position: [{:g}, {:g}, {:g}]}}    # the arm's file has none: with {} this puts its tip 9 cm in front "
      "of the shapes\n",
      at.x(), at.y(), at.z(), pose);
  return stand;
}

/// Returns the block `joint`. It has rotors if a chain has more joints than its tip has directions, because without
/// masses a joint that can move while the tip stands still would have no inertia. So has a delta, because nobody
/// publishes the masses of one.
std::string jointOf(const Node& parameters, const Node& arm, const std::string& kind) {
  const std::vector<double> counts = countsOf(parameters);
  const bool spare = kind == "chain" && below(arm, "dh").items.size() > static_cast<size_t>(restPoseOf(arm).freedom);
  std::string text, comment = "without friction and rotors";
  if (!counts.empty()) text += fmt::format("counts: [{:.0f}]", fmt::join(counts, ", "));
  if (spare || kind == "delta") {
    text += std::string(text.empty() ? "" : ", ") + "rotor: [0.0002], damping: [0.005]";
    comment = std::string("kg m^2 and N m s/rad [assumption]") + (spare ? ", as some joints move without the tip" : "");
  }
  if (text.empty()) return "";
  return "  joint: {" + text + "}    # " + (counts.empty() ? "" : "counts of one joint turn, as wire has them; ") +
         comment + "\n";
}

std::string handOf(const TwinPose& stand) {
  if (!stand.pressing) return "hand: {script: none}    # the tip of this arm has no straight line to press along\n";
  return fmt::format(
      "# The hand that holds it, device frame: it presses a sphere of 0.05 m about the world's origin. The arm must\n"
      "# reach there: mount says where it stands, driver/docs/devices.md how to find it.\n"
      "hand: {{script: press, radius: 0.05, rise: 0.003, rate: 1, center: {}{}}}\n"
      "# hapticd device info --parameters FILE lists what else a simulated arm has.\n",
      stand.center.isZero() ? "[0, 0, 0]" : listOf(stand.center), stand.hand);
}

}  // namespace

std::string borrowedByTwin(const Node& root) {
  const Node& device = below(below(root, "parameters"), "device");
  std::vector<std::string_view> lacking;
  for (const std::string_view key : kCapabilities)
    if (below(device, key).isNull()) lacking.push_back(key);
  return lacking.empty() ? ""
                         : fmt::format("parameters.device of this arm has no {}: the twin has those of a Premium 1.5",
                                       fmt::join(lacking, ", "));
}

Result<std::string> twinOf(const Node& root, const std::string& file) {
  static constexpr std::array<std::string_view, 1> kButtons{"enable"};
  const Node &parameters = below(root, "parameters"), &arm = below(parameters, "arm");
  const std::string kind = below(arm, "kind").scalar;
  if (below(root, "module").scalar == "simulated") return Error{file + ": is simulated already"};
  if (kind.empty())
    return Error{file +
                 ": does not describe its mechanism (parameters.arm.kind: phantom, delta or chain), so it has no twin\n"
                 "  fix: try a scene on the simulated arm that ships: it is the arm of a scene without device:"};
  if (kind != "phantom" && kind != "delta" && kind != "chain")
    return Error{file + ": parameters.arm.kind is \"" + kind +
                 "\", expected phantom, delta or chain: the simulated arm has no other mechanism"};
  if (document::toNumber(below(arm, "others").scalar).value_or(0) > 0)
    return Error{file + ": parameters.arm.others: joints that do not carry the tip have no twin"};
  const Node &mount = below(root, "mount"), &limits = below(root, "limits");
  const double rate = document::toNumber(below(below(parameters, "wire"), "rate").scalar).value_or(1000);
  const TwinPose stand = standOf(mount, arm, kind);
  std::string text = fmt::format(
      "# A simulated arm with the mechanism of {}, written by `hapticd device twin`; it needs no hardware.\n"
      "hapticd-device: 1\nmodule: simulated\nname: twin of {}\n",
      file, below(root, "name").scalar);
  text += stand.mount;
  if (limits.isMap())
    text += "limits: " + flowWithout(limits, kButtons) +
            (below(limits, "enable").isNull() ? "\n" : "    # without enable: it has no buttons\n");
  text += "parameters:\n  substep: 0.0002               # s, of the integration\n";
  if (const std::string borrowed = borrowedByTwin(root); !borrowed.empty()) text += "  # " + borrowed + "\n";
  text +=
      deviceOf(below(parameters, "device"), rate) + armOfTwin(arm, kind == "chain") + jointOf(parameters, arm, kind);
  return text + handOf(stand);
}

}  // namespace hapticd::diagnostics
