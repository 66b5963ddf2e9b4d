// SPDX-License-Identifier: MIT
#include "session/replay/replay.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>

#include "base/not_real_time.hpp"
#include "base/offline_tick.hpp"
#include "session/messages/setup_watch.hpp"
#include "session/replay/replayable.hpp"
#include "world/arm_force.hpp"

namespace hapticd::servo {

namespace {

using record::Column;
using record::RecordedStream;

/// [s] length of the replay's own black box; short, because rows are compared at once
constexpr double kKeptSeconds = 0.1;

/// True for columns of measured times, which are not compared because they differ from run to run.
bool measured(const std::string& column) {
  return column == "lateness_us" || column == "compute_us" || column == "step_us";
}

template <class T>
T at(const std::byte* row, uint32_t offset) {
  T value;
  std::memcpy(&value, row + offset, sizeof value);
  return value;
}

/// The columns of one arm's sample in a row of ticks.
struct SampleColumns {
  const Column *sequence, *time, *flags, *buttons, *read_status, *write_status, *fault_before, *sent;
  const Column *position, *velocity, *measured;
};

SampleColumns sampleColumns(const RecordedStream& ticks, size_t index) {
  const std::string arm = "arm" + std::to_string(index) + "_";
  const auto find = [&](const char* name) { return ticks.find(arm + name); };
  return {find("sequence"),    find("sample_ns"),    find("flags"),        find("buttons"),
          find("read_status"), find("write_status"), find("fault_before"), find("sent_fx"),
          find("q0"),          find("dq0"),          find("measured0")};
}

}  // namespace

/// A clock that, before each tick, compares the rows of the last tick and prepares the recorded inputs of the next one.
class Replay::Player final : public Clock {
 public:
  Player(Replay& replay, const record::FlightRing& ring)
      : replay_(replay), ring_(ring), ticks_(*replay.recording_.stream("ticks")) {
    for (const record::StreamSpec& spec : ring.specs()) recorded_.push_back(replay.recording_.stream(spec.name));
    for (size_t i = 0; i < replay.arms_.size(); ++i) arms_.push_back(sampleColumns(ticks_, i));
    compared_.resize(recorded_.size());
    outcome.recorded_ticks = ticks_.rows();
    now_ = timeOf(0);
    end_ = std::min(ticks_.rows(), replay.later_.end());
    if (end_ < ticks_.rows()) outcome.note = replay.later_.why();
  }

  Nanoseconds now() noexcept HSP_RT override { return now_; }

  Nanoseconds waitUntil(Nanoseconds deadline) noexcept HSP_RT override {
    counted_.reset();
    const NotRealTime between_ticks;
    compare();
    if (tick_ >= end_) {
      replay_.loop_->stop();
      return now_ = std::max(deadline, now_);
    }
    now_ = replay_.paced_ ? timeOf(tick_) : std::max(timeOf(tick_), deadline);
    destroyReleased();
    feedArms();
    feedOrders();
    feedRecords();  // after the orders: a record may be for a model that comes in this tick
    feedLeads();
    feedPushes();
    ++tick_;
    counted_.emplace();
    return now_;
  }

  void compare() {
    // Streams that can cause differences in others come first, so that the first difference found is the cause.
    for (const size_t stream : {kPushes, kLeads, kContacts, kPoses, kActivations, kOrders, kTicks}) {
      if (recorded_[stream] == nullptr) continue;
      const RecordedStream& then = *recorded_[stream];
      for (uint64_t& row = compared_[stream];
           row < ring_.written(stream) && row < then.rows() && at<uint64_t>(then.row(row), 0) < end_; ++row)
        compareRow(stream, row);
    }
    outcome.ticks = compared_[kTicks];
  }

  ReplayOutcome outcome;

 private:
  Nanoseconds timeOf(uint64_t row) const { return at<uint64_t>(ticks_.row(row), ticks_.find("time_ns")->offset); }

