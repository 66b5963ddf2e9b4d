// SPDX-License-Identifier: MIT
/// Virtual ticks with random faults: `soak [TICKS [SEED]]`. It runs 410,000 ticks if no number is given, and 10 million
/// under HAPTICD_LONG (tests/run long). The device is lost, stale or faulty, it jumps or sends NaN; ticks are late,
/// plugins fail, and readers of the status page are killed. Exit code 1 if a fault does not end in zero force within
/// 20 ms, if a fault raises a force, if anything sent is not finite, if memory grows, or if a kind of fault never came.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "base/allocation_count.hpp"
#include "base/os.hpp"
#include "dying_readers.hpp"
#include "session/run/watched_servo.hpp"
#include "session/telemetry/status_writer.hpp"
#include "support/sweep.hpp"
#include "test_rig.hpp"

namespace hapticd::servo {
namespace {

constexpr double kMaxForce = 8.5;  ///< [N] of the gantry
constexpr Fault kInjected[] = {Fault::kDeviceLost,  Fault::kNotFinite, Fault::kStale,
                               Fault::kDeviceFault, Fault::kJumped,    Fault::kLate};

struct Check {
  uint64_t faults = 0, bad = 0, zeroed = 0;
  double force = 0, since = -1;
  Fault last = Fault::kNone;
  std::array<uint64_t, kFaultCount> kinds{};  ///< how often each came about

  void fail(const char* what, double t) {
    if (bad++ < 10) std::printf("t = %.4f s: %s\n", t, what);
  }
  /// After each tick. Clears a fault that has ended well, as a user would.
  void look(Arm& arm, double t) {
    const double now = arm.force().norm();
    if (!std::isfinite(now) || now > kMaxForce * (1 + 1e-9)) fail("a force that is no force or too large", t);
    const Fault fault = arm.limiter().fault();
    if (fault != last) ++kinds[static_cast<size_t>(fault)];
    last = fault;
    if (fault == Fault::kNone) {
      force = now;
      since = -1;
      return;
    }
    if (since < 0) {
      since = t;
      ++faults;
    }
    if (now > force * (1 + 1e-12)) fail("a fault raised the force", t);
    force = now;
    if (t - since >= 0.02 && now > 0) fail("a force 20 ms after its fault", t);
    if (arm.limiter().silent() && t - since > 0.1) {
      ++zeroed;
      arm.clear();
      since = -1;
    }
  }
};

/// How late a tick wakes: mostly not at all, sometimes by up to 7 ms, and now and then for longer than a hand may wait.
Nanoseconds latenessBy(uint32_t dice) {
  if (dice % 20'000 == 1) return 150'000'000;
  return dice % 500 == 0 ? dice % 7'000'000 : 0;
}

constexpr int kModels = 60;

/// Models whose plugins fail at some tick of the run.
std::vector<scene::Model> failingModels(std::mt19937& random, uint64_t ticks) {
  std::vector<scene::Model> models;
  for (int i = 0; i < kModels; ++i) {
    scene::Model model =
        testModel("misbehaving", {number(0, HSP_ENUM, i % 4),
                                  number(1, HSP_INT, static_cast<double>(random() % std::max<uint64_t>(1, ticks))),
                                  number(2, HSP_INT, 1 + static_cast<double>(random() % 40))});
    model.name += std::to_string(i);
    models.push_back(model);
  }
  return models;
}

/// What the whole run came to.
struct Outcome {
  record::RunReport report;
  uint64_t late = 0, killed = 0, allocations = 0;
  int silenced = 0;
  double grown = 0;  ///< [MB]
};

/// Prints what came about. @return false if that was too little for a test
bool enoughCame(const Check& check, const Outcome& run) {
  using Long = unsigned long long;
  std::printf(
      "%llu ticks, %llu device faults (%llu cleared), %llu late wake-ups, %d of %d plugins silenced, %llu readers "
      "killed, %llu allocations, memory %+.3f MB, %llu violations\n",
      Long{run.report.ticks}, Long{check.faults}, Long{check.zeroed}, Long{run.late}, run.silenced, kModels,
      Long{run.killed}, Long{run.allocations}, run.grown, Long{check.bad});
  bool enough = check.faults > run.report.ticks / 10000 && run.silenced >= kModels / 4 && run.killed > 0;
  for (const Fault fault : kInjected) {
    const uint64_t times = check.kinds[static_cast<size_t>(fault)];
    const std::string words = describe(fault);
    std::printf("  %llu times: %s\n", Long{times}, words.substr(0, words.find(';')).c_str());
    enough = enough && times > 0;
  }
  if (!enough) std::printf("too few faults came about: this was no test\n");
  return enough;
}

int soak(uint64_t ticks, unsigned seed) {
  std::mt19937 random(seed);
  Check check;
  Outcome outcome;
  Rig* running = nullptr;
  uint64_t count = 0;
  size_t memory = 0;
  uint64_t looked = 0;  // allocations of this program's own look at the memory
  const auto lateness = [&](Nanoseconds deadline) {
    const double t = static_cast<double>(deadline) * kSecondsPerNanosecond;
    if (running != nullptr && count > 0) check.look(*running->arms[0], t - 1e-3);
    if (++count == ticks / 10) {
      const uint64_t before = allocationsOfThread();
      memory = os::residentBytes();
      looked = allocationsOfThread() - before;
    }
    const Nanoseconds by = latenessBy(random());
    outcome.late += by > 0 ? 1 : 0;
    return by;
  };
  Rig rig(6, lateness, ticks, "wall", {}, failingModels(random, ticks), {number(4, HSP_BOOL, 1)});
  running = &rig;
  const std::string page = std::filesystem::temp_directory_path() / ("soak-page-" + std::to_string(getpid()));
  auto file = status::PageFile::create(page);
  if (!file) return std::printf("no status page: %s\n", file.error().c_str());
  rig.telemetry->attach(std::make_unique<StatusWriter>(std::move(*file), rig.scene, rig.arms, 1000));
  DyingReaders readers(page);
  rig.loop->run();
  outcome.killed = readers.stop();
  running = nullptr;
  outcome.grown = (static_cast<double>(os::residentBytes()) - static_cast<double>(memory)) / 1e6;
  for (const ModelState& model : rig.world->core().models()) outcome.silenced += model.guard.silenced() ? 1 : 0;
  outcome.report = rig.telemetry->report({});
  outcome.allocations = outcome.report.servo_allocations - looked;
  return enoughCame(check, outcome) && check.bad == 0 && outcome.allocations == 0 && outcome.grown < 1 ? 0 : 1;
}

}  // namespace
}  // namespace hapticd::servo

int main(int argc, char** argv) {
  const uint64_t unless_told = hapticd::support::kLong ? 10'200'000 : 410'000;  // late ones skip some
  const uint64_t ticks = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : unless_told;
  return hapticd::servo::soak(ticks, argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1);
}
