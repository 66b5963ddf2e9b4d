// SPDX-License-Identifier: MIT
#include "session/telemetry/telemetry.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "host/built_in.hpp"

namespace hapticd::servo {

Telemetry::Telemetry(const scene::Scene& scene, double rate, uint32_t places)
    : rate_(rate),
      models_(std::max<size_t>(scene.models.size(), places)),
      rows_(static_cast<size_t>(std::ceil(kBlackBoxSeconds * rate))),
      stops_(scene.devices.size()),
      sent_(scene.devices.size()),
      swings_(scene.devices.size()) {
  for (const scene::Device& device : scene.devices) all_devices_.push_back(device.name);
  for (const scene::Model& model : scene.models) {
    names_.push_back(model.name);
    plugins_.push_back(model.plugin);
    libraries_.push_back(model.library.string());
  }
  names_.resize(models_.size());
  plugins_.resize(models_.size());
  libraries_.resize(models_.size());
  work_.resize(models_.size() * scene.devices.size(), record::ContactWork(1 / rate_));
  if (scene.devices.size() < 2) return;
  for (const scene::Device& device : scene.devices) devices_.push_back(device.name);
  by_arm_.resize(models_.size() * devices_.size());
}

std::vector<record::ArmContact> Telemetry::armsOf(size_t place) const {
  std::vector<record::ArmContact> arms;
  for (size_t i = 0; i < devices_.size(); ++i) arms.push_back({devices_[i], by_arm_[place * devices_.size() + i]});
  return arms;
}

record::ModelReport Telemetry::reportOf(size_t place) const {
  record::ModelReport report{.name = names_[place],
                             .plugin = plugins_[place],
                             .contact = models_[place],
                             .arms = armsOf(place),
                             .library = host::findBuiltIn(libraries_[place]) == nullptr ? libraries_[place] : ""};
  for (size_t i = 0; i < stops_.size(); ++i) {
    report.given_j += work_[place * stops_.size() + i].given();
    report.taken_j += work_[place * stops_.size() + i].taken();
    report.began_j += work_[place * stops_.size() + i].began();
  }
  return report;
}

void Telemetry::attach(std::unique_ptr<Flight> flight) {
  flight_ = std::move(flight);
  rows_ = {};
}

void Telemetry::name(uint32_t place, const std::string& name, const std::string& plugin, const std::string& library) {
  if (!names_[place].empty()) {
    if (left_.size() == kMostLeft) left_.erase(left_.begin());
    left_.push_back(reportOf(place));
  }
  models_[place] = {};
  for (size_t i = 0; i < stops_.size(); ++i) work_[place * stops_.size() + i] = record::ContactWork(1 / rate_);
  for (size_t i = 0; i < devices_.size(); ++i) by_arm_[place * devices_.size() + i] = {};
  names_[place] = name;
  plugins_[place] = plugin;
  libraries_[place] = library;
}

void Telemetry::tick(double t, double dt, Nanoseconds late, const TickDuration& spent, const Core& core,
                     const Arms& arms) noexcept HSP_RT {
  BlackBoxRow row;
  row.t = t;
  simulated_seconds_ = t + 1 / rate_;
  row.lateness_us = static_cast<float>(static_cast<double>(late) * 1e-3);
  row.compute_us = static_cast<float>(static_cast<double>(spent.total) * 1e-3);
  lateness_us_.add(row.lateness_us);
  compute_us_.add(row.compute_us);
  arms_us_.add(static_cast<double>(spent.in_arms) * 1e-3);
  recordModels(dt, core, arms, row);
  if (flight_) flight_->tick(t, dt, late, spent.total, core, arms);
  if (status_) status_->tick({recorded_, overruns_, missed_, t}, late, spent.total, core, arms, models_);
  ++recorded_;
  for (size_t i = 0; i < arms.size() && i < stops_.size(); ++i) {
    sent_[i].add(*arms[i]);
    if (!arms[i]->probe().valid) continue;
    stops_[i].add(arms[i]->info(), arms[i]->sample());
    if (arms[i]->limiter().fault() == Fault::kNone) swings_[i].add(t, arms[i]->probe().position);
  }
  if (!arms.empty()) {
    const Arm& arm = *arms.front();
    for (int i = 0; i < 3; ++i) {
      row.position[static_cast<size_t>(i)] = static_cast<float>(arm.probe().position[i]);
      row.force[static_cast<size_t>(i)] = static_cast<float>(arm.force()[i]);
    }
    row.fault = static_cast<uint32_t>(arm.limiter().fault());
  }
  newest_ = row;
  if (!rows_.empty()) keep(row);
}

void Telemetry::keep(const BlackBoxRow& row) noexcept HSP_RT {
  rows_[next_] = row;
  next_ = next_ + 1 == rows_.size() ? 0 : next_ + 1;
  if (row_count_ < rows_.size()) ++row_count_;
}

namespace {

/// True in a fault, in a hold, at the planned end of a run, and while the enable switch is off.
bool forceless(const Arm& arm) noexcept HSP_RT {
  return arm.limiter().fault() != Fault::kNone || !arm.limiter().enabled();
}

}  // namespace

/// True while no arm may push. The depth of the hand and the force that the model asks for are not counted then: nobody
/// feels them.
bool Telemetry::withoutForce(const Arms& arms) noexcept HSP_RT {
  return !arms.empty() && std::all_of(arms.begin(), arms.end(), [](const auto& arm) { return forceless(*arm); });
}

void Telemetry::recordArms(uint32_t index, double dt, const Core& core, const Arms& arms) noexcept HSP_RT {
  for (uint32_t arm = 0; arm < devices_.size() && arm < core.probeCount(); ++arm) {
    if (arm < arms.size() && forceless(*arms[arm])) continue;
    const Contact& contact = core.contact(index, arm);
    const double force = Eigen::Map<const Vector3d>(contact.world.force).norm();
    const bool felt = core.models()[index].guard.gain() > 0, inside = contact.traced && contact.world.depth_m > 0;
    record::ContactStatistics& book = by_arm_[index * devices_.size() + arm];
    book.add(inside && felt, contact.world.depth_m, force, dt, 0);
    if (inside && !felt) book.addUnfelt();
  }
}

void Telemetry::recordWork(uint32_t index, double dt, const Core& core, const Arms& arms) noexcept HSP_RT {
  for (uint32_t arm = 0; arm < stops_.size() && arm < core.probeCount() && arm < arms.size(); ++arm) {
    if (!arms[arm]->probe().valid) continue;
    const Contact& contact = core.contact(index, arm);
    work_[index * stops_.size() + arm].add(recorded_, dt, Eigen::Map<const Vector3d>(contact.world.force),
                                           arms[arm]->probe().position, contact.traced ? contact.world.depth_m : 0);
  }
}

/// Returns the force [N] with which a contact pulls the probe deeper in, or 0.
double Telemetry::pullOf(const Contact& contact, const Arm& arm) noexcept HSP_RT {
  const bool pulls = contact.world.depth_m > 0 && arm.probe().valid && pullsIn(contact.world, arm.probe().position);
  return pulls ? Eigen::Map<const Vector3d>(contact.world.force).norm() : 0;
}

void Telemetry::recordModels(double dt, const Core& core, const Arms& arms, BlackBoxRow& row) noexcept HSP_RT {
  const bool pushed = !withoutForce(arms);
  for (const uint32_t index : core.live()) {
    const ModelState& model = core.models()[index];
    if (model.status < row.status) row.status = model.status;
    double depth = -HUGE_VAL, force = 0;
    ImproperForce odd;
    bool held = false;
    for (uint32_t probe = 0; probe < core.probeCount(); ++probe) {
      const Contact& contact = core.contact(index, probe);
      const double size = Eigen::Map<const Vector3d>(contact.world.force).norm();
      if (!contact.traced) {
        odd.untraced = std::max(odd.untraced, size);
        continue;
      }
      const double deep = contact.world.depth_m;
      if (deep > depth) held = (contact.world.flags & HSP_OUT_HELD) != 0;
      depth = std::max(depth, deep);
      force = std::max(force, size);
      if (probe < arms.size()) odd.pull = std::max(odd.pull, pullOf(contact, *arms[probe]));
      if (deep > 0) continue;
      double& shallow = deep < 0 ? odd.outside : odd.depthless;
      shallow = std::max(shallow, size);
    }
    const bool felt = model.guard.gain() > 0;
    models_[index].add(depth > 0 && pushed && felt, depth, force, dt, model.step_ns);
    if (depth > 0 && pushed && !felt) models_[index].addUnfelt();
    if (depth > -HUGE_VAL && model.status >= HSP_OK) models_[index].addFoot(held, model.status == HSP_DEGRADED);
    // The force with which a model in trouble fades out is not its answer, so it is not counted.
    const bool any = odd.untraced + odd.depthless + odd.outside + odd.pull > 0;
    if (any && pushed && model.status >= HSP_OK && !model.guard.silenced()) recordImproper(index, odd);
    recordArms(index, dt, core, arms);
    if (pushed) recordWork(index, dt, core, arms);
    if (depth > -HUGE_VAL && (row.model == UINT32_MAX || depth > row.depth_m)) {
      row.depth_m = static_cast<float>(depth);
      row.model = index;
    }
  }
}

void Telemetry::recordImproper(uint32_t index, const ImproperForce& odd) noexcept HSP_RT {
  if (odd.untraced > 0) models_[index].addUntraced(odd.untraced);
  if (odd.depthless > 0) models_[index].addDepthless(odd.depthless);
  if (odd.outside > 0) models_[index].addOutside(odd.outside);
  if (odd.pull > 0) models_[index].addPull(odd.pull);
}

void Telemetry::finish(uint64_t ticks, Nanoseconds elapsed, long page_faults, uint64_t allocations) noexcept {
  ticks_ = ticks;
  elapsed_ = elapsed;
  page_faults_ = page_faults;
  allocations_ = allocations;
}

record::RunReport Telemetry::report(const std::vector<std::string>& faults) const {
  record::RunReport report;
  report.ticks = ticks_;
  report.wall_seconds = static_cast<double>(elapsed_) * kSecondsPerNanosecond;
  report.seconds = simulated_seconds_;
  report.rate_hz = simulated_seconds_ > 0 ? static_cast<double>(ticks_) / simulated_seconds_ : 0;
  report.overruns = overruns_;
  report.missed_ticks = missed_;
  report.lateness_us = lateness_us_;
  report.compute_us = compute_us_;
  report.arms_us = arms_us_;
  report.page_faults = page_faults_;
  report.servo_allocations = allocations_;
  for (size_t i = 0; i < models_.size(); ++i)
    if (!names_[i].empty()) report.models.push_back(reportOf(i));
  // Names are keys in the report, and a removed model is often replaced by one with the same name.
  std::map<std::string, int> times;
  for (record::ModelReport left : left_) {
    const int before = times[left.name]++;
    left.name += before == 0 ? " (removed)" : " (removed " + std::to_string(before + 1) + ")";
    report.models.push_back(std::move(left));
  }
  report.clients = clients_;
  for (size_t i = 0; i < stops_.size(); ++i)
    for (uint32_t joint = 0; joint < HDV_MAX_JOINTS; ++joint)
      if (stops_[i].ticks(joint) > 0) report.stops.push_back({all_devices_[i], joint, stops_[i].ticks(joint)});
  report.faults = faults;
  return report;
}

std::vector<BlackBoxRow> Telemetry::fromFlight() const {
  std::vector<BlackBoxRow> rows;
  TickRow tick;
  ArmRow arm;
  for (uint64_t n = flight_->oldest(); flight_->read(n, tick, arm); ++n) {
    BlackBoxRow row;
    row.t = tick.t;
    row.lateness_us = tick.lateness_us, row.compute_us = tick.compute_us;
    for (size_t i = 0; i < 3; ++i) {
      row.position[i] = static_cast<float>(arm.position[i]);
      row.force[i] = static_cast<float>(arm.sent[i]);
    }
    row.depth_m = tick.model >= 0 ? static_cast<float>(tick.depth) : 0;
    row.model = tick.model >= 0 ? static_cast<uint32_t>(tick.model) : UINT32_MAX;
    row.status = tick.status;
    row.fault = arm.fault;
    rows.push_back(row);
  }
  return rows;
}

std::vector<BlackBoxRow> Telemetry::blackBox() const {
  if (flight_) return fromFlight();
  std::vector<BlackBoxRow> ordered;
  ordered.reserve(row_count_);
  const size_t oldest = row_count_ < rows_.size() ? 0 : next_;
  for (size_t i = 0; i < row_count_; ++i) ordered.push_back(rows_[(oldest + i) % rows_.size()]);
  return ordered;
}

}  // namespace hapticd::servo