  void feedArms() {
    const std::byte* row = ticks_.row(tick_);
    for (size_t i = 0; i < arms_.size(); ++i) {
      const SampleColumns& columns = arms_[i];
      host::Playback& playback = *replay_.playbacks_[i];
      hdv_sample& sample = playback.sample;
      sample.sequence = at<uint64_t>(row, columns.sequence->offset);
      sample.time_ns = at<uint64_t>(row, columns.time->offset);
      sample.flags = at<uint32_t>(row, columns.flags->offset);
      sample.buttons = at<uint32_t>(row, columns.buttons->offset);
      playback.read_status = at<int32_t>(row, columns.read_status->offset);
      playback.write_status = at<int32_t>(row, columns.write_status->offset);
      const size_t bytes = replay_.arms_[i]->info().joint_count * sizeof(double);
      std::memcpy(sample.position, row + columns.position->offset, bytes);
      if (columns.velocity != nullptr) std::memcpy(sample.velocity, row + columns.velocity->offset, bytes);
      if (columns.measured != nullptr) std::memcpy(sample.torque, row + columns.measured->offset, bytes);
      // The replayed arm did not find this fault by itself, so it came from outside in the recorded run: from a stop or
      // a watchdog.
      const auto fault = at<uint32_t>(row, columns.fault_before->offset);
      if (fault != 0) replay_.arms_[i]->limiter().trip(static_cast<Fault>(fault));
    }
  }

  /// Destroys the models that the servo has released, as a daemon does, so that their places are empty.
  void destroyReleased() {
    uint32_t place = 0;
    while (replay_.world_->core().takeReleased(place)) replay_.world_->destroy(place);
  }

  /// True if a record is for a surface of a model, or for a model that has left, for which the servo ignores records.
  bool isPossible(const ActivationRow& row) const {
    const World& world = *replay_.world_;
    if (row.model >= world.places() || row.order > 2 || row.probe >= replay_.arms_.size()) return false;
    const auto& shape = world.shapes()[row.model];
    return !shape || (shape->surfaces() != nullptr && row.surface < shape->surfaces()->surface_count);
  }

  void feedRecords() {
    const RecordedStream& stream = *recorded_[kActivations];
    for (; activation_ < stream.rows(); ++activation_) {
      const auto row = at<ActivationRow>(stream.row(activation_), 0);
      if (row.tick > tick_) return;
      if (!isPossible(row)) continue;  // a damaged row is ignored; the forces will differ
      const hsp_near near{row.surface, row.probe, {row.u, row.v}, row.distance};
      replay_.world_->link().records.push({row.model, static_cast<link::ActivationRecord::Order>(row.order), near});
    }
  }

  void feedOrders() {
    const RecordedStream& stream = *recorded_[kOrders];
    for (; order_ < stream.rows(); ++order_) {
      const auto row = at<OrderRow>(stream.row(order_), 0);
      if (row.tick > tick_) return;
      Order order;
      order.kind = static_cast<Order::Kind>(row.kind);
      order.target = row.target;
      order.param = row.param;
      order.value = row.value;
      order.seconds = row.seconds;
      std::memcpy(order.position, row.position, sizeof order.position);
      std::memcpy(order.orientation, row.orientation, sizeof order.orientation);
      order.place = row.place;
      if (order.kind == Order::Kind::kLead && row.param == static_cast<uint32_t>(Order::Led::kForce))
        order.push = newPushSlot(row.target, row.place);
      else if (order.kind == Order::Kind::kLead)
        order.slot = newSlot(row.param, row.target);
      else if (order.kind == Order::Kind::kAdopt)
        order.model = replay_.later_.adopt(row.target, *replay_.world_);
      else if (order.kind == Order::Kind::kRelease)
        replay_.world_->forget(row.target);
      replay_.loop_->post(order);
    }
  }

  /// Makes the memory of a leader, a new one for each leader.
  const link::PoseSlot* newSlot(uint32_t led, uint32_t target) {
    auto slot = std::make_unique<link::PoseSlot>();
    leads_[{led, target}] = slot.get();
    slots_.push_back(std::move(slot));
    return slots_.back().get();
  }

