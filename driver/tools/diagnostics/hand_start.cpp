// SPDX-License-Identifier: MIT
#include "diagnostics/hand_start.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "diagnostics/limit_advice.hpp"
#include "host/child.hpp"
#include "host/device_instance.hpp"
#include "host/wire.hpp"
#include "servo/loop/lockstep.hpp"
#include "world/world.hpp"

namespace hapticd::diagnostics {
namespace {

constexpr size_t kMostModels = 100;  ///< more take long to set up a second time
constexpr int kHandLimitMs = 60'000;

/// Joints at the first tick.
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

/// The tip in the world.
std::optional<servo::Probe> tipOf(const scene::Scene& scene, const scene::Device& device) {
  auto arm = host::DeviceInstance::create(device, nullptr);
  if (!arm) return std::nullopt;
  const auto q = firstJoints(scene, device, **arm);
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  std::array<double, 4> turn{};
  if (!q || (*arm)->kinematics().forward((*arm)->handle(), q->data(), tip.data(), turn.data()) < 0) return std::nullopt;
  servo::Probe probe;
  probe.valid = tip.allFinite();
  probe.position = device.mount.position + device.mount.orientation * tip;
  probe.orientation = (device.mount.orientation * Eigen::Quaterniond(turn[0], turn[1], turn[2], turn[3])).normalized();
  return probe.valid ? std::optional(probe) : std::nullopt;
}

/// Model, place of the tip and depth, packed: how they travel from the child.
std::string tryTips(const scene::Scene& scene) {
  std::vector<servo::Probe> tips;
  for (const scene::Device& device : scene.devices)
    if (const auto tip = tipOf(scene, device)) tips.push_back(*tip);
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
  for (uint32_t model = 0; model < scene.models.size(); ++model)
    for (uint32_t tip = 0; tip < tips.size(); ++tip) {
      const servo::Contact& contact = core.contact(model, tip);
      if (!contact.traced || !(contact.world.depth_m > 0)) continue;
      found.number(model);
      for (int i = 0; i < 3; ++i) found.number(tips[tip].position[i]);
      found.number(contact.world.depth_m);
    }
  return found.take();
}

/// Where the file says what the hand wants.
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
  if (!arm) return "=";  // told by who reads the device file
  if (const auto opened = (*arm)->open(); !opened) return opened.error();
  const auto started = (*arm)->start(how);
  return started ? "=" : started.error();
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

document::Problems startsInside(const scene::Scene& scene) {
  document::Problems warnings;
  if (scene.models.empty() || scene.models.size() > kMostModels || scene.devices.empty()) return warnings;
  const auto told = host::runInChild([&] { return tryTips(scene); }, kHandLimitMs);
  if (!told) return warnings;  // a model that crashes is told by who tried it alone
  host::Unpacker in(*told);
  for (uint32_t model = in.count(); in.good() && model < scene.models.size(); model = in.count()) {
    const double x = in.real(), y = in.real(), z = in.real(), depth = in.real();
    if (!in.good()) break;
    document::report(warnings, scene.models[model].place, fmt::format("models[{}].pose", model),
                     fmt::format("the hand starts inside {}: at [{:.4g}, {:.4g}, {:.4g}] the tip is {:.3g} mm deep; "
                                 "expected it outside: move the model, the arm (mount) or the hand (hand)",
                                 scene.models[model].name, x, y, z, depth * 1e3));
  }
  return warnings;
}

}  // namespace hapticd::diagnostics
