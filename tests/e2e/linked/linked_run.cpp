// SPDX-License-Identifier: MIT
/// A scene run in virtual time by a program that holds its plugins and its arm: what a platform without dlopen() runs.
/// Usage: linked_run SCENE SECONDS   prints one CSV row per tick, with the columns of `hapticd export --csv`
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "host/built_in.hpp"
#include "host/catalog.hpp"
#include "scene/load.hpp"
#include "servo/arm/arm.hpp"
#include "servo/loop/loop.hpp"
#include "world/arm_force.hpp"
#include "world/world.hpp"

namespace hapticd {
namespace {

/// Prints what the models asked for and what was sent, in 17 digits, which give every bit.
class Printer final : public servo::TickLog {
 public:
  Printer() { std::puts("t,arm0_fx,arm0_fy,arm0_fz,arm0_sent_fx,arm0_sent_fy,arm0_sent_fz"); }
  void begin(Nanoseconds, const servo::Arms&) noexcept HSP_RT override {}
  void order(const servo::Order&) noexcept HSP_RT override {}
  void overrun(uint64_t) noexcept HSP_RT override {}
  void tick(double t, double, Nanoseconds, const servo::TickDuration&, const servo::Core& core,
            const servo::Arms& arms) noexcept HSP_RT override {
    const Eigen::Vector3d asked = core.force(0), sent = arms[0]->force();
    std::printf("%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", t, asked.x(), asked.y(), asked.z(), sent.x(), sent.y(),
                sent.z());
  }
  void finish(uint64_t, Nanoseconds, long, uint64_t) noexcept override {}
};

void print(int, const std::string& who, const std::string& text) {
  std::fprintf(stderr, "%s: %s\n", who.c_str(), text.c_str());
}

Result<void> run(const scene::Scene& scene, double seconds) {
  const double rate = scene.servo.rate;
  servo::WorldOptions options;
  options.rate = rate;
  options.probe_count = static_cast<uint32_t>(scene.devices.size());
  options.measure = true;
  options.max_force = servo::maxForceOf(scene);
  auto world = servo::World::build(scene, options, print);
  if (!world) return Error{world.error()};
  servo::Arms arms;
  VirtualClock clock;
  for (const scene::Device& device : scene.devices) {
    auto arm = servo::Arm::open(device, scene.servo, {rate, (*world)->needsVelocity(), nullptr, scene.clients}, print);
    if (!arm) return Error{arm.error()};
    if (auto started = (*arm)->start(clock.now(), scene.servo.gravity); !started) return started;
    arms.push_back(std::move(*arm));
  }
  servo::LoopSettings settings;
  settings.period_ns = static_cast<Nanoseconds>(std::llround(1e9 / rate));
  settings.ticks = static_cast<uint64_t>(std::llround(seconds * rate));
  settings.lockstep = true;
  Printer printer;
  servo::Loop((*world)->core(), (*world)->lockstep(), arms, clock, settings, printer).run();
  for (const auto& arm : arms) arm->stop();
  return {};
}

int runFile(const char* file, double seconds) {
  host::takeBuiltIns();
  host::Catalog catalog{host::SearchPath{}};  // no folder is searched
  const scene::Loaded loaded = scene::load(file, catalog);
  for (const document::Problem& problem : loaded.problems) std::fprintf(stderr, "%s\n", problem.text().c_str());
  if (!loaded.scene) return 2;
  const auto done = run(*loaded.scene, seconds);
  if (!done) std::fprintf(stderr, "%s\n", done.error().c_str());
  return done ? 0 : 1;
}

}  // namespace
}  // namespace hapticd

int main(int count, char** arguments) {
  if (count != 3) {
    std::fputs("usage: linked_run SCENE SECONDS\n", stderr);
    return 2;
  }
  return hapticd::runFile(arguments[1], std::strtod(arguments[2], nullptr));
}
