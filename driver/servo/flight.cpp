#include "servo/flight.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

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
             "accuracy, 10 overran, 11 cut");
  layout.add("target", ColumnType::kWord, "", "model, or arm of 5, 6 and 11");
  layout.add("param", ColumnType::kWord, "", "of a set: index in the plugin's table");
  layout.add("reserved", ColumnType::kWord, "", "0");
  layout.add("value", ColumnType::kReal, "", "of a set; 9: the level; 11: 1 found before the tick, 0 in it");
  layout.add("seconds", ColumnType::kReal, "s", "that a move takes; 11: that the servo was stuck");
  vector(layout, "", "m", "where a move goes, world frame");
  quaternion(layout, "", "where a move goes");
  return layout;
}

void copy3(double* to, const Eigen::Vector3d& from) noexcept HSP_RT {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

template <class T>
void copyAll(T& to, const T& from) noexcept HSP_RT {
  std::memcpy(&to, &from, sizeof to);
}

}  // namespace

std::vector<StreamSpec> flightStreams(const scene::Scene& scene, const std::vector<std::unique_ptr<Arm>>& arms,
                                      double rate, double seconds, size_t moving) {
  // A row more than is kept: the one being written. Contacts beyond four models at a time shorten what is kept of them.
  constexpr uint64_t kModelsAtOnce = 4, kFewest = 1024, kRecords = 16384;
  const auto ticks = static_cast<uint64_t>(std::ceil(seconds * rate)) + 1;
  const uint64_t models = std::clamp<uint64_t>(scene.models.size(), 1, kModelsAtOnce);
  std::vector<StreamSpec> streams(kFlightStreams);
  streams[kTicks] = {"ticks", {}, ticks};
  streams[kContacts] = {"contacts", contactColumns(),
                        std::max(kFewest, ticks * models * std::max<uint64_t>(arms.size(), 1))};
  // What moves may also come while it runs: of that a second is kept.
  const auto second = static_cast<uint64_t>(rate);
  streams[kPoses] = {"poses", poseColumns(),
                     std::max({kFewest, second, ticks * std::min<uint64_t>(moving, kModelsAtOnce)})};
  streams[kActivations] = {"activations", activationColumns(), kRecords};
  streams[kOrders] = {"orders", orderColumns(), kFewest};
  RowLayout& layout = streams[kTicks].layout;
  tickColumns(layout);
  for (size_t i = 0; i < arms.size(); ++i) {
    const std::string arm = "arm" + std::to_string(i) + "_";
    const hdv_info& info = arms[i]->info();
    while (layout.rowBytes() % 8 != 0) layout.add(arm + "reserved", ColumnType::kWord, "", "0");
    armColumns(layout, arm);
    jointColumns(layout, arm + "q", info.joint_count, "rad or m", "joint position");
    if ((info.capabilities & HDV_C_VELOCITY) != 0)
      jointColumns(layout, arm + "dq", info.joint_count, "rad/s or m/s", "joint velocity, measured");
    if ((info.capabilities & HDV_C_TORQUE) != 0)
      jointColumns(layout, arm + "measured", info.joint_count, "N m or N", "joint torque, measured");
    jointColumns(layout, arm + "command", info.joint_count, "N m or N", "joint torque, as commanded");
  }
  return streams;
}

Flight::Flight(std::unique_ptr<record::FlightRing> ring, const std::vector<std::unique_ptr<Arm>>& arms)
    : ring_(std::move(ring)), faults_before_(arms.size()) {
  const RowLayout& layout = ring_->specs()[kTicks].layout;
  const auto offsetOf = [&](const std::string& name) {
    for (const record::Column& column : layout.columns())
      if (column.name == name) return column.offset;
    return 0u;
  };
  for (size_t i = 0; i < arms.size(); ++i) {
    const std::string arm = "arm" + std::to_string(i) + "_";
    columns_.push_back({offsetOf(arm + "sequence"), offsetOf(arm + "q0"), offsetOf(arm + "dq0"),
                        offsetOf(arm + "measured0"), offsetOf(arm + "command0"), arms[i]->info().joint_count});
  }
}

uint64_t Flight::oldest() const noexcept {
  const uint64_t end = ring_->written(kTicks), kept = ring_->capacity(kTicks) - 1;
  return end > kept ? end - kept : 0;
}

bool Flight::read(uint64_t tick, TickRow& row, ArmRow& arm) const {
  std::vector<std::byte> bytes(ring_->rowBytes(kTicks));
  if (ring_->copy(kTicks, tick, 1, bytes.data()) != 1) return false;
  std::memcpy(&row, bytes.data(), sizeof row);
  arm = {};
  if (!columns_.empty()) std::memcpy(&arm, bytes.data() + columns_.front().arm, sizeof arm);
  return true;
}

template <class Row>
void Flight::push(FlightStream stream, const Row& row) noexcept HSP_RT {
  std::memcpy(ring_->next(stream), &row, sizeof row);
  ring_->commit(stream);
}

void Flight::begin(Nanoseconds now, const std::vector<std::unique_ptr<Arm>>& arms) noexcept HSP_RT {
  now_ = now;
  // The rows of this tick were last touched seconds ago: fetched while the tick works, they cost it nothing.
  constexpr uint32_t kCacheLine = 64;
  for (const FlightStream stream : {kTicks, kContacts}) {
    const std::byte* row = ring_->place(stream);
    for (uint32_t at = 0; at < ring_->rowBytes(stream); at += kCacheLine) __builtin_prefetch(row + at, 1);
  }
  for (size_t i = 0; i < arms.size(); ++i) faults_before_[i] = static_cast<uint32_t>(arms[i]->limiter().fault());
}

