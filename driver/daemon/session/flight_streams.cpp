// SPDX-License-Identifier: MIT
/// The columns of every stream of a run.
#include <algorithm>
#include <cmath>

#include "session/flight.hpp"

namespace hapticd::servo {

namespace {

using record::ColumnType;
using record::RowLayout;
using record::StreamSpec;

constexpr const char* kAxes[] = {"x", "y", "z"};
constexpr const char* kQuaternion[] = {"qw", "qx", "qy", "qz"};

void vector(RowLayout& layout, const std::string& prefix, const char* unit, const std::string& doc) {
  for (const char* axis : kAxes) layout.add(prefix + axis, ColumnType::kReal, unit, doc);
}

void quaternion(RowLayout& layout, const std::string& prefix, const std::string& doc) {
  for (const char* part : kQuaternion) layout.add(prefix + part, ColumnType::kReal, "", doc);
}

/// Everything in the order of TickRow.
void tickColumns(RowLayout& layout) {
  layout.add("tick", ColumnType::kCount, "", "number of the tick from 0");
  layout.add("time_ns", ColumnType::kCount, "ns", "deadline of the tick on the clock of the run");
  layout.add("t", ColumnType::kReal, "s", "since the first tick");
  layout.add("dt", ColumnType::kReal, "s", "since the tick before; a multiple of the period after missed ones");
  layout.add("depth", ColumnType::kReal, "m",
             "deepest contact; negative: distance of the nearest foot; nan: none traced");
  layout.add("lateness_us", ColumnType::kReal32, "us", "wake-up after the deadline");
  layout.add("compute_us", ColumnType::kReal32, "us", "time that the tick took");
  layout.add("model", ColumnType::kInt, "", "model of that depth, -1: none");
  layout.add("status", ColumnType::kInt, "", "worst status of a step, hsp_status");
}

/// Everything in the order of ArmRow.
void armColumns(RowLayout& layout, const std::string& arm) {
  layout.add(arm + "sequence", ColumnType::kCount, "", "grows with each new sample");
  layout.add(arm + "sample_ns", ColumnType::kCount, "ns", "time of the sample");
  layout.add(arm + "read_status", ColumnType::kInt, "", "answer of the device's read, hsp_status");
  layout.add(arm + "write_status", ColumnType::kInt, "", "answer of its write");
  layout.add(arm + "flags", ColumnType::kWord, "", "of the sample, HDV_S_*");
  layout.add(arm + "buttons", ColumnType::kWord, "", "bit i: button i is down");
  layout.add(arm + "fault_before", ColumnType::kWord, "", "fault that held before the tick, 0: none");
  layout.add(arm + "fault", ColumnType::kWord, "", "fault after the tick, 0: none");
  layout.add(arm + "mode", ColumnType::kWord, "", "command: 0 motors off, 1 torque");
  layout.add(arm + "valid", ColumnType::kWord, "", "1: the sample was good");
  vector(layout, arm, "m", "tip, world frame");
  quaternion(layout, arm, "orientation of the tip, world frame");
  vector(layout, arm + "v", "m/s", "estimated velocity of the tip, 0 where nothing uses it");
  vector(layout, arm + "f", "N", "force of the models on the hand, before the limits, world frame");
  vector(layout, arm + "t", "N m", "torque of the models on the hand, before the limits, world frame");
  vector(layout, arm + "sent_f", "N", "force as sent to the device, world frame");
}

uint32_t jointColumns(RowLayout& layout, const std::string& prefix, uint32_t joints, const char* unit,
                      const std::string& doc) {
  uint32_t first = 0;
  for (uint32_t i = 0; i < joints; ++i) {
    const uint32_t offset = layout.add(prefix + std::to_string(i), ColumnType::kReal, unit, doc);
    if (i == 0) first = offset;
  }
  return first;
}

RowLayout contactColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick");
  layout.add("model", ColumnType::kWord, "", "index in about.models");
  layout.add("probe", ColumnType::kWord, "", "arm");
  layout.add("feature", ColumnType::kWord, "", "surface or medial element of the foot");
  layout.add("iterations", ColumnType::kWord, "", "evaluations spent");
  layout.add("flags", ColumnType::kWord, "", "HSP_OUT_*");
  layout.add("status", ColumnType::kInt, "", "of the model's step, hsp_status");
  layout.add("depth", ColumnType::kReal, "m", "> 0 inside, minus the distance outside");
  layout.add("u", ColumnType::kReal, "", "parameter of the foot");
  layout.add("v", ColumnType::kReal, "", "parameter of the foot");
  vector(layout, "p", "m", "foot point, world frame");
  vector(layout, "n", "", "outward unit normal there, world frame");
  vector(layout, "f", "N", "force of this model, world frame");
  vector(layout, "t", "N m", "torque of this model, world frame");
  layout.add("step_us", ColumnType::kReal32, "us", "time of the model's step, 0: not measured");
  layout.add("gain", ColumnType::kReal32, "", "factor on the force: fades in and out");
  return layout;
}

RowLayout poseColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick");
  layout.add("model", ColumnType::kWord, "", "index in about.models");
  layout.add("reserved", ColumnType::kWord, "", "0");
  vector(layout, "", "m", "of a moving model, world frame");
  quaternion(layout, "", "orientation");
  vector(layout, "v", "m/s", "velocity of the frame's origin");
  vector(layout, "w", "rad/s", "angular velocity, world frame");
  return layout;
}

