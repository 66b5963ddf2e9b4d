// SPDX-License-Identifier: MIT
#include "diagnostics/hand/walk_warnings.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "base/shell_word.hpp"
#include "diagnostics/hand/detent_warnings.hpp"
#include "diagnostics/hand/hand_inside.hpp"
#include "diagnostics/hand/hand_script.hpp"
#include "diagnostics/hand/hand_walk.hpp"
#include "diagnostics/hand/radius_advice.hpp"
#include "diagnostics/hand/swing_warnings.hpp"
#include "diagnostics/reading/key_place.hpp"
#include "diagnostics/scene/trial_end.hpp"

namespace hapticd::diagnostics {
namespace {

constexpr double kContactSeconds = 0.02;  ///< [s] a shorter contact is not judged

/// Returns a spring of the hand that is so soft that the hand need not come where its script aims; nullptr if it is
/// not.
const scene::Value* softSpring(const scene::Device& device) {
  constexpr double kSoft = 50;  // [N/m]
  const scene::Value* spring = givenIn(device.parameters, "hand.stiffness");
  return spring != nullptr && spring->number < kSoft ? spring : nullptr;
}

/// Returns the advice for a hand that aims at no model: a larger radius, if the hand meets a model with it; another
/// normal if the hand moves along it, but not to the model. @param middle of the nearest model, in the world
std::string adviceOf(const scene::Scene& scene, uint32_t index, const HandScript& hand, const WalkedArm& seen,
                     const Eigen::Vector3d& middle) {
  constexpr double kTowards = 0.9;  // cosine
  const scene::Device& device = scene.devices[index];
  if (seen.away <= 0) return "";
  if (const auto radius = radiusOfFarHand(scene, index, hand, seen.away, false))
    return fmt::format(", or give a hand.radius of {:.4g} m", *radius);
  const bool turns = hand.kind == HandScript::Kind::kStroke || hand.kind == HandScript::Kind::kCircle;
  const Eigen::Vector3d normal = device.mount.orientation * hand.normal.normalized();
  const Eigen::Vector3d center = device.mount.position + device.mount.orientation * hand.center;
  const Eigen::Vector3d way = middle - (center + hand.radius * normal);
  if (turns || way.dot(normal) > kTowards * way.norm()) return "";
  return fmt::format(
      ", or turn hand.normal: the hand moves along it only, which is [{:.3g}, {:.3g}, {:.3g}] in the "
      "world, so another hand.radius does not lead there",
      normal.x(), normal.y(), normal.z());
}

/// Warns at the key of the hand that leads away from the models: its path, its spring or its radius. @param what
/// beginning of the message @return false if none of them does
bool reportAstray(const scene::Scene& scene, uint32_t index, const HandScript& hand, const WalkedArm& seen,
                  const servo::World& world, const std::string& what, document::Problems& warnings) {
  const scene::Device& device = scene.devices[index];
  const scene::Model& nearest = scene.models[seen.nearest];
  if (hand.kind == HandScript::Kind::kPath) {
    const HandKey key = keyOfHand(scene, device, {"hand.path"});
    const Eigen::Vector3d mount = device.mount.position, pose = nearest.pose.position;
    document::report(
        warnings, key.place, key.id,
        what + fmt::format("a path through a model, in m of the device frame; mount.position of {} is [{:.3g}, {:.3g}, "
                           "{:.3g}], and pose.position of {} is [{:.3g}, {:.3g}, {:.3g}]: is one of them wrong?",
                           device.name, mount.x(), mount.y(), mount.z(), nearest.name, pose.x(), pose.y(), pose.z()));
    return true;
  }
  if (const scene::Value* spring = softSpring(device)) {
    document::report(
        warnings, spring->place, "hand.stiffness",
        what +
            fmt::format("a stiffer hand: with {:g} N/m its spring pulls with {:.2g} N where it is 10 mm off its way; "
                        "500 N/m is a firm grip",
                        spring->number, 0.01 * spring->number));
    return true;
  }
  const host::ShapeInstance& shape = *world.shapes()[seen.nearest];
  if (circlesModel(device, hand, nearest, shape) || passesAround(device, hand, nearest, shape))
    if (const auto radius = radiusOfFarHand(scene, index, hand, seen.away, true)) {
      const HandKey key = keyOfHand(scene, device, {"hand.radius", "hand.rise", "hand.script"});
      document::report(
          warnings, key.place, key.id,
          what + fmt::format("a hand.radius of {:.4g} m, "
                             "with which it touches a model (it is {:.4g} m now{})",
                             *radius, hand.radius, seen.away > 0 ? "; it is a radius, not a diameter" : ""));
      return true;
    }
  return false;
}

/// Returns the middle of a model in the world, or its position if its plugin reports no box.
Eigen::Vector3d middleOf(const scene::Model& model, const host::ShapeInstance& shape) {
  Eigen::AlignedBox3d box;
  if (!shape.bounds(box.min().data(), box.max().data())) return model.pose.position;
  return model.pose.position + model.pose.orientation * box.center();
}

/// Returns what to do about a hand that comes near no model. @param middle of the nearest model, in the world
std::string mendOf(const scene::Scene& scene, uint32_t index, const HandScript& hand, const WalkedArm& seen,
                   const Eigen::Vector3d& middle) {
  const scene::Device& device = scene.devices[index];
  const std::string& nearest = scene.models[seen.nearest].name;
  if (seen.end > 0)
    return fmt::format(
        "a model within the arm's reach: joint {} is at the end of its range there, so the tip cannot follow the hand; "
        "the middle of {} is at [{:.3g}, {:.3g}, {:.3g}] in the world; "
        "move the model (pose.position) or the arm (mount.position)",
        seen.end, nearest, middle.x(), middle.y(), middle.z());
  const Eigen::Vector3d center = device.mount.position + device.mount.orientation * hand.center;
  return fmt::format(
      "a hand that moves near a model: its centre (hand.center) is at [{:.3g}, {:.3g}, {:.3g}] in "
      "the world, it moves {:.3g} m from there (hand.radius), and the middle of {} is at [{:.3g}, {:.3g}, {:.3g}]; "
      "move the arm (mount.position), hand.center or the model (pose.position){}",
      center.x(), center.y(), center.z(), hand.radius, nearest, middle.x(), middle.y(), middle.z(),
      adviceOf(scene, index, hand, seen, middle));
}

void reportAway(const scene::Scene& scene, uint32_t index, const HandScript& hand, const WalkedArm& seen,
                const servo::World& world, document::Problems& warnings) {
  const scene::Device& device = scene.devices[index];
  const scene::Model& nearest = scene.models[seen.nearest];
  const std::string where = seen.away > 0
                                ? fmt::format("comes no nearer than {:.3g} mm to any model ({} is the nearest)",
                                              seen.away * 1e3, nearest.name)
                                : fmt::format("moves where {} is, but touches no surface", nearest.name);
  const std::string what = fmt::format("the hand of {} {}: it feels nothing; expected ", device.name, where);
  if (seen.end == 0 && reportAstray(scene, index, hand, seen, world, what, warnings)) return;
  const Eigen::Vector3d middle = middleOf(nearest, *world.shapes()[seen.nearest]);
  const std::string at = mendOf(scene, index, hand, seen, middle);
  const std::string in_list = fmt::format("devices[{}].mount.position", index);
  for (const std::string& id : {std::string("device.mount.position"), in_list})
    if (const auto place = placeOfKey(scene.file, id)) return document::report(warnings, *place, id, what + at);
  const HandKey own = keyOfHand(scene, device, {"hand.center"});
  if (own.id == "hand.center" && own.place.file == scene.file.string() && own.place.line > 1)
    return document::report(warnings, own.place, own.id, what + at);
  document::report(warnings, nearest.place, fmt::format("models[{}].pose.position", seen.nearest), what + at);
}

/// Warns of a model that is touched, but pushes so little that nobody feels it.
void reportUnfelt(const scene::Model& model, size_t index, const WalkedModel& seen, document::Problems& warnings) {
  document::Place place = model.place;
  std::string key = fmt::format("models[{}]", index), fix = "expected more stiffness";
  for (const char* id : {"depth_scale", "exponent", "stiffness"})
    if (const scene::Value* value = givenIn(model.parameters, id)) {
      place = value->place;
      key += std::string(".parameters.") + id;
      if (id != std::string_view("stiffness")) fix = "depth_scale must be in m (1 mm is 0.001), or give more stiffness";
      break;
    }
  document::report(
      warnings, place, key,
      fmt::format("{} cannot be felt: the hand is up to {:.3g} mm deep in it, but its force is at most {:.2g} N; {}",
                  model.name, seen.depth * 1e3, seen.force, fix));
}

/// Returns what to do about a limit that takes almost all of the force.
std::string remedyOf(const std::string& limit) {
  if (limit == "workspace")
    return "expected the radius in m that the tip may be away from the arm's origin, such as 0.15";
  if (limit == "slew") return "the value must be in N/s, such as 2000";
  if (limit == "impulse")
    return "the value must be in N s within 0.1 s; a lasting force is cut to five times this number, in N";
  if (limit == "power") return "the value must be in W, such as 5";
  if (limit == "motors")
    return "torque_constant must be in N m/A, resistance in ohm, and ratio joint torque over motor torque";
  return "expected a larger value";
}

/// Returns the limit that cuts most often.
size_t strictest(const WalkedArm& seen) {
  return static_cast<size_t>(std::max_element(seen.limits.begin(), seen.limits.end()) - seen.limits.begin());
}

/// Warns at a limit of the device file that is so strict that no scene helps. @return false if it is not
bool reportOwnLimit(const scene::Device& device, const WalkedArm& seen, const std::string& limit,
                    document::Problems& warnings) {
  constexpr double kMostly = 0.5;  // share of the ticks with a force
  const double share = static_cast<double>(seen.cut) / static_cast<double>(seen.contact);
  if (limit == "force" || limit == "torque" || limit == "motors (torque)" || share < kMostly) return false;
  const std::string name = limit.substr(0, limit.find(' '));  // "motors (heat)" is limits.motors
  const auto place = placeOfKey(device.file, "limits." + name);
  if (!place) return false;
  document::report(warnings, *place, "limits." + name,
                   fmt::format("this limit cuts the force of {} in {:.0f} % of the ticks with a force, although models "
                               "ask for no more than {:.3g} N, so little is felt; {}",
                               device.name, 100 * share, seen.asked, remedyOf(name)));
  return true;
}

/// Warns of a limit of speed that the hand exceeds, because the forces end then for the rest of the run. @return false
/// if it did not
bool reportLimiterFault(const scene::Device& device, const servo::Limiter& limiter, document::Problems& warnings) {
  if (limiter.fault() != servo::Fault::kTooFast) return false;
  const auto place = placeOfKey(device.file, "limits.velocity");
  document::report(
      warnings, place.value_or(document::Place{device.file.string(), 1, 1}), "limits.velocity",
      fmt::format("the tip of {} moves at {:.3g} m/s in this scene, which is a fault that ends its forces; expected "
                  "more than the hand moves at, such as 2 m/s, or a slower hand (hand.rate, hand.lead_in)",
                  device.name, limiter.measured()));
  return true;
}

void reportCut(const scene::Scene& scene, const scene::Device& device, const HandScript& hand, const WalkedArm& seen,
               const servo::Limiter& limiter, document::Problems& warnings) {
  constexpr double kDeep = 5e-3;  // [m] for deeper presses, the hand is the cause, not the stiffness
  const scene::Model& model = scene.models[seen.deepest];
  const scene::Value* stiffness = givenIn(model.parameters, "stiffness");
  HandKey key = hand.presses() ? keyOfHand(scene, device, {"hand.rise", "hand.radius", "hand.script"})
                               : keyOfHand(scene, device, {"hand.radius", "hand.path", "hand.script"});
  if (seen.depth < kDeep && stiffness != nullptr)
    key = {stiffness->place, fmt::format("models[{}].parameters.stiffness", seen.deepest)};
  const auto strict = static_cast<servo::Limit>(strictest(seen));
  const std::string limit = servo::nameOf(strict);
  if (reportOwnLimit(device, seen, limit, warnings)) return;
  const std::string most =
      limit == "motors (torque)" && seen.asked <= limiter.maxForce()
          ? fmt::format(", less than the {:.3g} N of limits.force, but more than its motors give in that pose",
                        limiter.maxForce())
      : limiter.maxForce() > 0 ? fmt::format(", but only {:.3g} N are allowed", limiter.maxForce())
                               : "";
  document::report(
      warnings, key.place, key.id,
      fmt::format("the hand of {} is up to {:.3g} mm deep in {} and asks for up to {:.3g} N{}: {} cuts the force in "
                  "{:.0f} % of the ticks with a force; "
                  "expected a hand that presses less (hand.radius, hand.rise in m) or less stiffness",
                  device.name, seen.depth * 1e3, model.name, seen.asked, most, servo::keyOf(strict),
                  100 * static_cast<double>(seen.cut) / static_cast<double>(seen.contact)));
}

/// Warns of a hand that touches a model, but whose arm stands at its own end much of the time: the tip does not follow
/// it, and it presses or moves the model less far than it wants to.
void reportArmAtEnd(const scene::Scene& scene, uint32_t index, const Walk& walk, document::Problems& warnings) {
  constexpr double kMuch = 0.25;  // share of the ticks
  const WalkedArm& seen = walk.arms[index];
  const scene::Model& model = scene.models[seen.deepest];
  uint32_t joint = 0;
  for (uint32_t i = 1; i < HDV_MAX_JOINTS; ++i)
    if (seen.stops.ticks(i) > seen.stops.ticks(joint)) joint = i;
  const double share = static_cast<double>(seen.stops.ticks(joint)) / static_cast<double>(walk.ticks);
  if (share < kMuch) return;
  reportInModel(
      warnings, scene, seen.deepest, "pose.position",
      fmt::format("joint {} of {} is at the end of its range in {:.0f} % of the ticks, so the tip cannot follow the "
                  "hand, which touches {}: it presses and moves it less far than it wants to; expected a model nearer "
                  "to where the arm reaches; move it (pose.position) or the arm (mount.position)",
                  joint + 1, scene.devices[index].name, 100 * share, model.name));
}

/// Returns true if a run would report something odd about the plugin of a model. Its contacts say nothing about the
/// scene then.
bool isOdd(const Walk& walk, size_t model) {
  return walk.silenced[model] || !walk.judged[model].empty();
}

/// Gives the warnings with which a run would end. The plugin is to blame, so they stand at the key that names it.
void reportPlugin(const scene::Scene& scene, size_t index, const Walk& walk, document::Problems& warnings) {
  for (const std::string& text : walk.judged[index]) reportInModel(warnings, scene, index, "plugin", text);
}

void checkWalkOfArm(const scene::Scene& scene, uint32_t index, const Walk& walk, const servo::World& world,
                    const std::vector<bool>& strays, bool all_models, document::Problems& warnings) {
  constexpr double kOften = 0.05;  // share of the ticks with a force
  const auto strayed = [&strays](size_t model) { return model < strays.size() && strays[model]; };
  const WalkedArm& seen = walk.arms[index];
  const auto hand = handScriptOf(scene.devices[index]);
  if (!hand || !hand->moves()) return;
  if (reportLimiterFault(scene.devices[index], walk.limiters[index], warnings)) return;
  if (reportSwing(scene, index, seen, warnings)) return;
  if (!seen.touched) {
    const bool silent = std::find(walk.silenced.begin(), walk.silenced.end(), true) != walk.silenced.end();
    const bool all_enabled =
        std::all_of(scene.models.begin(), scene.models.end(), [](const scene::Model& m) { return m.enabled; });
    if (all_models && all_enabled && !silent && walk.whole && std::isfinite(seen.away) && !strayed(seen.nearest))
      reportAway(scene, index, *hand, seen, world, warnings);
    return;
  }
  if (strayed(seen.deepest) || isOdd(walk, seen.deepest)) return;
  const auto ticks = [](uint64_t count) { return static_cast<double>(count); };
  if (ticks(seen.cut) * walk.period > kContactSeconds && ticks(seen.cut) > kOften * ticks(seen.contact))
    reportCut(scene, scene.devices[index], *hand, seen, walk.limiters[index], warnings);
  if (walk.whole) reportArmAtEnd(scene, index, walk, warnings);
}

void checkWalkOfModel(const scene::Scene& scene, size_t index, const Walk& walk, const servo::World& world,
                      document::Problems& warnings) {
  constexpr double kUnfelt = 0.03;  // [N] less than the friction of an arm
  const WalkedModel& seen = walk.models[index];
  reportPlugin(scene, index, walk, warnings);
  if (walk.silenced[index] || static_cast<double>(seen.touched) * walk.period < kContactSeconds) return;
  if (reportNoClick(scene.models[index], index, *world.shapes()[index], seen, walk.whole, warnings)) return;
  if (walk.whole && seen.force > 0 && seen.force < kUnfelt) reportUnfelt(scene.models[index], index, seen, warnings);
}

/// Warns of a plugin whose steps allocate memory, as the end of a run does.
void reportAllocations(const scene::Scene& scene, const Walk& walk, document::Problems& warnings) {
  for (size_t i = 0; i < scene.models.size() && !walk.allocates.empty(); ++i) {
    const scene::Model& model = scene.models[i];
    if (model.name != walk.allocates) continue;
    reportInModel(
        warnings, scene, i, "plugin",
        fmt::format("steps of {} allocate memory, which may have to wait, and then the tick is late; allocate it in "
                    "activate(): step(), which is touch() of a shape in C++, may not",
                    model.name));
  }
}

/// Warns of a plugin whose steps wait. A machine that is busy takes the processor away, but does not make a step wait.
void reportWaits(const scene::Scene& scene, const Walk& walk, document::Problems& warnings) {
  constexpr uint64_t kFew = 20;     // ticks: a file that is read at its first use waits, too
  constexpr uint64_t kSeldom = 50;  // one in so many ticks
  if (walk.waits < kFew || walk.waits * kSeldom < walk.ticks) return;
  const scene::Model& model = scene.models[walk.waiter];
  reportInModel(
      warnings, scene, walk.waiter, "plugin",
      fmt::format("steps of {} wait, in {} of {} ticks{}: they sleep, lock, or read or write a file, so ticks of a run "
                  "are late; step(), which is touch() of a shape in C++, may not wait; find the call with: hapticd "
                  "plugin check {}",
                  model.name, walk.waits, walk.ticks, walk.waited ? ", after which the hand was not moved on" : "",
                  model.library.string()));
}

/// Warns that a walk was ended before the hands had done their motion, at the model that took most of the time.
void reportLate(const scene::Scene& scene, const Walk& walk, document::Problems& warnings) {
  const auto slowest = static_cast<size_t>(
      std::max_element(walk.models.begin(), walk.models.end(),
                       [](const WalkedModel& a, const WalkedModel& b) { return a.seconds < b.seconds; }) -
      walk.models.begin());
  const double ticks = static_cast<double>(walk.ticks), step = walk.models[slowest].seconds / ticks;
  const std::string what = fmt::format(
      "the hand was not moved to the end, so what it meets was not judged: "
      "{:.2g} s of its motion took {:g} s of processor time",
      ticks * walk.period, kMostProcessor);
  constexpr double kMost = 0.5;  // share of the time
  if (walk.models[slowest].seconds < kMost * kMostProcessor)
    return document::report(warnings, scene.file.string(), 1, 1, "models", what);
  const scene::Model& model = scene.models[slowest];
  reportInModel(warnings, scene, slowest, "plugin",
                fmt::format("{}, because a step of {} takes {:.2g} ms (a tick lasts {:.2g} ms{}); "
                            "hapticd plugin check {} measures it",
                            what, model.name, step * 1e3, walk.period * 1e3,
                            step > walk.period ? ", and a run silences a plugin that needs more" : "",
                            shellWord(model.library.string())));
}

}  // namespace

document::Problems warnOfWalk(const scene::Scene& scene, servo::World& world, const std::vector<bool>& strays,
                              bool all_models) {
  document::Problems warnings;
  const auto walk = [&] {
    const StepWatch watch;
    return walkHands(scene, world);
  }();
  if (!walk) return warnings;
  reportAllocations(scene, *walk, warnings);
  reportWaits(scene, *walk, warnings);
  if (walk->waited) return warnings;
  if (walk->late) {
    reportLate(scene, *walk, warnings);
    return warnings;
  }
  for (size_t i = 0; i < scene.models.size(); ++i) checkWalkOfModel(scene, i, *walk, world, warnings);
  for (uint32_t i = 0; i < scene.devices.size(); ++i)
    checkWalkOfArm(scene, i, *walk, world, strays, all_models, warnings);
  return warnings;
}

}  // namespace hapticd::diagnostics
