// SPDX-License-Identifier: MIT
#include "diagnostics/device_twin.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

namespace hapticd::diagnostics {
namespace {

using document::Node;
using document::toJson;

const Node kNothing{};

const Node& below(const Node& node, std::string_view key) {
  const Node* found = node.isMap() ? node.find(key) : nullptr;
  return found != nullptr ? *found : kNothing;
}

template <size_t N>
bool listed(const std::array<std::string_view, N>& keys, const std::string& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// A map without some of its keys, in one line of YAML.
template <size_t N>
std::string jsonWithout(Node map, const std::array<std::string_view, N>& keys) {
  std::erase_if(map.entries, [&](const document::Entry& entry) { return listed(keys, entry.key.scalar); });
  return toJson(map);
}

std::vector<double> numbersOf(const Node& list, size_t count) {
  std::vector<double> numbers;
  for (const Node& item : list.items) numbers.push_back(document::toNumber(item.scalar).value_or(NAN));
  return numbers.size() == count ? numbers : std::vector<double>();
}

/// The block `arm`. What the simulated arm calls otherwise, or does not have, is told apart.
std::string armOfTwin(const Node& arm, bool chain) {
  static constexpr std::array<std::string_view, 9> kSame{
      "kind", "lengths", "masses", "limits", "max_torque", "dh", "centers", "base_orientation", "tool_position"};
  std::string text = "  arm:\n";
  for (const document::Entry& entry : arm.entries) {
    const std::string& key = entry.key.scalar;
    const std::string name = key == "origin" && chain ? "base_position" : key;
    if (listed(kSame, key) || key == "origin") text += "    " + name + ": " + toJson(entry.value) + "\n";
  }
  return text;
}

/// Encoder counts of one turn of each joint, as the scales of the positions say; "" where they do not.
std::string countsOf(const Node& parameters) {
  std::vector<double> counts;
  for (const Node& field : below(below(below(parameters, "wire"), "input"), "fields").items) {
    if (below(field, "is").scalar != "position") continue;
    const auto scale = document::toNumber(below(field, "scale").scalar);
    const auto degrees = document::toNumber(below(field, "scale_degrees").scalar);
    const double turn = scale ? 2 * M_PI / std::abs(*scale) : degrees ? 360 / std::abs(*degrees) : 0;
    const auto joint = document::toNumber(below(field, "joint").scalar).value_or(0);
    if (!(turn >= 1 && turn <= 1e9) || !(joint >= 1 && joint <= 16)) return "";
    counts.resize(std::max(counts.size(), static_cast<size_t>(joint)), turn);
    counts[static_cast<size_t>(joint) - 1] = turn;
  }
  if (counts.empty()) return "";
  return fmt::format(
      "  joint: {{counts: [{:.0f}]}}    # of one joint turn, as wire has them; without friction and rotors\n",
      fmt::join(counts, ", "));
}

constexpr std::array<std::string_view, 4> kCapabilities{"max_force", "continuous_force", "max_stiffness", "mass"};

std::string deviceOf(const Node& device, double rate) {
  std::string text = fmt::format("  device: {{rate: {:g}", rate);
  for (const document::Entry& entry : device.entries)
    if (listed(kCapabilities, entry.key.scalar)) text += ", " + entry.key.scalar + ": " + toJson(entry.value);
  return text + "}\n";
}

/// The world's origin in the device frame, where the scenes have their shapes.
Eigen::Vector3d originOf(const Node& mount) {
  const std::vector<double> p = numbersOf(below(mount, "position"), 3), q = numbersOf(below(mount, "orientation"), 4);
  if (p.empty()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d position(p[0], p[1], p[2]);
  if (q.empty()) return -position;
  return -(Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().conjugate() * position);
}

/// Tip of a chain in the middle of its limits, device frame (standard Denavit-Hartenberg): there it begins.
Eigen::Vector3d restOf(const Node& arm) {
  const auto vectorAt = [&arm](std::string_view key) {
    const std::vector<double> p = numbersOf(below(arm, key), 3);
    return p.empty() ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(p[0], p[1], p[2]);
  };
  Eigen::Isometry3d frame(Eigen::Translation3d(vectorAt("origin")));
  if (const std::vector<double> q = numbersOf(below(arm, "base_orientation"), 4); !q.empty())
    frame.rotate(Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized());
  const std::vector<Node>&rows = below(arm, "dh").items, &limits = below(arm, "limits").items;
  for (size_t i = 0; i < rows.size(); ++i) {
    const std::vector<double> row = numbersOf(rows[i], 4);
    const std::vector<double> limit = i < limits.size() ? numbersOf(limits[i], 2) : std::vector<double>();
    if (row.empty()) continue;
    const double joint = limit.empty() ? 0 : (limit[0] + limit[1]) / 2;
    frame.rotate(Eigen::AngleAxisd(row[3] + joint, Eigen::Vector3d::UnitZ()));
    frame.translate(Eigen::Vector3d(row[0], 0, row[2]));
    frame.rotate(Eigen::AngleAxisd(row[1], Eigen::Vector3d::UnitX()));
  }
  return frame * vectorAt("tool_position");
}

/// Where the twin stands: as its arm does, or, of a chain that does not say, with its tip where scenes expect a hand.
std::string mountOf(const Node& mount, const Node& arm, bool chain, Eigen::Vector3d& center) {
  center = originOf(mount);
  if (mount.isMap()) return "mount: " + toJson(mount) + "\n";
  if (!chain) return "";
  const auto rounded = [](double v) { return std::round(v * 1e6) * 1e-6 + 0.0; };
  const Eigen::Vector3d at = (Eigen::Vector3d(0, 0, 0.09) - restOf(arm)).unaryExpr(rounded);
  center = -at;
  return fmt::format(
      "mount: {{position: [{:g}, {:g}, {:g}]}}    # the arm's file has none: this puts its tip in the middle of "
      "arm.limits "
      "9 cm in front of the shapes\n",
      at.x(), at.y(), at.z());
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
  if (kind != "phantom" && kind != "chain")
    return Error{file + ": parameters.arm.kind is \"" + kind +
                 "\", expected phantom or chain: the simulated arm has no other mechanism"};
  if (document::toNumber(below(arm, "others").scalar).value_or(0) > 0)
    return Error{file + ": parameters.arm.others: joints that do not carry the tip have no twin"};
  const Node &mount = below(root, "mount"), &limits = below(root, "limits");
  const double rate = document::toNumber(below(below(parameters, "wire"), "rate").scalar).value_or(1000);
  Eigen::Vector3d center;
  const std::string stands = mountOf(mount, arm, kind == "chain", center);
  const auto zero = [](double v) { return v == 0 ? 0 : v; };  // no "-0"
  std::string text = fmt::format(
      "# A simulated arm with the mechanism of {}, written by `hapticd device twin`; it needs no hardware.\n"
      "hapticd-device: 1\nmodule: simulated\nname: twin of {}\n",
      file, below(root, "name").scalar);
  text += stands;
  if (limits.isMap())
    text += "limits: " + jsonWithout(limits, kButtons) +
            (below(limits, "enable").isNull() ? "\n" : "    # without enable: it has no buttons\n");
  text += "parameters:\n  substep: 0.0002               # s, of the integration\n";
  if (const std::string borrowed = borrowedByTwin(root); !borrowed.empty()) text += "  # " + borrowed + "\n";
  text += deviceOf(below(parameters, "device"), rate) + armOfTwin(arm, kind == "chain") + countsOf(parameters);
  return text + fmt::format(
                    "# The hand that holds it, device frame: it presses a sphere of 0.05 m about the world's origin. "
                    "The arm must\n"
                    "# reach there: mount says where it stands, driver/docs/devices.md how to find it.\n"
                    "hand: {{script: press, radius: 0.05, rise: 0.003, rate: 1, center: [{:g}, {:g}, {:g}]}}\n"
                    "# hapticd device info --parameters FILE lists what else a simulated arm has.\n",
                    zero(center.x()), zero(center.y()), zero(center.z()));
}

}  // namespace hapticd::diagnostics
