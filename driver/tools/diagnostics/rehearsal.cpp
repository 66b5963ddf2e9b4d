// SPDX-License-Identifier: MIT
#include "diagnostics/rehearsal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "host/child.hpp"
#include "host/wire.hpp"
#include "session/runner.hpp"

namespace hapticd::diagnostics {
namespace {

constexpr size_t kMostRehearsed = 100;  ///< models; more take long to set up once more
constexpr int kRehearsalLimitMs = 30'000;
constexpr double kLongestRun = 6, kShortestRun = 1;  ///< [s] of the scene
constexpr double kMuchCut = 0.05;                    ///< of the ticks: less is the tap of a hard contact
constexpr double kDeep = 0.02;  ///< [m] of a wall that a hand presses, or of a hand that begins inside

constexpr double kStroke = 1, kCircle = 4;  ///< scripts of the simulated hand; between them press and tap

const scene::Value* handValue(const scene::Device& device, const std::string& id) {
  for (const scene::Value& value : device.parameters)
    if (value.id == id) return &value;
  return nullptr;
}

double handNumber(const scene::Device& device, const std::string& id, double otherwise) {
  const scene::Value* value = handValue(device, id);
  return value != nullptr ? value->number : otherwise;
}

/// [s] in which a hand has gone its whole way and is back; nothing: it goes none, or nobody knows.
std::optional<double> timeOfWay(const scene::Device& device) {
  constexpr double kTurns = 1.2;  // it begins outside its way
  const bool described = std::any_of(device.parameters.begin(), device.parameters.end(),
                                     [](const scene::Value& value) { return value.id.rfind("hand.", 0) == 0; });
  const double script = handNumber(device, "hand.script", kStroke), rate = handNumber(device, "hand.rate", 0);
  const bool returns = script >= kStroke && script <= kCircle;
  if (!described || !returns || !(rate > 0)) return std::nullopt;
  return std::max(kShortestRun, kTurns / rate);
}

/// [s] to rehearse. @param whole all hands have gone their way by then, and all models theirs
double duration(const scene::Scene& scene, bool& whole) {
  double time = kShortestRun;
  whole = true;
  for (const scene::Device& device : scene.devices) {
    const auto way = timeOfWay(device);
    whole = whole && way.has_value();
    time = std::max(time, way.value_or(2));
  }
  for (const scene::Model& model : scene.models)
    if (!model.path.empty()) whole = whole && model.path.back().t <= time;
  whole = whole && time <= kLongestRun;
  return std::min(time, kLongestRun);
}

bool touched(const record::RunReport& report) {
  return std::any_of(report.models.begin(), report.models.end(), [](const record::ModelReport& model) {
    const record::ContactStatistics& felt = model.contact;
    return felt.contactTicks() + felt.untraced().ticks + felt.depthless().ticks + felt.outside().ticks > 0;
  });
}

/// How near the first arm's tip came to a model.
std::string nearness(const servo::Runner& runner) {
  double away = HUGE_VAL;
  for (const servo::BlackBoxRow& row : runner.telemetry().blackBox())
    if (row.model != UINT32_MAX) away = std::min(away, -static_cast<double>(row.depth_m));
  if (std::isfinite(away)) return fmt::format("it comes within {:.3g} mm of the nearest", away * 1e3);
  return fmt::format("it stays farther than {:g} mm from all", runner.scene().servo.activation_radius * 1e3);
}

/// Texts with the key that each is about, packed.
class Told {
 public:
  void add(const std::string& key, const std::string& what) {
    ++count_;
    list_.text(key);
    list_.text(what);
  }
  std::string take() {
    host::Packer all;
    all.number(count_);
    return all.take() + list_.take();
  }