RowLayout activationColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick that took the record");
  layout.add("model", ColumnType::kWord, "", "index in about.models");
  layout.add("order", ColumnType::kWord, "", "0 start tracing, 1 a better foot, 2 stop tracing");
  layout.add("surface", ColumnType::kWord, "", "of the model");
  layout.add("probe", ColumnType::kWord, "", "arm");
  layout.add("u", ColumnType::kReal, "", "parameter of the foot");
  layout.add("v", ColumnType::kReal, "", "parameter of the foot");
  layout.add("distance", ColumnType::kReal, "m", "as the search found it");
  return layout;
}

RowLayout orderColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick that obeyed");
  layout.add("kind", ColumnType::kWord, "",
             "1 enable, 2 disable, 3 move, 4 set, 5 clear, 6 hold, 7 adopt, 8 release; by the servo itself: 9 "
             "accuracy, 10 overran, 11 cut; 12 lead, 13 unlead");
  layout.add("target", ColumnType::kWord, "", "model, or arm of 5, 6, 11 and of leads that are not of a model");
  layout.add("param", ColumnType::kWord, "",
             "of a set: index in the plugin's table; 12, 13: what is led, as in leads, 2 a force");
  layout.add("reserved", ColumnType::kWord, "", "12, 13 of a force: which of the arm's places; otherwise 0");
  layout.add("value", ColumnType::kReal, "",
             "of a set; 9: the level; 12, 13: process of the leader; 11: 1 found before the tick, 0 in it");
  layout.add("seconds", ColumnType::kReal, "s", "that a move takes; 11: that the servo was stuck");
  vector(layout, "", "m", "where a move goes, world frame");
  quaternion(layout, "", "where a move goes");
  return layout;
}

/// Everything in the order of LeadRow.
RowLayout leadColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick that took the record");
  layout.add("led", ColumnType::kWord, "", "0 a model, 1 the hand of a simulated arm");
  layout.add("target", ColumnType::kWord, "", "model, or arm");
  vector(layout, "", "m", "where the leader wanted it, world frame");
  quaternion(layout, "", "wanted orientation");
  vector(layout, "v", "m/s", "wanted velocity");
  vector(layout, "w", "rad/s", "wanted angular velocity");
  layout.add("time", ColumnType::kReal, "s", "CLOCK_MONOTONIC for which it was said, 0: for the tick");
  return layout;
}

/// Everything in the order of PushRow.
RowLayout pushColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick that took the answer");
  layout.add("arm", ColumnType::kWord, "", "that is pushed on");
  layout.add("place", ColumnType::kWord, "", "of the program among those that push on this arm");
  layout.add("answers", ColumnType::kCount, "", "number of the tick that is answered");
  vector(layout, "f", "N", "force that the program wants, before its bound and its ramp, world frame");
  vector(layout, "t", "N m", "torque that the program wants, before its ramp, world frame");
  layout.add("woke_ns", ColumnType::kCount, "ns", "CLOCK_MONOTONIC when the program woke, 0: unknown");
  layout.add("written_ns", ColumnType::kCount, "ns", "CLOCK_MONOTONIC when it wrote, 0: unknown");
  return layout;
}

/// Everything in the order of LinkRow.
RowLayout linkColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick; 60 times a second");
  layout.add("arm", ColumnType::kWord, "", "arm");
  layout.add("link", ColumnType::kWord, "", "number of the link; about.devices tells where it begins");
  vector(layout, "", "m", "far end of the link, world frame");
  quaternion(layout, "", "orientation of its body");
  return layout;
}

/// Everything in the order of MotorRow.
RowLayout motorColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick; 10 times a second");
  layout.add("arm", ColumnType::kWord, "", "arm");
  layout.add("joint", ColumnType::kWord, "", "that the motor moves");
  layout.add("winding", ColumnType::kReal, "degC", "temperature of its winding, by the model of limits.motors");
  layout.add("share", ColumnType::kReal, "", "that the hottest motor of the arm leaves of every force, 0 to 1");
  return layout;
}