  /// Writes the recorded records of leaders into their memory, so that the servo reads them in the same tick.
  void feedLeads() {
    if (recorded_[kLeads] == nullptr) return;
    for (const RecordedStream& stream = *recorded_[kLeads]; lead_ < stream.rows(); ++lead_) {
      const auto row = at<LeadRow>(stream.row(lead_), 0);
      if (row.tick > tick_) return;
      const auto found = leads_.find({row.led, row.target});
      if (found != leads_.end()) found->second->put(row.wanted);
    }
  }

  const link::PushSlot* newPushSlot(uint32_t arm, uint32_t place) {
    push_slots_.push_back(std::make_unique<link::PushSlot>());
    pushes_[{arm, place}] = push_slots_.back().get();
    return push_slots_.back().get();
  }

  /// Writes the recorded answers of pushing programs into their memory, as feedLeads() does for leaders.
  void feedPushes() {
    if (recorded_[kPushes] == nullptr) return;
    for (const RecordedStream& stream = *recorded_[kPushes]; push_ < stream.rows(); ++push_) {
      const auto row = at<PushRow>(stream.row(push_), 0);
      if (row.tick > tick_) return;
      const auto found = pushes_.find({row.arm, row.place});
      if (found != pushes_.end()) found->second->put(row.push);
    }
  }

  void compareRow(size_t stream, uint64_t row) {
    const record::StreamSpec& spec = ring_.specs()[stream];
    std::vector<std::byte> now(ring_.rowBytes(stream));
    if (ring_.copy(stream, row, 1, now.data()) != 1) return;
    const std::byte* then = recorded_[stream]->row(row);
    if (stream == kTicks) compareForces(then, now.data());
    if (stream == kTicks && replay_.each_) replay_.each_(then, now.data());
    if (outcome.first) return;
    for (const Column& column : spec.layout.columns()) {
      if (measured(column.name)) continue;
      const size_t bytes = bytesOf(column.type);
      if (std::memcmp(then + column.offset, now.data() + column.offset, bytes) == 0) continue;
      Difference found;
      found.tick = at<uint64_t>(then, 0);
      found.t =
          static_cast<double>(timeOf(std::min(found.tick, ticks_.rows() - 1)) - timeOf(0)) * kSecondsPerNanosecond;
      found.what = spec.name + ": " + column.name + subject(stream, then);
      found.recorded = record::numberOf(then, column);
      found.replayed = record::numberOf(now.data(), column);
      if (!outcome.first || found.tick < outcome.first->tick) outcome.first = found;
      return;
    }
  }

  void compareForces(const std::byte* then, const std::byte* now) {
    for (const SampleColumns& arm : arms_) {
      double square = 0;
      for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t offset = arm.sent->offset + i * static_cast<uint32_t>(sizeof(double));
        const double error = at<double>(then, offset) - at<double>(now, offset);
        square += error * error;
      }
      outcome.largest_force_error = std::max(outcome.largest_force_error, std::sqrt(square));
    }
  }

  std::string subject(size_t stream, const std::byte* row) const {
    if (stream != kContacts && stream != kPoses) return "";
    const auto model = at<uint32_t>(row, 8);
    const auto& models = replay_.run_.scene.models;
    if (const RunModel* later = laterModel(replay_.run_.later, model, at<uint64_t>(row, 0)))
      return " of model " + later->model.name;
    return model < models.size() ? " of model " + models[model].name : "";
  }

  Replay& replay_;
  std::optional<OfflineTick> counted_;  ///< set while a tick runs
  const record::FlightRing& ring_;
  const RecordedStream& ticks_;
  std::vector<const RecordedStream*> recorded_;
  std::vector<SampleColumns> arms_;
  std::vector<uint64_t> compared_;
  uint64_t tick_ = 0, activation_ = 0, order_ = 0, lead_ = 0, push_ = 0, end_ = 0;
  std::vector<std::unique_ptr<link::PoseSlot>> slots_;
  std::map<std::pair<uint32_t, uint32_t>, link::PoseSlot*> leads_;  ///< newest memory, by target of the lead
  std::vector<std::unique_ptr<link::PushSlot>> push_slots_;
  std::map<std::pair<uint32_t, uint32_t>, link::PushSlot*> pushes_;  ///< newest memory, by arm and place
  Nanoseconds now_ = 0;
};

