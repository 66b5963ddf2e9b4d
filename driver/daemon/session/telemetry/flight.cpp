// SPDX-License-Identifier: MIT
#include "session/telemetry/flight.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace hapticd::servo {

namespace {

/// The direction of a click and the end of a joint are in the rows of their events. Rows of contacts do not have these
/// flags, so that recordings from before these flags replay to the same bits.
constexpr uint32_t kOnlyInEvents = HSP_OUT_WENT_IN | HSP_OUT_CAME_OUT | HSP_OUT_AT_LOWEST | HSP_OUT_AT_HIGHEST;

void copy3(double* to, const Eigen::Vector3d& from) noexcept HSP_RT {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

template <class T>
void copyAll(T& to, const T& from) noexcept HSP_RT {
  std::memcpy(&to, &from, sizeof to);
}

}  // namespace

Flight::Flight(std::unique_ptr<record::FlightRing> ring, const Arms& arms, size_t places)
    : ring_(std::move(ring)), faults_before_(arms.size()), events_(places, arms.size()) {
  const record::RowLayout& layout = ring_->specs()[kTicks].layout;
  const auto offsetOf = [&](const std::string& name) {
    for (const record::Column& column : layout.columns())
      if (column.name == name) return column.offset;
    return 0u;
  };
  for (size_t i = 0; i < arms.size(); ++i) {
    const std::string arm = "arm" + std::to_string(i) + "_";
    columns_.push_back({offsetOf(arm + "sequence"), offsetOf(arm + "q0"), offsetOf(arm + "dq0"),
                        offsetOf(arm + "measured0"), offsetOf(arm + "command0"), arms[i]->info().joint_count,
                        offsetOf(arm + "client_fx")});
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

bool Flight::newestPose(uint32_t model, PoseRow& row) const {
  constexpr uint64_t kMostAtOnce = 1024;  // looks back over this many rows at most
  const uint64_t end = ring_->written(kPoses);
  for (uint64_t back = 1; back <= std::min(end, kMostAtOnce); ++back)
    if (ring_->copy(kPoses, end - back, 1, reinterpret_cast<std::byte*>(&row)) == 1 && row.model == model) return true;
  return false;
}

std::vector<hapticd_event> Flight::events(uint64_t& first, size_t most) const {
  const uint64_t end = ring_->written(kEvents), kept = ring_->capacity(kEvents) - 1;
  first = std::min(std::max(first, end > kept ? end - kept : 0), end);
  std::vector<hapticd_event> rows(std::min<uint64_t>(end - first, most));
  if (!rows.empty()) rows.resize(ring_->copy(kEvents, first, rows.size(), reinterpret_cast<std::byte*>(rows.data())));
  return rows;
}

template <class Row>
void Flight::push(FlightStream stream, const Row& row) noexcept HSP_RT {
  std::memcpy(ring_->next(stream), &row, sizeof row);
  ring_->commit(stream);
}

void Flight::begin(Nanoseconds now, const Arms& arms) noexcept HSP_RT {
  now_ = now;
  // The memory of this tick's rows was last used seconds ago. Prefetching it while the tick works makes writing fast.
  constexpr uint32_t kCacheLine = 64;
  for (const FlightStream stream : {kTicks, kContacts}) {
    const std::byte* row = ring_->place(stream);
    for (uint32_t at = 0; at < ring_->rowBytes(stream); at += kCacheLine) __builtin_prefetch(row + at, 1);
  }
  for (size_t i = 0; i < arms.size(); ++i) faults_before_[i] = static_cast<uint32_t>(arms[i]->limiter().fault());
}

bool Flight::mark(uint64_t number, MarkRow& row) const {
  return ring_->copy(kMarks, number, 1, reinterpret_cast<std::byte*>(&row)) == 1;
}

/// Keeps a mark until the time of its tick is known. The number of its row is known already.
void Flight::mark(const Order& order) noexcept HSP_RT {
  if (mark_count_ == marks_.size()) return;
  const bool of_program = order.target == Order::kNoModel;
  if (of_program) events_.mark(static_cast<uint32_t>(ring_->written(kMarks) + mark_count_));
  MarkRow& row = marks_[mark_count_++];
  row.model = of_program ? -1 : static_cast<int32_t>(order.target);
  row.left = order.param;
  copyAll(row.text, order.text);
}

void Flight::marks(double t) noexcept HSP_RT {
  for (size_t i = 0; i < mark_count_; ++i) {
    marks_[i].tick = tick_;
    marks_[i].t = t;
    push(kMarks, marks_[i]);
  }
  mark_count_ = 0;
}

void Flight::order(const Order& order) noexcept HSP_RT {
  if (order.kind == Order::Kind::kMark) return mark(order);
  events_.order(order);
  OrderRow row;
  row.tick = tick_;
  row.kind = static_cast<uint32_t>(order.kind);
  row.target = order.target;
  row.param = order.param;
  row.place = order.place;
  row.value = order.value;
  row.seconds = order.seconds;
  copyAll(row.position, order.position);
  copyAll(row.orientation, order.orientation);
  push(kOrders, row);
}

void Flight::tick(double t, double dt, Nanoseconds late, Nanoseconds spent, const Core& core,
                  const Arms& arms) noexcept HSP_RT {
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
  for (uint32_t i = 0; i < arms.size(); ++i) lead(Order::Led::kHand, i, arms[i]->hand().taken());
  for (uint32_t i = 0; i < arms.size(); ++i) pushes(i, *arms[i]);
  links(t, arms);
  motors(t, arms);
  activations(core);
  marks(t);  // before the events that name them
  events(t, core, arms);
  std::byte* to = ring_->next(kTicks);
  std::memcpy(to, &row, sizeof row);
  for (uint32_t i = 0; i < arms.size(); ++i) tickArm(columns_[i], *arms[i], core, i, to);
  ring_->commit(kTicks);  // last, so that a reader that sees the tick sees all its rows
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
  storeQuaternion(probe.orientation, out.orientation);
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
  if (columns.client == 0) return;
  ClientColumns client;
  copy3(client.force, arm.clients().force());
  copy3(client.torque, arm.clients().torque());
  std::memcpy(row + columns.client, &client, sizeof client);
}

void Flight::links(double t, const Arms& arms) noexcept HSP_RT {
  constexpr double kPeriod = 1.0 / 60;  // [s] screens draw this often
  if (t < links_due_) return;
  links_due_ = t + kPeriod;
  std::array<Arm::LinkEnd, HDV_MAX_LINKS> ends;
  for (uint32_t arm = 0; arm < arms.size(); ++arm)
    for (uint32_t link = 0, count = arms[arm]->links(ends); link < count; ++link)
      push(kLinks, LinkRow{tick_, arm, link, ends[link]});
}

void Flight::motors(double t, const Arms& arms) noexcept HSP_RT {
  constexpr double kPeriod = 0.1;  // [s] temperatures change slowly
  if (t < motors_due_) return;
  motors_due_ = t + kPeriod;
  for (uint32_t arm = 0; arm < arms.size(); ++arm) {
    const MotorHeat& heat = arms[arm]->heat();
    for (uint32_t joint = 0; joint < heat.count(); ++joint)
      push(kMotors, MotorRow{tick_, arm, joint, heat.winding(joint), heat.factor()});
  }
}

void Flight::pushes(uint32_t index, const Arm& arm) noexcept HSP_RT {
  if (!arm.clients().present()) return;
  for (uint32_t place = 0; place < ClientForces::kMost; ++place)
    if (const ClientForces::Client& client = arm.clients().clients()[place]; client.fresh)
      push(kPushes, PushRow{tick_, index, place, client.push});
}

void Flight::events(double t, const Core& core, const Arms& arms) noexcept HSP_RT {
  events_.tick(t, core, arms);
  for (hapticd_event event : events_.found()) {
    event.tick = tick_;
    push(kEvents, event);
  }
  events_.forget();
}

void Flight::contacts(const Core& core, TickRow& tick) noexcept HSP_RT {
  bool any_felt = false;
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
      row.flags = world.flags & ~kOnlyInEvents;
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
      const bool felt = counts_unfelt_ || row.gain > 0;
      // Felt models go first. The comparison is false for the first contact, because tick.depth is NaN.
      if (!contact.traced || felt < any_felt || (felt == any_felt && row.depth <= tick.depth)) continue;
      any_felt = felt;
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
    lead(Order::Led::kModel, index, model.lead.taken());
  }
}

void Flight::lead(Order::Led led, uint32_t target, const hapticd_target* taken) noexcept HSP_RT {
  if (taken == nullptr) return;
  push(kLeads, LeadRow{tick_, static_cast<uint32_t>(led), target, *taken});
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
