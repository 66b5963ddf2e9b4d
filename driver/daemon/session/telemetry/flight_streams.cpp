// SPDX-License-Identifier: MIT
/// Defines the columns of every stream of a recording, with units and descriptions.
#include <algorithm>
#include <cmath>

#include "session/telemetry/flight.hpp"

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

/// The columns in the order of TickRow.
void tickColumns(RowLayout& layout) {
  layout.add("tick", ColumnType::kCount, "", "number of the tick from 0");
  layout.add("time_ns", ColumnType::kCount, "ns", "deadline of the tick on the clock of the run");
  layout.add("t", ColumnType::kReal, "s", "time since the first tick");
  layout.add("dt", ColumnType::kReal, "s", "time since the last tick; several periods if ticks were missed");
  layout.add("depth", ColumnType::kReal, "m",
             "depth of the deepest contact, of a model that gives force if one is traced; negative: distance to the "
             "nearest surface; nan: no model is traced");
  layout.add("lateness_us", ColumnType::kReal32, "us", "how long after its deadline the tick began");
  layout.add("compute_us", ColumnType::kReal32, "us", "how long the tick took");
  layout.add("model", ColumnType::kInt, "", "number of the model to which the column depth belongs, -1: none");
  layout.add("status", ColumnType::kInt, "", "worst status of a model's step in this tick, hsp_status");
}

/// The columns in the order of ArmRow.
void armColumns(RowLayout& layout, const std::string& arm) {
  layout.add(arm + "sequence", ColumnType::kCount, "", "number of the sample; grows with each new sample");
  layout.add(arm + "sample_ns", ColumnType::kCount, "ns", "time of the sample");
  layout.add(arm + "read_status", ColumnType::kInt, "", "status of the device's read(), hsp_status");
  layout.add(arm + "write_status", ColumnType::kInt, "", "status of the device's write(), hsp_status");
  layout.add(arm + "flags", ColumnType::kWord, "", "flags of the sample, HDV_S_*");
  layout.add(arm + "buttons", ColumnType::kWord, "", "bit i is set if button i is down");
  layout.add(arm + "fault_before", ColumnType::kWord, "", "latched fault before the tick, 0: none");
  layout.add(arm + "fault", ColumnType::kWord, "", "latched fault after the tick, 0: none");
  layout.add(arm + "mode", ColumnType::kWord, "", "what was commanded: 0 motors off, 1 torques, 2 positions");
  layout.add(arm + "valid", ColumnType::kWord, "", "1 if the sample was good, otherwise 0");
  vector(layout, arm, "m", "position of the tip, world frame");
  quaternion(layout, arm, "orientation of the tip, world frame");
  vector(layout, arm + "v", "m/s", "estimated velocity of the tip, world frame; 0 if nothing uses it");
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
  layout.add("probe", ColumnType::kWord, "", "number of the arm");
  layout.add("feature", ColumnType::kWord, "", "surface or medial element of the foot point");
  layout.add("iterations", ColumnType::kWord, "", "number of evaluations of the surface in the step");
  layout.add("flags", ColumnType::kWord, "", "HSP_OUT_*");
  layout.add("status", ColumnType::kInt, "", "status of the model's step, hsp_status");
  layout.add("depth", ColumnType::kReal, "m", "penetration depth; negative: distance outside");
  layout.add("u", ColumnType::kReal, "", "surface parameter of the foot point");
  layout.add("v", ColumnType::kReal, "", "surface parameter of the foot point");
  vector(layout, "p", "m", "foot point, world frame");
  vector(layout, "n", "", "outward unit normal at the foot point, world frame");
  vector(layout, "f", "N", "force of this model, world frame");
  vector(layout, "t", "N m", "torque of this model, world frame");
  layout.add("step_us", ColumnType::kReal32, "us", "how long the model's step took, 0: not measured");
  layout.add("gain", ColumnType::kReal32, "", "factor on the force while it fades in or out, 0 to 1");
  return layout;
}

