// SPDX-License-Identifier: MIT
/// Fills the black box: one row per tick with its inputs and outputs, and a row for each contact, moving model,
/// activation record and order of that tick. These rows are enough to repeat the run bit for bit.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "record/flight_ring.hpp"
#include "servo/arm/arm.hpp"
#include "servo/core/core.hpp"
#include "servo/core/order.hpp"
#include "session/telemetry/event_finder.hpp"

namespace hapticd::servo {

/// The streams of a recording, in the order of the file. kPushes is empty if no program may push, kLinks if no arm
/// reports its links, and kMotors if no device file describes motors.
enum FlightStream : size_t {
  kTicks,
  kContacts,
  kPoses,
  kActivations,
  kOrders,
  kLeads,
  kEvents,
  kPushes,
  kLinks,
  kMotors,
  kMarks,
  kFlightStreams
};

/// The first columns of a row of kTicks; the columns of the arms follow.
struct TickRow {
  uint64_t tick = 0, time_ns = 0;
  double t = 0, dt = 0, depth = 0;
  float lateness_us = 0, compute_us = 0;
  int32_t model = -1, status = 0;
};

/// The columns of one arm in a row of kTicks; the columns of its joints follow.
struct ArmRow {
  uint64_t sequence = 0, sample_ns = 0;
  int32_t read_status = 0, write_status = 0;
  uint32_t flags = 0, buttons = 0, fault_before = 0, fault = 0, mode = 0, valid = 0;
  double position[3] = {}, orientation[4] = {}, velocity[3] = {}, force[3] = {}, torque[3] = {}, sent[3] = {};
};

struct ContactRow {
  uint64_t tick = 0;
  uint32_t model = 0, probe = 0, feature = 0, iterations = 0, flags = 0;
  int32_t status = 0;
  double depth = 0, u = 0, v = 0, point[3] = {}, normal[3] = {}, force[3] = {}, torque[3] = {};
  float step_us = 0, gain = 0;
};

struct PoseRow {
  uint64_t tick = 0;
  uint32_t model = 0, reserved = 0;
  double position[3] = {}, orientation[4] = {}, linear[3] = {}, angular[3] = {};
};

struct ActivationRow {
  uint64_t tick = 0;
  uint32_t model = 0, order = 0, surface = 0, probe = 0;
  double u = 0, v = 0, distance = 0;
};

struct OrderRow {
  uint64_t tick = 0;
  uint32_t kind = 0, target = 0, param = 0, place = 0;
  double value = 0, seconds = 0, position[3] = {}, orientation[4] = {};
};

/// A leader's record that the tick accepted.
struct LeadRow {
  uint64_t tick = 0;
  uint32_t led = 0, target = 0;  ///< Order::Led; number of the model or the arm
  hapticd_target wanted{};
};

/// A pushing program's answer that the tick accepted.
struct PushRow {
  uint64_t tick = 0;
  uint32_t arm = 0, place = 0;
  hapticd_push push{};
};

/// The far end of an arm's link, 60 times per second, for programs that draw it.
struct LinkRow {
  uint64_t tick = 0;
  uint32_t arm = 0, link = 0;
  Arm::LinkEnd end{};
};

/// The modelled heat of a motor, 10 times per second.
struct MotorRow {
  uint64_t tick = 0;
  uint32_t arm = 0, joint = 0;
  double winding = 0, share = 0;
};

/// A text with which a program marked the tick, or a part of the description of a model that is about to come.
struct MarkRow {
  uint64_t tick = 0;
  double t = 0;
  int32_t model = -1;  ///< -1: a mark of a program
  uint32_t left = 0;   ///< rows with further parts of the description
  char text[Order::kTextBytes] = {};
};
static_assert(Order::kTextBytes == record::kTextBytes);

/// Further columns of an arm on which programs may push, after the columns of its joints.
struct ClientColumns {
  double force[3] = {}, torque[3] = {};
};

/// [main] Returns the streams of a run. @param rate [Hz] @param seconds length of the black box [s] @param moving
/// number of models that can move
std::vector<record::StreamSpec> flightStreams(const scene::Scene& scene, const Arms& arms, double rate, double seconds,
                                              size_t moving);

class Flight {
 public:
  /// [main] @param ring ring with the streams that flightStreams() gave for these arms
  /// @param places most models that the run can have
  Flight(std::unique_ptr<record::FlightRing> ring, const Arms& arms, size_t places);