Replay::Replay(const record::Recording& recording, RecordedRun run) : recording_(recording), run_(std::move(run)) {}
Replay::~Replay() = default;

Result<std::unique_ptr<Replay>> Replay::prepare(const record::Recording& recording, RecordedRun run,
                                                const host::Services::Log& log) {
  std::unique_ptr<Replay> replay(new Replay(recording, std::move(run)));
  const scene::Scene& scene = replay->run_.scene;
  const RunFacts& facts = replay->run_.facts;
  if (auto built = replay->buildWorld(log); !built) return Error{built.error()};
  if (auto opened = replay->openArms(log); !opened) return Error{opened.error()};
  const size_t models = scene.models.size() + replay->run_.later.size();
  const auto streams = flightStreams(scene, replay->arms_, facts.rate, kKeptSeconds, models);
  if (const std::string missing = missingIn(recording, replay->run_, streams); !missing.empty())
    return Error{"the recording " + missing};
  replay->buildLater(log);
  auto ring = record::FlightRing::create(streams, {});
  if (!ring) return Error{ring.error()};
  const uint32_t places = replay->world_->places();
  replay->telemetry_ = std::make_unique<Telemetry>(scene, facts.rate, places);
  replay->telemetry_->attach(std::make_unique<Flight>(std::move(*ring), replay->arms_, places));
  if (facts.counts_unfelt) replay->telemetry_->flight()->countUnfelt();
  replay->player_ = std::make_unique<Player>(*replay, replay->telemetry_->flight()->ring());
  LoopSettings settings;
  settings.period_ns = facts.period_ns;
  settings.ticks = facts.ticks;
  settings.paced = replay->paced_ = pacingArm(scene.servo, replay->arms_) != nullptr;
  replay->loop_ = std::make_unique<Loop>(replay->world_->core(), replay->world_->lockstep(), replay->arms_,
                                         *replay->player_, settings, *replay->telemetry_);
  return replay;
}

Result<void> Replay::buildWorld(const host::Services::Log& log) {
  const scene::Scene& scene = run_.scene;
  WorldOptions options;
  options.rate = run_.facts.rate;
  options.probe_count = static_cast<uint32_t>(scene.devices.size());
  options.max_force = maxForceOf(scene, run_.devices);
  options.former_claims = run_.facts.former_claims;
  options.gaps_jump = !run_.facts.follows_gaps;
  options.keep_disabled = true;
  options.spare_models = LaterModels::placesFor(run_.later, scene.models.size());
  const SetupWatch waiting(log);
  auto world = World::build(scene, options, log);
  if (!world) return Error{world.error()};
  world_ = std::move(*world);
  return {};
}

Result<void> Replay::openArms(const host::Services::Log& log) {
  const scene::Scene& scene = run_.scene;
  const RunFacts& facts = run_.facts;
  for (size_t i = 0; i < scene.devices.size(); ++i) {
    playbacks_.push_back(std::make_unique<host::Playback>());
    playbacks_[i]->info = run_.devices[i];
    auto arm = Arm::open(scene.devices[i], scene.servo,
                         {facts.rate, world_->needsVelocity(), playbacks_[i].get(), scene.clients, facts.found_pressed,
                          facts.full_when_slow, facts.former_passivity},
                         log);
    if (!arm) return Error{arm.error()};
    arms_.push_back(std::move(*arm));
  }
  return {};
}

void Replay::buildLater(const host::Services::Log& log) {
  const SetupWatch waiting(log);
  later_.build(*recording_.stream("orders"), run_.later, *world_, log);
}

ReplayOutcome Replay::run(const EachTick& each) {
  each_ = each;
  const Nanoseconds start = player_->now();
  for (const auto& arm : arms_)
    if (auto started = arm->start(start, run_.scene.servo.gravity); !started) {
      player_->outcome.note = started.error();
      return player_->outcome;
    }
  loop_->run();
  player_->compare();
  return player_->outcome;
}

}  // namespace hapticd::servo