RowLayout poseColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick");
  layout.add("model", ColumnType::kWord, "", "index in about.models");
  layout.add("reserved", ColumnType::kWord, "", "0");
  vector(layout, "", "m", "position of the model, world frame");
  quaternion(layout, "", "orientation of the model, world frame");
  vector(layout, "v", "m/s", "velocity of the model's origin, world frame");
  vector(layout, "w", "rad/s", "angular velocity of the model, world frame");
  return layout;
}

RowLayout activationColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick that took the record");
  layout.add("model", ColumnType::kWord, "", "index in about.models");
  layout.add("order", ColumnType::kWord, "", "0 start tracing, 1 use a better foot point, 2 stop tracing");
  layout.add("surface", ColumnType::kWord, "", "number of the surface in the model");
  layout.add("probe", ColumnType::kWord, "", "number of the arm");
  layout.add("u", ColumnType::kReal, "", "surface parameter of the foot point");
  layout.add("v", ColumnType::kReal, "", "surface parameter of the foot point");
  layout.add("distance", ColumnType::kReal, "m", "distance from the probe to the foot point, as the search found it");
  return layout;
}

RowLayout orderColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick that obeyed the order");
  layout.add(
      "kind", ColumnType::kWord, "",
      "1 enable, 2 disable, 3 move, 4 set, 5 clear, 6 hold, 7 adopt, 8 release, 12 lead, 13 unlead; by the servo "
      "itself: 9 accuracy, 10 overran, 11 cut");
  layout.add(
      "target", ColumnType::kWord, "",
      "number of the model; number of the arm for kinds 5, 6, 11, and for 12 and 13 if a hand or a force is led");
  layout.add(
      "param", ColumnType::kWord, "",
      "kind 4: index of the parameter in the plugin's table; kinds 12, 13: 0 a model is led, 1 a hand, 2 a force");
  layout.add("reserved", ColumnType::kWord, "",
             "kinds 12, 13 of a force: place of the program on the arm; otherwise 0");
  layout.add(
      "value", ColumnType::kReal, "",
      "kind 4: new value; 9: accuracy level; 12, 13: process id of the leader; 11: 1 if the servo found the cut when "
      "it read the arm, 0 when it wrote the force");
  layout.add("seconds", ColumnType::kReal, "s", "kind 3: duration of the move; 11: how long the servo was stuck");
  vector(layout, "", "m", "kind 3: position after the move, world frame");
  quaternion(layout, "", "kind 3: orientation after the move, world frame");
  return layout;
}

/// The columns in the order of LeadRow.
RowLayout leadColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick that took the record");
  layout.add("led", ColumnType::kWord, "", "what is led: 0 a model, 1 the hand of a simulated arm");
  layout.add("target", ColumnType::kWord, "", "number of the model, or of the arm");
  vector(layout, "", "m", "position that the leader wants, world frame");
  quaternion(layout, "", "orientation that the leader wants, world frame");
  vector(layout, "v", "m/s", "velocity that the leader wants, world frame");
  vector(layout, "w", "rad/s", "angular velocity that the leader wants, world frame");
  layout.add("time", ColumnType::kReal, "s",
             "CLOCK_MONOTONIC time at which the leader wants this pose, 0: in this tick");
  return layout;
}

/// The columns in the order of PushRow.
RowLayout pushColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick that took the answer");
  layout.add("arm", ColumnType::kWord, "", "arm on which the program pushes");
  layout.add("place", ColumnType::kWord, "", "place of the program among the programs that push on this arm");
  layout.add("answers", ColumnType::kCount, "", "number of the tick that the program answers");
  vector(layout, "f", "N", "force that the program wants, before its bound and its ramp, world frame");
  vector(layout, "t", "N m", "torque that the program wants, before its ramp, world frame");
  layout.add("woke_ns", ColumnType::kCount, "ns", "CLOCK_MONOTONIC time when the program woke, 0: unknown");
  layout.add("written_ns", ColumnType::kCount, "ns",
             "CLOCK_MONOTONIC time when the program wrote this answer, 0: unknown");
  return layout;
}

/// The columns in the order of LinkRow.
RowLayout linkColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick; a row 60 times a second");
  layout.add("arm", ColumnType::kWord, "", "number of the arm");
  layout.add("link", ColumnType::kWord, "", "number of the link; about.devices says where the link begins");
  vector(layout, "", "m", "far end of the link, world frame");
  quaternion(layout, "", "orientation of the link, world frame");
  return layout;
}