  /// [main] For old recordings, in which the depth of a tick was the deepest of all models: a model that gives no
  /// force, because it is disabled or waits for the tip to leave it, counts as those that are felt.
  void countUnfelt() { counts_unfelt_ = true; }

  /// [rt] Called before a tick: notes the time of the tick, and the faults that are latched already.
  void begin(Nanoseconds now, const Arms& arms) noexcept HSP_RT;

  /// [rt] Called for each order that this tick obeys.
  void order(const Order& order) noexcept HSP_RT;

  /// [rt] Called after a tick: writes its rows.
  void tick(double t, double dt, Nanoseconds late, Nanoseconds spent, const Core& core,
            const Arms& arms) noexcept HSP_RT;

  record::FlightRing& ring() { return *ring_; }
  const record::FlightRing& ring() const { return *ring_; }
  uint64_t ticks() const noexcept { return ring_->written(kTicks); }  ///< [any]

  /// [main] Returns the number of the oldest tick that is kept.
  uint64_t oldest() const noexcept;
  /// [main] Reads the row of one tick, and the columns of the first arm in this row. Returns false if the tick is no
  /// longer kept, or if it is still to come.
  bool read(uint64_t tick, TickRow& row, ArmRow& arm) const;
  /// [any] Reads the newest pose of a model that moves. Returns false if no pose is kept.
  bool newestPose(uint32_t model, PoseRow& row) const;
  /// [any] Returns at most `most` events, from number `first` on. Events that are no longer kept are skipped: `first`
  /// becomes the number of the first event that is returned.
  std::vector<hapticd_event> events(uint64_t& first, size_t most) const;
  /// [any] Reads the mark of this number, as an event HAPTICD_MARK has it in `code`. Returns false if it is not kept.
  bool mark(uint64_t number, MarkRow& row) const;

 private:
  /// Offsets of the columns of one arm in a row of kTicks, and its number of joints.
  struct ArmColumns {
    /// 0 if there is no such column.
    uint32_t arm = 0, position = 0, velocity = 0, measured = 0, command = 0, joints = 0, client = 0;
  };
  void tickArm(const ArmColumns& columns, const Arm& arm, const Core& core, uint32_t index,
               std::byte* row) noexcept HSP_RT;
  void contacts(const Core& core, TickRow& tick) noexcept HSP_RT;
  void poses(const Core& core) noexcept HSP_RT;
  void lead(Order::Led led, uint32_t target, const hapticd_target* taken) noexcept HSP_RT;
  void pushes(uint32_t index, const Arm& arm) noexcept HSP_RT;
  void motors(double t, const Arms& arms) noexcept HSP_RT;
  void mark(const Order& order) noexcept HSP_RT;
  void marks(double t) noexcept HSP_RT;
  void links(double t, const Arms& arms) noexcept HSP_RT;
  void events(double t, const Core& core, const Arms& arms) noexcept HSP_RT;
  void activations(const Core& core) noexcept HSP_RT;
  template <class Row>
  void push(FlightStream stream, const Row& row) noexcept HSP_RT;

  std::unique_ptr<record::FlightRing> ring_;
  std::vector<ArmColumns> columns_;
  std::vector<uint32_t> faults_before_;
  static constexpr size_t kMostMarks = 16;  ///< marks of one tick, which obeys no more orders
  std::array<MarkRow, kMostMarks> marks_;   ///< marks of this tick, whose time is not known yet
  size_t mark_count_ = 0;
  Nanoseconds now_ = 0;
  uint64_t tick_ = 0;
  bool counts_unfelt_ = false;             // see countUnfelt()
  double links_due_ = 0, motors_due_ = 0;  ///< [s] times when the next rows are due
  EventFinder events_;
};

}  // namespace hapticd::servo