/// Everything in the order of ClientColumns.
void clientColumns(RowLayout& layout, const std::string& arm) {
  vector(layout, arm + "client_f", "N", "force of programs on the hand, bounded and ramped, before the limits");
  vector(layout, arm + "client_t", "N m", "torque of programs on the hand, ramped, before the limits");
}

/// Everything in the order of hapticd_event.
RowLayout eventColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick");
  layout.add("t", ColumnType::kReal, "s", "since the first tick");
  std::string kinds = "what happened:";
  for (uint32_t kind = 1; kind < HAPTICD_EVENT_KINDS; ++kind)
    kinds += std::string(kind > 1 ? ", " : " ") + std::to_string(kind) + " " + nameOfEvent(kind);
  layout.add("kind", ColumnType::kWord, "", kinds);
  layout.add("model", ColumnType::kInt, "", "number of the model, -1: none");
  layout.add("probe", ColumnType::kInt, "", "arm, -1: none");
  layout.add("code", ColumnType::kWord, "", "which fault, why silenced, or what is led; see the header client.h");
  layout.add("value", ColumnType::kReal, "", "what was measured; see the header client.h");
  return layout;
}

/// An arm in the rows of ticks; its columns depend on what it measures.
void addArm(RowLayout& layout, const std::string& arm, const hdv_info& info, bool pushed) {
  while (layout.rowBytes() % 8 != 0) layout.add(arm + "reserved", ColumnType::kWord, "", "0");
  armColumns(layout, arm);
  jointColumns(layout, arm + "q", info.joint_count, "rad or m", "joint position");
  if ((info.capabilities & HDV_C_VELOCITY) != 0)
    jointColumns(layout, arm + "dq", info.joint_count, "rad/s or m/s", "joint velocity, measured");
  if ((info.capabilities & HDV_C_TORQUE) != 0)
    jointColumns(layout, arm + "measured", info.joint_count, "N m or N", "joint torque, measured");
  jointColumns(layout, arm + "command", info.joint_count, "N m or N", "joint torque, as commanded");
  if (pushed) clientColumns(layout, arm);
}

}  // namespace

std::vector<StreamSpec> flightStreams(const scene::Scene& scene, const std::vector<std::unique_ptr<Arm>>& arms,
                                      double rate, double seconds, size_t moving) {
  // A row more than is kept: the one being written. Contacts beyond four models at a time shorten what is kept of them.
  constexpr uint64_t kModelsAtOnce = 4, kFewest = 1024, kRecords = 16384, kNone = 2;
  const auto ticks = static_cast<uint64_t>(std::ceil(seconds * rate)) + 1;
  const uint64_t models = std::clamp<uint64_t>(scene.models.size(), 1, kModelsAtOnce);
  const bool pushed = scene.clients.mode != scene::ClientMode::kOff;
  std::vector<StreamSpec> streams(kFlightStreams);
  streams[kTicks] = {"ticks", {}, ticks};
  streams[kContacts] = {"contacts", contactColumns(),
                        std::max(kFewest, ticks * models * std::max<uint64_t>(arms.size(), 1))};
  // A moving model may also be added during a run: one second is kept of such poses.
  const auto second = static_cast<uint64_t>(rate);
  streams[kPoses] = {"poses", poseColumns(),
                     std::max({kFewest, second, ticks * std::min<uint64_t>(moving, kModelsAtOnce)})};
  streams[kActivations] = {"activations", activationColumns(), kRecords};
  streams[kOrders] = {"orders", orderColumns(), kFewest};
  streams[kLeads] = {"leads", leadColumns(), std::max(kFewest, second)};
  streams[kEvents] = {"events", eventColumns(), kFewest};
  streams[kPushes] = {"pushes", pushColumns(), pushed ? std::max(kFewest, ticks * arms.size()) : kNone};
  uint64_t links = 0;
  uint64_t motors = 0;
  for (const auto& arm : arms) links += arm->linkCount(), motors += arm->heat().count();
  streams[kLinks] = {"links", linkColumns(), std::max(kNone, links * static_cast<uint64_t>(61 * seconds))};
  streams[kMotors] = {"motors", motorColumns(), std::max(kNone, motors * static_cast<uint64_t>(11 * seconds))};
  RowLayout& layout = streams[kTicks].layout;
  tickColumns(layout);
  for (size_t i = 0; i < arms.size(); ++i) addArm(layout, "arm" + std::to_string(i) + "_", arms[i]->info(), pushed);
  return streams;
}

}  // namespace hapticd::servo