/// The columns in the order of MotorRow.
RowLayout motorColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick; a row 10 times a second");
  layout.add("arm", ColumnType::kWord, "", "number of the arm");
  layout.add("joint", ColumnType::kWord, "", "joint that the motor moves");
  layout.add("winding", ColumnType::kReal, "degC", "temperature of the motor's winding, calculated by limits.motors");
  layout.add("share", ColumnType::kReal, "", "share of every force that the hottest motor of the arm allows, 0 to 1");
  return layout;
}

/// The columns in the order of MarkRow.
RowLayout markColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick");
  layout.add("t", ColumnType::kReal, "s", "time since the first tick");
  layout.add("model", ColumnType::kInt, "", "-1: a program wrote the text; otherwise number of the model it describes");
  layout.add("left", ColumnType::kWord, "", "number of rows that follow with the rest of the description of the model");
  layout.add("text", ColumnType::kText, "",
             "UTF-8, filled up with zeros: what the program wrote, or a part of the JSON that describes the model");
  return layout;
}

/// The columns in the order of ClientColumns.
void clientColumns(RowLayout& layout, const std::string& arm) {
  vector(layout, arm + "client_f", "N", "force of programs on the hand, bounded and ramped, before the limits");
  vector(layout, arm + "client_t", "N m", "torque of programs on the hand, ramped, before the limits");
}

/// The columns in the order of hapticd_event.
RowLayout eventColumns() {
  RowLayout layout;
  layout.add("tick", ColumnType::kCount, "", "number of the tick");
  layout.add("t", ColumnType::kReal, "s", "time since the first tick");
  std::string kinds = "what happened:";
  for (uint32_t kind = 1; kind < HAPTICD_EVENT_KINDS; ++kind)
    kinds += std::string(kind > 1 ? ", " : " ") + std::to_string(kind) + " " + nameOfEvent(kind);
  layout.add("kind", ColumnType::kWord, "", kinds);
  layout.add("model", ColumnType::kInt, "", "number of the model, -1 if there is none");
  layout.add("probe", ColumnType::kInt, "", "number of the arm, -1 if there is none");
  layout.add(
      "code", ColumnType::kWord, "",
      "its meaning depends on kind: direction of a click (1 snapped in, 2 snapped out, 0 not known), number of the "
      "fault, of the reason why a model was silenced, of the row of a mark in the stream marks, or of what a program "
      "moves (0 a model, 1 a simulated hand, 2 a force); see the header client.h");
  layout.add("value", ColumnType::kReal, "", "measured value; see the header client.h");
  return layout;
}

/// Adds the columns of an arm to the rows of ticks. They depend on what the arm measures.
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

std::vector<StreamSpec> flightStreams(const scene::Scene& scene, const Arms& arms, double rate, double seconds,
                                      size_t moving) {
  // One row more than is kept, for the row that is being written. If more than four models are in contact at a time,
  // the kept contacts cover a shorter time.
  constexpr uint64_t kModelsAtOnce = 4, kFewest = 1024, kRecords = 16384, kNone = 2;
  const auto ticks = static_cast<uint64_t>(std::ceil(seconds * rate)) + 1;
  const uint64_t models = std::clamp<uint64_t>(scene.models.size(), 1, kModelsAtOnce);
  const bool pushed = scene.clients.mode != scene::ClientMode::kOff;
  std::vector<StreamSpec> streams(kFlightStreams);
  streams[kTicks] = {"ticks", {}, ticks};
  streams[kContacts] = {"contacts", contactColumns(),
                        std::max(kFewest, ticks * models * std::max<uint64_t>(arms.size(), 1))};
  // A moving model may also be added during a run: there is room for one second of its poses.
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
  streams[kMarks] = {"marks", markColumns(), kFewest};
  RowLayout& layout = streams[kTicks].layout;
  tickColumns(layout);
  for (size_t i = 0; i < arms.size(); ++i) addArm(layout, "arm" + std::to_string(i) + "_", arms[i]->info(), pushed);
  return streams;
}

}  // namespace hapticd::servo
