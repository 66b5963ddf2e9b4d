// SPDX-License-Identifier: MIT
#include "conformance/subject.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <initializer_list>

#include "base/allocation_count.hpp"
#include "base/clock.hpp"
#include "base/thread_usage.hpp"
#include "conformance/allocation_place.hpp"
#include "conformance/building_blocks.hpp"
#include "conformance/lock_count.hpp"
#include "conformance/step_watch.hpp"
#include "host/class_table.hpp"

namespace hapticd::conformance {

namespace {

using Eigen::Vector3d;
constexpr uint8_t kUntouched = 0xA5;
constexpr double kTurned[4] = {0.8, 0.36, 0.48, 0};  // any rotation other than the identity

struct Usage {
  uint64_t cpu_ns = 0;
  long waits = 0;
};

Usage usageOfThread() {
  rusage use{};
  getrusage(RUSAGE_THREAD, &use);
  return {os::cpuTimeOfThread(), use.ru_nvcsw};
}

}  // namespace

bool sameBits(const Answer& a, const Answer& b) {
  return a.status == b.status && a.contacts.size() == b.contacts.size() &&
         std::memcmp(a.contacts.data(), b.contacts.data(), a.contacts.size() * sizeof(hsp_contact)) == 0 &&
         std::memcmp(&a.pose, &b.pose, sizeof a.pose) == 0;
}

namespace {

/// An output of a step: some numbers that lie one behind the other.
struct Output {
  const char* name;
  const double* values;
  size_t count;
};

/// Returns the first number that is not finite, such as "contact.force[1] is nan", or "".
std::string notFiniteOf(std::initializer_list<Output> outputs) {
  for (const Output& output : outputs)
    for (size_t i = 0; i < output.count; ++i)
      if (!std::isfinite(output.values[i]))
        return output.name + (output.count > 1 ? "[" + std::to_string(i) + "]" : std::string()) + " is " +
               (std::isnan(output.values[i]) ? "nan" : text(output.values[i]));
  return "";
}

std::string notFiniteIn(const hsp_contact& c) {
  std::string wrong = notFiniteOf({{"contact.force", c.force, 3}, {"contact.torque", c.torque, 3}});
  if (wrong.empty() && (c.flags & HSP_OUT_TRACED) != 0)
    wrong = notFiniteOf({{"contact.point", c.point, 3},
                         {"contact.normal", c.normal, 3},
                         {"contact.depth_m", &c.depth_m, 1},
                         {"contact.param", c.param, 2}});
  return wrong.empty() ? notFiniteOf({{"contact.stiffness", &c.stiffness, 1}}) : wrong;
}

}  // namespace

std::string notFinite(const Answer& answer) {
  const hsp_pose& pose = answer.pose;
  std::string wrong = notFiniteOf({{"pose.position", pose.position, 3},
                                   {"pose.orientation", pose.orientation, 4},
                                   {"pose.linear", pose.linear, 3},
                                   {"pose.angular", pose.angular, 3}});
  for (size_t i = 0; wrong.empty() && i < answer.contacts.size(); ++i) {
    wrong = notFiniteIn(answer.contacts[i]);
    if (!wrong.empty() && answer.contacts.size() > 1) wrong = "for probe " + std::to_string(i + 1) + " " + wrong;
  }
  return wrong.empty() ? "" : wrong + "; expected a finite number";
}

bool finite(const Answer& answer) {
  return notFinite(answer).empty();
}

Result<std::unique_ptr<Subject>> Subject::make(const Recipe& recipe) {
  auto library = host::Library::open(recipe.file);
  if (!library) return Error{library.error()};
  auto entry = (*library)->shapes();
  if (!entry) return Error{entry.error()};
  std::unique_ptr<Subject> subject(new Subject);
  subject->library_ = *library;
  subject->places_ = recipe.touch.places;
  subject->services_ = std::make_unique<host::Services>(recipe.class_name, nullptr);
  subject->class_ = host::findClass<hsp_class>(**entry, recipe.class_name);
  if (subject->class_ == nullptr || !host::complete(*subject->class_)) return Error{"lacks a required function"};
  const hsp_class& c = *subject->class_;
  {
    const CallWatch watch(Inside::kCreate);
    subject->shape_ = c.create(&c, subject->services_->abi());
  }
  if (subject->shape_ == nullptr) return Error{"create() made no instance: " + subject->services_->lastError()};
  for (uint32_t i = 0; i < c.param_count; ++i) {
    const scene::Value* given = givenIn(recipe.set, paramAt(c, i).id);
    if (host::damps(c, i))
      subject->damping_ = std::max(subject->damping_, given != nullptr ? given->number : paramAt(c, i).def);
    if (given == nullptr) continue;
    const hsp_value value = host::toAbi(*given);
    const CallWatch watch(Inside::kSet);
    if (c.set(subject->shape_, i, &value) < 0)
      return Error{"set(" + given->id + "): " + subject->services_->lastError()};
  }
  return subject;
}

Subject::~Subject() {
  const CallWatch watch(Inside::kDestroy);
  deactivate();
  if (shape_ != nullptr) class_->destroy(shape_);
}

hsp_status Subject::activateRaw(uint32_t probes, hsp_report& report) {
  hsp_activation how{};
  how.struct_size = sizeof how;
  how.max_probes = probes;
  how.rate_hz = 1000;
  how.max_probe_speed = 20;
  how.gravity[1] = -9.81;
  how.pose.orientation[0] = 1;
  report = {};
  report.struct_size = sizeof report;
  const CallWatch watch(Inside::kActivate);
  return class_->activate(shape_, &how, &report);
}

Result<void> Subject::activate(uint32_t probes) {
  if (activateRaw(probes, report_) < 0) return Error{"activate(): " + services_->lastError()};
  active_ = true;
  pose_ = {};
  pose_.orientation[0] = 1;
  steps_ = ticks_ = allocations_ = locks_ = 0;
  last_.clear();
  const auto* surfaces = static_cast<const hsp_ext_surfaces*>(extension(HSP_EXT_SURFACES));
  traced_.assign(probes, std::vector<uint8_t>(surfaces != nullptr ? surfaces->surface_count : 0, 0));
  return {};
}

void Subject::deactivate() {
  if (active_) class_->deactivate(shape_);
  active_ = false;
}

const void* Subject::extension(const char* name) const {
  if (!HSP_HAS(class_, extension) || class_->extension == nullptr) return nullptr;
  return class_->extension(shape_, name);
}

double Subject::energy() const {
  const auto* energy = static_cast<const hsp_ext_energy*>(extension(HSP_EXT_ENERGY));
  return energy != nullptr ? energy->stored(shape_) : std::nan("");
}

std::pair<Vector3d, Vector3d> Subject::bounds() const {
  const auto* geometry = static_cast<const hsp_ext_geometry*>(extension(HSP_EXT_GEOMETRY));
  Vector3d low(-0.1, -0.1, -0.1), high = -low;
  if (geometry != nullptr && geometry->bounds(shape_, low.data(), high.data()) != HSP_OK)
    return {Vector3d(-0.1, -0.1, -0.1), Vector3d(0.1, 0.1, 0.1)};
  return {low, high};
}

void Subject::search(const std::vector<hsp_probe>& probes) {
  const auto* surfaces = static_cast<const hsp_ext_surfaces*>(extension(HSP_EXT_SURFACES));
  if (surfaces == nullptr) return;
  constexpr double kReach = 0.15;
  std::vector<hsp_near> found(surfaces->surface_count);
  for (uint32_t probe = 0; probe < probes.size(); ++probe) {
    std::vector<uint8_t> seen(surfaces->surface_count, 0);
    const int64_t count = surfaces->nearby(shape_, probes[probe].position, kReach, found.data(), found.size());
    for (int64_t i = 0; i < std::min<int64_t>(count, static_cast<int64_t>(found.size())); ++i) {
      hsp_near near = found[static_cast<size_t>(i)];
      near.probe = probe;
      seen[near.surface] = traced_[probe][near.surface] = 1;
      surfaces->activate(shape_, &near);
    }
    for (uint32_t s = 0; s < seen.size(); ++s)
      if (traced_[probe][s] != 0 && seen[s] == 0) {
        surfaces->deactivate(shape_, probe, s);
        traced_[probe][s] = 0;
      }
  }
}

const Answer& Subject::step(const std::vector<Vector3d>& positions, double dt, uint32_t flags) {
  std::vector<hsp_probe> probes(positions.size());
  for (size_t i = 0; i < positions.size(); ++i) {
    Eigen::Map<Vector3d>(probes[i].position) = positions[i];
    probes[i].orientation[0] = 1;
    probes[i].flags = flags;
    probes[i].time_ns = ticks_ * 1'000'000;
    const bool moved = dt > 0 && i < last_.size() && (flags & HSP_IN_JUMP) == 0;
    if (moved && ((report_.flags | given_) & HSP_R_VELOCITY) != 0)
      Eigen::Map<Vector3d>(probes[i].velocity) = (positions[i] - last_[i]) / dt;
    if ((given_ & HSP_R_ORIENTATION) != 0) std::copy_n(kTurned, 4, probes[i].orientation);
  }
  last_ = positions;
  if (steps_ % 5 == 0 || (flags & HSP_IN_JUMP) != 0) search(probes);
  return run(probes, dt);
}

const Answer& Subject::stepRaw(const hsp_probe& probe, double dt) {
  return run({probe}, dt);
}

const Answer& Subject::run(const std::vector<hsp_probe>& probes, double dt) {
  const size_t in_stride = sizeof(hsp_probe) + room_, out_stride = sizeof(hsp_contact) + room_;
  in_.assign(probes.size() * in_stride, kUntouched);
  out_.assign(probes.size() * out_stride, kUntouched);
  for (size_t i = 0; i < probes.size(); ++i) {
    std::memcpy(&in_[i * in_stride], &probes[i], sizeof(hsp_probe));
    std::memset(&out_[i * out_stride], 0, sizeof(hsp_contact));
  }
  hsp_step step{};
  step.struct_size = sizeof step;
  step.count = static_cast<uint32_t>(probes.size());
  step.in = reinterpret_cast<const hsp_probe*>(in_.data());
  step.in_stride = static_cast<uint32_t>(in_stride);
  step.out = reinterpret_cast<hsp_contact*>(out_.data());
  step.out_stride = static_cast<uint32_t>(out_stride);
  step.dt_s = steps_ == 0 || stopped_ ? 0 : dt;
  step.pose = &pose_;
  call(step);
  answer_.contacts.resize(probes.size());
  for (size_t i = 0; i < probes.size(); ++i)
    std::memcpy(&answer_.contacts[i], &out_[i * out_stride], sizeof(hsp_contact));
  answer_.pose = pose_;
  answer_.jumped =
      std::any_of(probes.begin(), probes.end(), [](const hsp_probe& p) { return (p.flags & HSP_IN_JUMP) != 0; });
  ++steps_;
  if (!stopped_) ++ticks_;
  return answer_;
}

void Subject::call(const hsp_step& step) {
  const Usage used = measured_ ? usageOfThread() : Usage{};
  const uint64_t before = allocationsOfThread(), locked = locksCounted();
  const Nanoseconds begun = monotonicNow();
  {
    const StepWatch watch(step);
    const AllocationWatch allocations;
    answer_.status = class_->step(shape_, &step);
  }
  step_ns_ = monotonicNow() - begun;
  allocations_ += allocationsOfThread() - before;
  locks_ += locksCounted() - locked;
  if (!measured_) return;
  const Usage now = usageOfThread();
  cost_ = {step_ns_, now.cpu_ns - used.cpu_ns, now.waits != used.waits};
}

bool Subject::roomUntouched() const {
  const size_t out_stride = sizeof(hsp_contact) + room_;
  for (size_t i = 0; i < out_.size(); ++i)
    if (i % out_stride >= sizeof(hsp_contact) && out_[i] != kUntouched) return false;
  return true;
}

void Subject::reserve(size_t probes) {
  in_.assign(probes * (sizeof(hsp_probe) + room_), kUntouched);
  out_.assign(probes * (sizeof(hsp_contact) + room_), kUntouched);
}

void Subject::reset() {
  class_->reset(shape_);
  const auto* surfaces = static_cast<const hsp_ext_surfaces*>(extension(HSP_EXT_SURFACES));
  for (uint32_t probe = 0; surfaces != nullptr && probe < traced_.size(); ++probe)
    for (uint32_t s = 0; s < traced_[probe].size(); ++s) {
      if (traced_[probe][s] != 0) surfaces->deactivate(shape_, probe, s);
      traced_[probe][s] = 0;
    }
  last_.clear();
  steps_ = ticks_ = 0;
}

}  // namespace hapticd::conformance
