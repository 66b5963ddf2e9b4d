// SPDX-License-Identifier: MIT
#include "diagnostics/hand/hand_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "diagnostics/device/arm_reach.hpp"
#include "diagnostics/device/rest_joints.hpp"
#include "diagnostics/hand/fast_hands.hpp"
#include "diagnostics/hand/hand_inside.hpp"
#include "diagnostics/hand/hand_script.hpp"
#include "diagnostics/hand/radius_advice.hpp"
#include "diagnostics/hand/walk_warnings.hpp"
#include "diagnostics/reading/key_place.hpp"
#include "diagnostics/scene/nearest_model.hpp"
#include "diagnostics/scene/overlapping_models.hpp"
#include "diagnostics/scene/trial_end.hpp"
#include "diagnostics/scene/unreachable_models.hpp"
#include "host/child.hpp"
#include "host/device_instance.hpp"
#include "host/wire.hpp"
#include "scene/load.hpp"
#include "servo/arm/arm.hpp"
#include "servo/loop/lockstep.hpp"
#include "world/arm_force.hpp"
#include "world/world.hpp"

namespace hapticd::diagnostics {
namespace {

constexpr size_t kMostModels = 100;  ///< more models take too long to set up a second time
constexpr int kHandLimitMs = 60'000;

/// Returns the joints of an arm at the first tick.
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
  uint32_t device = 0;  ///< index of the arm in the scene
  servo::Probe probe;   ///< tip of the arm in the world frame
  double reach = 0;     ///< [m] how far the joints can move the tip from its place at the first tick
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

/// Finds the tips that are inside a model, and what hints at the cause.
std::vector<InsideTip> tipsInside(const scene::Scene& scene, const servo::World& world, const servo::Core& core,
                                  const std::vector<Hand>& hands) {
  std::vector<InsideTip> all;
  for (uint32_t model = 0; model < scene.models.size(); ++model)
    for (uint32_t tip = 0; tip < hands.size(); ++tip) {
      const servo::Contact& contact = core.contact(model, tip);
      if (!contact.traced || !(contact.world.depth_m > 0)) continue;
      const scene::Device& device = scene.devices[hands[tip].device];
      const host::ShapeInstance& shape = *world.shapes()[model];
      InsideTip inside{model, hands[tip].device, hands[tip].probe.position, contact.world.depth_m};
      Eigen::AlignedBox3d box;
      if (shape.bounds(box.min().data(), box.max().data()))
        inside.beyond_box = inside.depth > ballOf(scene.models[model]) &&
                            !box.contains(core.models()[model].frame.pointToModel(inside.tip));
      const auto hand = handScriptOf(device);
      constexpr double kAbout = 0.3;  // [m] a hand does not go round a larger model
      inside.round = hand && hand->moves() && hand->radius + inside.depth < kAbout &&
                     hand->kind != HandScript::Kind::kPath && circlesModel(device, *hand, scene.models[model], shape);
      if (inside.round) inside.radius = radiusOfInnerHand(scene, hands[tip].device, *hand, inside.depth);
      all.push_back(inside);
    }
  return all;
}

/// Packs arm, nearest model, distance and reach of each arm that can reach no model. @return how many there are
uint32_t packFar(const scene::Scene& scene, const servo::World& world, servo::Core& core,
                 const std::vector<Hand>& hands, host::Packer& found) {
  constexpr double kRoom = 1.1, kLittle = 0.05;  // factor, because not all poses were tried; [m]
  uint32_t count = 0;
  host::Packer list;
  for (uint32_t i = 0; i < hands.size(); ++i) {
    const auto nearest = nearestModel(scene, world, core, hands[i].probe.position, i);
    if (!nearest || nearest->away <= kRoom * hands[i].reach + kLittle) continue;
    ++count;
    list.number(hands[i].device);
    list.number(static_cast<uint32_t>(nearest->index));
    for (int axis = 0; axis < 3; ++axis) list.number(hands[i].probe.position[axis]);
    list.number(nearest->away);
    list.number(hands[i].reach);
  }
  found.number(count);
  found.text(list.take());
  return count;
}

/// A key that says where an arm stands, and its place in a file.
struct MountKey {
  document::Place place;
  std::string key;
};

/// Returns the key of an arm's mount in the scene or, if it is not there, in the device file.
std::optional<MountKey> mountOf(const scene::Scene& scene, uint32_t device) {
  for (const std::string& where : {std::string("device"), fmt::format("devices[{}]", device)})
    for (const char* id : {".mount.position", ".mount"})
      if (const auto place = placeOfKey(scene.file, where + id)) return MountKey{*place, where + id};
  for (const char* id : {"mount.position", "mount"})
    if (const auto place = placeOfKey(scene.devices[device].file, id)) return MountKey{*place, id};
  return std::nullopt;
}

/// Returns where to report that an arm and its nearest model are far apart: at the one that is farther from the origin.
MountKey keyOfFar(const scene::Scene& scene, uint32_t device, uint32_t model, const Eigen::Vector3d& tip) {
  const std::string key = fmt::format("models[{}].pose.position", model);
  const scene::Model& nearest = scene.models[model];
  const auto mount = mountOf(scene, device);
  if (mount && tip.norm() > nearest.pose.position.norm()) return *mount;
  return {placeInModel(nearest, key), key};
}

/// Warns of a real arm whose tip rests far away from all models, though the arm can reach one. Arms whose file gives no
/// pose at rest are not judged. The hand of a simulated
/// arm shows by itself what it meets.
void reportFarRest(const scene::Scene& scene, const servo::World& world, servo::Core& core,
                   const std::vector<Hand>& hands, document::Problems& warnings) {
  constexpr double kAway = 0.3;  // [m] a reach of the hand
  for (uint32_t i = 0; i < hands.size(); ++i) {
    const scene::Device& device = scene.devices[hands[i].device];
    const auto nearest = nearestModel(scene, world, core, hands[i].probe.position, i);
    const scene::Value* pose = givenIn(device.parameters, "calibration.pose");
    if (pose == nullptr || device.module == "simulated" || !nearest || nearest->away <= kAway) continue;
    const MountKey at =
        keyOfFar(scene, hands[i].device, static_cast<uint32_t>(nearest->index), hands[i].probe.position);
    const Eigen::Vector3d& tip = hands[i].probe.position;
    document::report(
        warnings, at.place, at.key,
        fmt::format("{} rests with its tip at [{:.3g}, {:.3g}, {:.3g}] m of the world, {:.2g} m away from "
                    "{}, the nearest model; is a sign or a decimal point wrong? move the arm "
                    "(mount.position, in m) or the models (pose.position)",
                    device.name, tip.x(), tip.y(), tip.z(), nearest->away, scene.models[nearest->index].name));
  }
}

void packProblems(const document::Problems& problems, host::Packer& found) {
  for (const document::Problem& one : problems) {
    for (const std::string* text : {&one.place.file, &one.key, &one.what}) found.text(*text);
    found.number(static_cast<uint32_t>(one.place.line));
    found.number(static_cast<uint32_t>(one.place.column));
  }
}

document::Problems readProblems(host::Unpacker& in) {
  document::Problems problems;
  for (;;) {
    document::Problem one;
    for (std::string* text : {&one.place.file, &one.key, &one.what}) *text = in.text();
    one.place.line = static_cast<int>(in.count());
    one.place.column = static_cast<int>(in.count());
    if (!in.good()) return problems;
    problems.push_back(std::move(one));
  }
}

/// Lets all models answer the tips once, if there are any.
void tickOnce(servo::World& world, const std::vector<servo::Probe>& tips) {
  if (tips.empty()) return;
  servo::Lockstep lockstep = world.lockstep();
  const StepWatch watch;
  world.core().publish(0, tips);
  lockstep.before(0);
  world.core().tick(0, 0, tips);
}

std::string tryTips(const scene::Scene& scene, bool may_walk, const std::vector<bool>& strays, bool all_models) {
  std::vector<Hand> hands;
  std::vector<servo::Probe> tips;
  for (uint32_t device = 0; device < scene.devices.size(); ++device)
    if (const auto hand = handOf(scene, device)) hands.push_back(*hand), tips.push_back(hand->probe);
  host::Packer found;
  const servo::WorldOptions options{.rate = scene.servo.rate,
                                    .probe_count = std::max<uint32_t>(static_cast<uint32_t>(tips.size()), 1),
                                    .measure = true,
                                    .max_force = servo::maxForceOf(scene),
                                    .keep_disabled = true};
  auto world = servo::World::build(scene, options, [](int, const std::string&, const std::string&) {});
  if (!world) return found.take();
  const bool placed = !tips.empty() && tips.size() == scene.devices.size();
  servo::Core& core = (*world)->core();
  tickOnce(**world, tips);
  document::Problems warnings;
  const std::vector<InsideTip> inside =
      tips.empty() ? std::vector<InsideTip>{} : tipsInside(scene, **world, core, hands);
  for (const InsideTip& one : inside) reportInside(scene, one, warnings);
  const uint32_t far = packFar(scene, **world, core, hands, found);
  std::vector<TipReach> reaches;
  for (const Hand& hand : hands) reaches.push_back({hand.probe.position, hand.reach});
  if (far == 0) reportFarRest(scene, **world, core, hands, warnings);
  packProblems(warnings, found);
  if (far == 0 && placed) packProblems(unreachableModels(scene, **world, core, reaches), found);
  const document::Problems enclosed = enclosedModels(scene, **world);
  packProblems(enclosed, found);
  if (enclosed.empty()) packProblems(overlappingModels(scene, **world), found);
  // The hands run their scripts only if they start in the right place, because other warnings would follow from a wrong
  // start.
  if (inside.empty() && far == 0 && may_walk && placed)
    packProblems(warnOfWalk(scene, **world, strays, all_models), found);
  letThreadsRun();
  return found.take();
}

/// Returns the place of a key of the hand. Keys in the scene come before keys in the device file.
document::Place placeOfHand(const scene::Device& device) {
  for (const bool in_scene : {true, false})
    for (const char* id : {"hand.path", "hand.center", "hand.radius", "hand.script", "hand.normal", "hand.axis"})
      if (const scene::Value* value = givenIn(device.parameters, id);
          value != nullptr && in_scene == (value->place.file != device.file.string()))
        return value->place;
  return device.place;
}

/// Makes the same calls as `run`. Returns "=", or why `run` would refuse the arm.
std::string tryStart(const scene::Scene& scene, const scene::Device& device, bool needs_velocity) {
  scene::Servo servo = scene.servo;
  servo.velocity = {};  // refusedVelocity() judges it
  auto arm = servo::Arm::open(device, servo, {servo.rate, needs_velocity, nullptr, scene.clients}, nullptr);
  if (!arm) return arm.error();
  const auto started = (*arm)->start(0, servo.gravity);
  (*arm)->stop();
  return started ? "=" : started.error();
}

/// Reports a refusal at the place of the key that it names. The key stands at the beginning, or after the name of
/// the device and what failed: "device 'name': cannot be opened: hand.axis is zero, expected a direction".
void reportRefused(const scene::Scene& scene, const scene::Device& device, const std::string& told,
                   document::Problems& problems) {
  const std::string before = "device '" + device.name + "': ";
  size_t begin = told.rfind(before, 0) == 0 ? before.size() : told.size();
  while (begin < told.size()) {
    const size_t end = std::min(told.find_first_of(": ", begin), told.size());
    const std::string key = told.substr(begin, end - begin);
    const std::string what = told.substr(std::min(told.find_first_not_of(": ", end), told.size()));
    if (const scene::Value* value = givenIn(device.parameters, key))
      return document::report(problems, value->place, key.starts_with("hand.") ? key : "parameters." + key, what);
    for (const std::string& one : {"device." + key, fmt::format("devices[{}].{}", &device - scene.devices.data(), key)})
      if (const auto place = placeOfKey(scene.file, one)) return document::report(problems, *place, one, what);
    for (const auto& file : {device.file, scene.file})
      if (const auto place = placeOfKey(file, key)) return document::report(problems, *place, key, what);
    const size_t next = told.find(": ", begin);
    begin = next == std::string::npos ? told.size() : next + 2;
  }
  document::report(problems, placeOfHand(device), "hand", told.substr(told.rfind(before, 0) == 0 ? before.size() : 0));
}

void reportFar(const scene::Scene& scene, const std::string& list, uint32_t count, document::Problems& warnings) {
  host::Unpacker in(list);
  for (; count > 0; --count) {
    const uint32_t device = in.count();
    const uint32_t model = in.count();
    Eigen::Vector3d tip;
    for (double& x : tip) x = in.real();
    const double away = in.real(), reach = in.real();
    if (!in.good() || device >= scene.devices.size() || model >= scene.models.size()) break;
    const MountKey at = keyOfFar(scene, device, model, tip);
    document::report(
        warnings, at.place, at.key,
        fmt::format("{} is the model nearest to {}, but {:.3g} m away from its tip, which is at [{:.3g}, "
                    "{:.3g}, {:.3g}] and can move only {:.3g} m from there, so no model can be felt; move "
                    "the models (pose.position, in m) or the arm (mount.position)",
                    scene.models[model].name, scene.devices[device].name, away, tip.x(), tip.y(), tip.z(), reach));
  }
}

}  // namespace

document::Problems refusedArms(const scene::Scene& scene, bool needs_velocity) {
  document::Problems problems;
  for (const scene::Device& device : scene.devices) {
    if (device.module != "simulated") continue;
    const auto told = host::runInChild([&] { return tryStart(scene, device, needs_velocity); }, kHandLimitMs);
    if (told && *told != "=") reportRefused(scene, device, *told, problems);
  }
  return problems;
}

document::Problems refusedAlone(const std::filesystem::path& file, host::Catalog& catalog,
                                document::Problems& warnings) {
  const scene::LoadedDevice loaded = scene::loadDevice(file, catalog);
  if (!loaded.device) return {};
  scene::Scene alone;
  alone.file = file;
  alone.devices.push_back(*loaded.device);
  document::Problems problems = refusedArms(alone, false);
  const auto& given = loaded.device->parameters;
  const bool own_hand =
      std::any_of(given.begin(), given.end(), [](const scene::Value& value) { return value.id.starts_with("hand."); });
  if (!own_hand)  // a scene gives the arm a hand, so what is wrong with the default one does not matter
    std::erase_if(problems, [](const document::Problem& one) { return one.key.starts_with("hand"); });
  document::append(warnings, fastHands(alone));
  return problems;
}

namespace {

/// Returns true if the hands of a scene move as their scripts say, at most too often. @param warnings of fastHands()
bool moveAsMeant(const scene::Scene& scene, const document::Problems& warnings) {
  const auto hasty = [](const scene::Device& device) {
    const auto hand = handScriptOf(device);
    return hand && hand->speed() > kFastestHand;
  };
  return std::all_of(warnings.begin(), warnings.end(),
                     [](const document::Problem& one) { return one.key == "hand.rate"; }) &&
         std::none_of(scene.devices.begin(), scene.devices.end(), hasty);
}

}  // namespace

document::Problems warnOfHands(const scene::Scene& scene, const std::vector<bool>& strays, bool all_models,
                               bool known) {
  document::Problems warnings;
  if (scene.models.empty() || scene.models.size() > kMostModels) return warnings;
  if (known) warnings = fastHands(scene);
  const bool may_walk = known && moveAsMeant(scene, warnings);
  host::ChildProgress trail;
  const auto work = [&] {
    noteEnd(scene, trail);
    return tryTips(scene, may_walk, strays, all_models);
  };
  const auto told = host::runInChild(work, kHandLimitMs, {&trail, kStepLimitMs, {}});
  if (!told) {
    reportWalkEnd(scene, told.error(), trail, warnings);
    return warnings;
  }
  host::Unpacker in(*told);
  const uint32_t far = in.count();
  const std::string far_arms = in.text();
  if (all_models) reportFar(scene, far_arms, far, warnings);
  document::append(warnings, readProblems(in));
  return warnings;
}

}  // namespace hapticd::diagnostics