void Flight::order(const Order& order) noexcept HSP_RT {
  OrderRow row;
  row.tick = tick_;
  row.kind = static_cast<uint32_t>(order.kind);
  row.target = order.target;
  row.param = order.param;
  row.value = order.value;
  row.seconds = order.seconds;
  copyAll(row.position, order.position);
  copyAll(row.orientation, order.orientation);
  push(kOrders, row);
}

void Flight::tick(double t, double dt, Nanoseconds late, Nanoseconds spent, const Core& core,
                  const std::vector<std::unique_ptr<Arm>>& arms) noexcept HSP_RT {
  TickRow row;
  row.tick = tick_;
  row.time_ns = now_;
  row.t = t;
  row.dt = dt;
  row.depth = std::numeric_limits<double>::quiet_NaN();
  row.lateness_us = static_cast<float>(static_cast<double>(late) * 1e-3);
  row.compute_us = static_cast<float>(static_cast<double>(spent) * 1e-3);
  contacts(core, row);
  poses(core);
  activations(core);
  std::byte* to = ring_->next(kTicks);
  std::memcpy(to, &row, sizeof row);
  for (uint32_t i = 0; i < arms.size(); ++i) tickArm(columns_[i], *arms[i], core, i, to);
  ring_->commit(kTicks);  // last: whoever sees the tick sees all of it
  ++tick_;
}

void Flight::tickArm(const ArmColumns& columns, const Arm& arm, const Core& core, uint32_t index,
                     std::byte* row) noexcept HSP_RT {
  const hdv_sample& sample = arm.sample();
  const Probe& probe = arm.probe();
  ArmRow out;
  out.sequence = sample.sequence;
  out.sample_ns = sample.time_ns;
  out.read_status = arm.readStatus();
  out.write_status = arm.writeStatus();
  out.flags = sample.flags;
  out.buttons = sample.buttons;
  out.fault_before = faults_before_[index];
  out.fault = static_cast<uint32_t>(arm.limiter().fault());
  out.mode = arm.command().mode;
  out.valid = probe.valid ? 1 : 0;
  copy3(out.position, probe.position);
  out.orientation[0] = probe.orientation.w(), out.orientation[1] = probe.orientation.x();
  out.orientation[2] = probe.orientation.y(), out.orientation[3] = probe.orientation.z();
  copy3(out.velocity, probe.velocity);
  copy3(out.force, core.force(index));
  copy3(out.torque, core.torque(index));
  copy3(out.sent, arm.force());
  std::memcpy(row + columns.arm, &out, sizeof out);
  const size_t bytes = columns.joints * sizeof(double);
  std::memcpy(row + columns.position, sample.position, bytes);
  if (columns.velocity != 0) std::memcpy(row + columns.velocity, sample.velocity, bytes);
  if (columns.measured != 0) std::memcpy(row + columns.measured, sample.torque, bytes);
  std::memcpy(row + columns.command, arm.command().torque, bytes);
}

void Flight::contacts(const Core& core, TickRow& tick) noexcept HSP_RT {
  for (const uint32_t index : core.live()) {
    const ModelState& model = core.models()[index];
    if (model.status < tick.status) tick.status = model.status;
    for (uint32_t probe = 0; probe < core.probeCount(); ++probe) {
      const Contact& contact = core.contact(index, probe);
      const hsp_contact& world = contact.world;
      const bool silent = world.force[0] == 0 && world.force[1] == 0 && world.force[2] == 0;
      if (!contact.traced && silent && model.status == HSP_OK) continue;
      ContactRow row;
      row.tick = tick_;
      row.model = index;
      row.probe = probe;
      row.feature = world.feature;
      row.iterations = world.iterations;
      row.flags = world.flags;
      row.status = model.status;
      row.depth = world.depth_m;
      row.u = world.param[0], row.v = world.param[1];
      copyAll(row.point, world.point);
      copyAll(row.normal, world.normal);
      copyAll(row.force, world.force);
      copyAll(row.torque, world.torque);
      row.step_us = static_cast<float>(static_cast<double>(model.step_ns) * 1e-3);
      row.gain = static_cast<float>(model.guard.gain());
      push(kContacts, row);
      if (!contact.traced || row.depth <= tick.depth) continue;  // not a number: the first one is the deepest
      tick.depth = row.depth;
      tick.model = static_cast<int32_t>(index);
    }
  }
}

void Flight::poses(const Core& core) noexcept HSP_RT {
  for (const uint32_t index : core.live()) {
    const ModelState& model = core.models()[index];
    if (!model.moves) continue;
    PoseRow row;
    row.tick = tick_;
    row.model = index;
    copyAll(row.position, model.pose.position);
    copyAll(row.orientation, model.pose.orientation);
    copyAll(row.linear, model.pose.linear);
    copyAll(row.angular, model.pose.angular);
    push(kPoses, row);
  }
}

void Flight::activations(const Core& core) noexcept HSP_RT {
  for (const link::ActivationRecord& record : core.received()) {
    ActivationRow row;
    row.tick = tick_;
    row.model = record.model;
    row.order = static_cast<uint32_t>(record.order);
    row.surface = record.near.surface;
    row.probe = record.near.probe;
    row.u = record.near.param[0], row.v = record.near.param[1];
    row.distance = record.near.distance_m;
    push(kActivations, row);
  }
}

}  // namespace hapticd::servo