 private:
  uint32_t count_ = 0;
  host::Packer list_;
};

void judgeForces(servo::Runner& runner, double ticks, Told& remarks) {
  for (size_t i = 0; i < runner.arms().size(); ++i) {
    const servo::Clips& clips = runner.arms()[i]->limiter().clips();
    if (!(static_cast<double>(clips.any) > kMuchCut * ticks)) continue;
    std::string by;
    for (size_t k = 0; k < servo::kLimitCount; ++k)
      if (clips.ticks[k] > 0)
        by += fmt::format("{}{} in {:.3g} %", by.empty() ? "" : ", ", servo::nameOf(static_cast<servo::Limit>(k)),
                          100 * static_cast<double>(clips.ticks[k]) / ticks);
    remarks.add("limits",
                fmt::format("{}: the force is cut in {:.3g} % of the ticks ({}): what is felt is not what the "
                            "scene says; expected a hand, stiffness and weight that the arm bears",
                            runner.scene().devices[i].name, 100 * static_cast<double>(clips.any) / ticks, by));
  }
}

void judgeContacts(const servo::Runner& runner, const record::RunReport& report, bool whole, double seconds,
                   Told& remarks) {
  for (const record::ModelReport& model : report.models)
    if (model.contact.maxDepth() > kDeep && model.plugin != "mat_deformable" && model.plugin != "push_button")
      remarks.add("hand",
                  fmt::format("presses {:.3g} mm deep into {}; expected a way (radius, rise, center in the device "
                              "frame) that meets its surface",
                              model.contact.maxDepth() * 1e3, model.name));
  if (whole && !touched(report))
    remarks.add("hand",
                fmt::format("in {:.3g} s of its way the tip touches no model: {}; expected a way that meets one: "
                            "the hand (center, in the device frame; radius, rise), the arm (mount) or the model "
                            "(pose)",
                            seconds, nearness(runner)));
}

/// "refused" and why, or the remarks.
std::string rehearseHere(const scene::Scene& scene) {
  const auto quiet = [](int, const std::string&, const std::string&) {};
  bool whole = false;
  const double seconds = duration(scene, whole);
  servo::RunOptions how;
  how.rate = scene.servo.rate;
  how.duration = seconds;
  how.virtual_time = true;
  Told refused, remarks;
  const auto world = [&] { return servo::Runner::buildWorld(scene, how, quiet); };
  auto built = world();
  if (!built) return refused.take() + remarks.take();  // told by who sets up each model
  auto runner = servo::Runner::prepare(scene, how, std::move(*built), quiet);
  if (!runner) {
    refused.add("", runner.error());
  } else if (const auto done = (*runner)->run([](const servo::Runner&) {}); !done) {
    refused.add("", done.error());
  } else {
    const record::RunReport report = (*runner)->telemetry().report({});
    for (const std::string& fault : (*runner)->faults()) remarks.add("fault", fault.substr(0, fault.find('\n')));
    judgeForces(**runner, static_cast<double>(std::max<uint64_t>(report.ticks, 1)), remarks);
    judgeContacts(**runner, report, whole, seconds, remarks);
  }
  return refused.take() + remarks.take();
}

/// Where a file says what the hand of an arm wants, or where it names the arm.
document::Place placeOfWay(const scene::Device& device) {
  for (const char* id : {"hand.path", "hand.center", "hand.radius", "hand.script", "hand.rate"})
    if (const scene::Value* value = handValue(device, id); value != nullptr) return value->place;
  return device.place;
}

/// A fault says "model ball: ...": where that model is.
document::Place placeOf(const scene::Scene& scene, const std::string& key, const std::string& what) {
  for (const scene::Model& model : scene.models)
    if (key == "fault" && what.rfind("model " + model.name + ":", 0) == 0) return model.place;
  if (key == "hand") return placeOfWay(scene.devices.front());
  for (const scene::Device& device : scene.devices)
    if (key == "limits" && what.rfind(device.name + ":", 0) == 0 && device.place.line > 0) return device.place;
  return scene.devices.front().place.line > 0 ? scene.devices.front().place : document::Place{scene.file.string()};
}

document::Problems read(host::Unpacker& in, const scene::Scene& scene) {
  document::Problems list;
  for (uint32_t left = in.count(); left > 0 && in.good(); --left) {
    const std::string key = in.text(), what = in.text();
    if (in.good()) document::report(list, placeOf(scene, key, what), key.empty() ? "device" : key, what);
  }
  return list;
}

}  // namespace

Rehearsal rehearse(const scene::Scene& scene) {
  Rehearsal rehearsal;
  const bool simulated = std::all_of(scene.devices.begin(), scene.devices.end(),
                                     [](const scene::Device& device) { return device.module == "simulated"; });
  if (!simulated || scene.models.empty() || scene.models.size() > kMostRehearsed || scene.devices.empty())
    return rehearsal;
  const auto told = host::runInChild([&] { return rehearseHere(scene); }, kRehearsalLimitMs);
  if (!told) return rehearsal;
  host::Unpacker in(*told);
  rehearsal.problems = read(in, scene);
  rehearsal.warnings = read(in, scene);
  return rehearsal;
}

}  // namespace hapticd::diagnostics
