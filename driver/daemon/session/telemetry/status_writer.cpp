// SPDX-License-Identifier: MIT
#include "session/telemetry/status_writer.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "session/telemetry/event_finder.hpp"

namespace hapticd::servo {

namespace {

status::Name named(const std::string& name, const std::string& kind) {
  status::Name result;
  std::strncpy(result.text, name.c_str(), sizeof result.text - 1);
  std::strncpy(result.kind, kind.c_str(), sizeof result.kind - 1);
  return result;
}

}  // namespace

StatusWriter::StatusWriter(std::unique_ptr<status::PageFile> file, const scene::Scene& scene, const Arms& arms,
                           double rate)
    : file_(std::move(file)) {
  status::Page& page = file_->page();
  page.arms = static_cast<uint32_t>(std::min<size_t>(arms.size(), status::kMaxArms));
  page.models = status::kMaxModels;
  page.rate = rate;
  page.answer_time = scene.clients.answer_time;
  for (uint32_t i = 0; i < page.arms; ++i)
    page.arm[i].name.write(named(scene.devices[i].name, scene.devices[i].module));
  for (uint32_t i = 0; i < scene.models.size(); ++i) name(i, scene.models[i].name, scene.models[i].plugin);
  page.magic.store(status::kPageMagic, std::memory_order_release);
}

void StatusWriter::name(uint32_t place, const std::string& name, const std::string& plugin) {
  if (place >= status::kMaxModels) return;
  auto& model = file_->page().model[place];
  model.step_us.clear();  // removes the times of the model that had this place before
  model.now.write({});
  file_->page().feet[place].write({});
  model.name.write(named(name, plugin));
}

void StatusWriter::tick(const status::TickStatus& now, Nanoseconds late, Nanoseconds spent, const Core& core,
                        const Arms& arms, std::span<const record::ContactStatistics> books) noexcept HSP_RT {
  status::Page& page = file_->page();
  page.now.write(now);
  page.lateness_us.add(static_cast<double>(late) * 1e-3);
  page.compute_us.add(static_cast<double>(spent) * 1e-3);
  for (uint32_t i = 0; i < page.arms; ++i) {
    status::ArmStatus arm;
    for (int axis = 0; axis < 3; ++axis) {
      arm.position[axis] = arms[i]->probe().position[axis];
      arm.force[axis] = arms[i]->force()[axis];
    }
    arm.sequence = arms[i]->sample().sequence;
    arm.fault = static_cast<uint32_t>(arms[i]->limiter().fault());
    arm.valid = arms[i]->probe().valid ? 1 : 0;
    page.arm[i].now.write(arm);
    if (arms[i]->clients().present()) pushers(i, arms[i]->clients());
  }
  models(now.tick, core, books);
}

void StatusWriter::pusher(uint32_t arm, uint32_t place, uint64_t pid, const std::string& program) {
  if (arm >= status::kMaxArms || place >= status::kPushersOfArm) return;
  status::Pusher who;
  std::strncpy(who.program, program.c_str(), sizeof who.program - 1);
  who.pid = pid;
  file_->page().pusher[arm * status::kPushersOfArm + place].who.write(who);
}

void StatusWriter::pushers(uint32_t index, const ClientForces& clients) noexcept HSP_RT {
  static_assert(ClientForces::kMost == status::kPushersOfArm);
  const auto read = [](const auto& value) { return value.load(std::memory_order_relaxed); };
  for (uint32_t place = 0; place < ClientForces::kMost; ++place) {
    const ClientForces::Client& client = clients.clients()[place];
    if (client.slot == nullptr && client.gain == 0) continue;
    file_->page().pusher[index * status::kPushersOfArm + place].now.write(
        {read(client.answers), read(client.in_time), read(client.next_tick), read(client.silences), read(client.felt),
         read(client.largest)});
  }
}

void StatusWriter::models(uint64_t tick, const Core& core,
                          std::span<const record::ContactStatistics> books) noexcept HSP_RT {
  status::Page& page = file_->page();
  for (const uint32_t place : core.live()) {
    if (place >= status::kMaxModels) break;  // places are in ascending order, so no later model has an entry either
    const ModelState& model = core.models()[place];
    status::ModelStatus now;
    now.depth = std::numeric_limits<double>::quiet_NaN();
    for (uint32_t probe = 0; probe < core.probeCount(); ++probe) {
      const Contact& contact = core.contact(place, probe);
      now.force = std::max(now.force, Eigen::Map<const Vector3d>(contact.world.force).norm());
      now.iterations += contact.world.iterations;
      if (contact.traced && !(contact.world.depth_m <= now.depth)) now.depth = contact.world.depth_m;
    }
    now.gain = model.guard.gain();
    now.tick = tick;
    now.status = model.status;
    now.trouble = static_cast<uint32_t>(model.guard.fault());
    now.failed_status = model.failed_status;
    now.waits = model.waits ? 1 : 0;
    now.at_end = endOf(model);
    page.model[place].now.write(now);
    if (place < books.size())
      page.feet[place].write({books[place].nearestFeet(), books[place].heldFeet(), books[place].degradedFeet()});
    if (model.step_ns > 0) page.model[place].step_us.add(static_cast<double>(model.step_ns) * 1e-3);
  }
}

}  // namespace hapticd::servo
