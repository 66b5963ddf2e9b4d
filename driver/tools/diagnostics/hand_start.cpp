// SPDX-License-Identifier: MIT
#include "diagnostics/hand_start.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "diagnostics/arm_reach.hpp"
#include "diagnostics/limit_advice.hpp"
#include "host/child.hpp"
#include "host/device_instance.hpp"
#include "host/wire.hpp"
#include "servo/loop/lockstep.hpp"
#include "world/world.hpp"

namespace hapticd::diagnostics {
namespace {

constexpr size_t kMostModels = 100;  ///< more models take too long to set up a second time
constexpr int kHandLimitMs = 60'000;

/// The joints at the first tick.
std::optional<std::array<double, HDV_MAX_JOINTS>> firstJoints(const scene::Scene& scene, const scene::Device& device,
                                                              host::DeviceInstance& arm) {
  if (device.module != "simulated") {
    document::Problems unread;
    const auto root = document::parseFile(device.file, unread);
    return root ? std::optional(restJoints(*root, arm.kinematics().joint_count)) : std::nullopt;
  }
  hdv_start how{};
  how.struct_size = sizeof how;
  how.rate_hz = scene.servo.rate;
  hdv_sample sample{};
  if (!arm.open() || !arm.start(how) || arm.read(0, sample) < 0) return std::nullopt;
  std::array<double, HDV_MAX_JOINTS> q{};
  std::copy(sample.position, sample.position + arm.kinematics().joint_count, q.begin());
  return q;
}

/// One arm at the first tick.
struct Hand {
  uint32_t device = 0;  ///< of the scene
  servo::Probe probe;   ///< its tip in the world
  double reach = 0;     ///< [m] that its joints can bring the tip away from there
};

std::optional<Hand> handOf(const scene::Scene& scene, uint32_t index) {
  const scene::Device& device = scene.devices[index];
  auto arm = host::DeviceInstance::create(device, nullptr);
  if (!arm) return std::nullopt;
  const auto q = firstJoints(scene, device, **arm);
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  std::array<double, 4> turn{};
  if (!q || (*arm)->kinematics().forward((*arm)->handle(), q->data(), tip.data(), turn.data()) < 0) return std::nullopt;
  if (!tip.allFinite()) return std::nullopt;
  Hand hand{index, {}, reachOf(device, **arm, tip)};
  hand.probe.valid = true;
  hand.probe.position = device.mount.position + device.mount.orientation * tip;
  hand.probe.orientation =
      (device.mount.orientation * Eigen::Quaterniond(turn[0], turn[1], turn[2], turn[3])).normalized();
  return hand;
}

/// Model, place of the tip and depth, packed so that they can come from the child.
void packInside(uint32_t models, const servo::Core& core, const std::vector<servo::Probe>& tips, host::Packer& found) {
  uint32_t count = 0;
  host::Packer list;
  for (uint32_t model = 0; model < models; ++model)
    for (uint32_t tip = 0; tip < tips.size(); ++tip) {
      const servo::Contact& contact = core.contact(model, tip);
      if (!contact.traced || !(contact.world.depth_m > 0)) continue;
      ++count;
      list.number(model);
      for (int i = 0; i < 3; ++i) list.number(tips[tip].position[i]);
      list.number(contact.world.depth_m);
    }
  found.number(count);
  found.text(list.take());
}

/// Arm, model, distance and reach of each arm to which no model is near enough, packed.
void packFar(const scene::Scene& scene, const servo::World& world, servo::Core& core, const std::vector<Hand>& hands,
             host::Packer& found) {
  constexpr double kRoom = 1.1, kLittle = 0.05;  // only some of the poses were tried; [m]
  for (uint32_t i = 0; i < hands.size(); ++i) {
    const auto nearest = nearestModel(scene, world, core, hands[i].probe.position, i);
    if (!nearest || nearest->away <= kRoom * hands[i].reach + kLittle) continue;
    found.number(hands[i].device);
    found.number(static_cast<uint32_t>(nearest->index));
    for (int axis = 0; axis < 3; ++axis) found.number(hands[i].probe.position[axis]);
    found.number(nearest->away);
    found.number(hands[i].reach);
  }
}

std::string tryTips(const scene::Scene& scene) {
  std::vector<Hand> hands;
  std::vector<servo::Probe> tips;
  for (uint32_t device = 0; device < scene.devices.size(); ++device)
    if (const auto hand = handOf(scene, device)) hands.push_back(*hand), tips.push_back(hand->probe);
  host::Packer found;
  if (tips.empty()) return found.take();
  const servo::WorldOptions options{.rate = scene.servo.rate, .probe_count = static_cast<uint32_t>(tips.size())};
  auto world = servo::World::build(scene, options, [](int, const std::string&, const std::string&) {});
  if (!world) return found.take();
  servo::Core& core = (*world)->core();
  servo::Lockstep lockstep = (*world)->lockstep();
  core.publish(0, tips);
  lockstep.before(0);
  core.tick(0, 0, tips);
  packInside(static_cast<uint32_t>(scene.models.size()), core, tips, found);
  packFar(scene, **world, core, hands, found);
  return found.take();
}

/// The place where the file says what the hand wants.
document::Place placeOfHand(const scene::Device& device) {
  for (const char* id : {"hand.path", "hand.center", "hand.radius", "hand.script"})
    for (const scene::Value& value : device.parameters)
      if (value.id == id) return value.place;
  return device.place;
}

/// "=", or why the arm cannot begin where its hand does.
std::string tryStart(const scene::Scene& scene, const scene::Device& device) {
  auto arm = host::DeviceInstance::create(device, nullptr);
  hdv_start how{};
  how.struct_size = sizeof how;
  how.rate_hz = scene.servo.rate;
  if (!arm) return "=";  // the reader of the device file reports it
  if (const auto opened = (*arm)->open(); !opened) return opened.error();
  const auto started = (*arm)->start(how);
  return started ? "=" : started.error();
}

void tellInside(const scene::Scene& scene, const std::string& list, uint32_t count, document::Problems& warnings) {
  host::Unpacker in(list);
  for (; count > 0; --count) {
    const uint32_t model = in.count();
    const double x = in.real(), y = in.real(), z = in.real(), depth = in.real();
    if (!in.good() || model >= scene.models.size()) break;
    document::report(warnings, scene.models[model].place, fmt::format("models[{}].pose", model),
                     fmt::format("the hand starts inside {}: at [{:.4g}, {:.4g}, {:.4g}] the tip is {:.3g} mm deep; "
                                 "expected it outside: move the model, the arm (mount) or the hand (hand)",
                                 scene.models[model].name, x, y, z, depth * 1e3));
  }
}

void tellFar(const scene::Scene& scene, host::Unpacker& in, document::Problems& warnings) {
  for (uint32_t device = in.count(); in.good() && device < scene.devices.size(); device = in.count()) {
    const uint32_t model = in.count();
    const double x = in.real(), y = in.real(), z = in.real(), away = in.real(), reach = in.real();
    if (!in.good() || model >= scene.models.size()) break;
    document::report(warnings, scene.models[model].place, fmt::format("models[{}].pose.position", model),
                     fmt::format("{} is the model nearest to {}, and {:.3g} m away from its tip, which is at [{:.3g}, "
                                 "{:.3g}, {:.3g}] and reaches {:.3g} m from there: no model can be felt; expected them "
                                 "together: move the models (pose.position, in m) or the arm (mount.position)",
                                 scene.models[model].name, scene.devices[device].name, away, x, y, z, reach));
  }
}

}  // namespace

document::Problems unreachableHands(const scene::Scene& scene) {
  document::Problems problems;
  for (const scene::Device& device : scene.devices) {
    if (device.module != "simulated") continue;
    const auto told = host::runInChild([&] { return tryStart(scene, device); }, kHandLimitMs);
    if (told && *told != "=") document::report(problems, placeOfHand(device), "hand", *told);
  }
  return problems;
}

document::Problems adviseHands(const scene::Scene& scene) {
  document::Problems warnings;
  if (scene.models.empty() || scene.models.size() > kMostModels || scene.devices.empty()) return warnings;
  const auto told = host::runInChild([&] { return tryTips(scene); }, kHandLimitMs);
  if (!told) return warnings;  // whoever tried the model alone reports a crash
  host::Unpacker in(*told);
  const uint32_t count = in.count();
  const std::string list = in.text();
  tellInside(scene, list, count, warnings);
  tellFar(scene, in, warnings);
  return warnings;
}

}  // namespace hapticd::diagnostics
