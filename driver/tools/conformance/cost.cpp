// SPDX-License-Identifier: MIT
/// Tests what a step costs: it must end within a period, must not wait, and must make no system call, allocation or
/// lock.
#include <algorithm>

#include "base/clock.hpp"
#include "base/counted.hpp"
#include "conformance/allocation_place.hpp"
#include "conformance/building_blocks.hpp"
#include "conformance/lock_count.hpp"
#include "conformance/step_watch.hpp"

namespace hapticd::conformance {
namespace {

using Eigen::Vector3d;

constexpr uint64_t kPeriodNs = 1'000'000;  ///< period of a servo at 1 kHz

/// The cost of several steps.
struct Spent {
  std::vector<uint64_t> wall_ns, cpu_ns;
  size_t waited = 0;

  void add(const StepCost& cost) {
    wall_ns.push_back(cost.wall_ns);
    cpu_ns.push_back(cost.cpu_ns);
    waited += cost.waited ? 1 : 0;
  }
};

uint64_t median(std::vector<uint64_t> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string milliseconds(uint64_t ns) {
  return roughly(static_cast<double>(ns) * 1e-6) + " ms";
}

/// Returns why such steps are too slow for the period of the servo, or "". Waits and computing time of a step do not
/// depend on how busy the machine is.
std::string tooSlow(const Spent& spent, const char* where, uint64_t claim_ns) {
  const size_t count = spent.wall_ns.size();
  const std::string of = " (median of " + std::to_string(count) + " steps " + where + ")";
  if (spent.waited >= 3 && spent.waited * 10 >= count)
    return "takes about " + milliseconds(median(spent.wall_ns)) + " a step" + of + ", and waits in " +
           std::to_string(spent.waited) + " of them: it sleeps, or waits for a lock or a file; a step only computes";
  const uint64_t computes = median(spent.cpu_ns);
  if (computes <= std::max(kPeriodNs, claim_ns)) return "";
  return "takes about " + milliseconds(computes) + " a step" + of +
         ", all of it computing; a servo at 1000 Hz has 1 ms for everything (a shape that is meant to be as slow "
         "claims it: report.worst_ns)";
}

/// Judges steps without and with contact separately, because only the computation of contacts may be slow.
Verdict stepsEndInTime(const Recipe& recipe, uint64_t) {
  constexpr Nanoseconds kLong = kNanosecondsPerSecond / 2;  // a hundred steps of 5 ms are enough to judge
  constexpr size_t kEnough = 50;  // steps to judge at least, even if the machine was stopped meanwhile
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  made.subject->measureCost();
  Spent free, touched;
  const Nanoseconds end = monotonicNow() + kLong, last = end + 2 * kLong;
  const auto look = [&](const Answer& answer, const Vector3d&) {
    const hsp_contact& c = answer.contacts[0];
    const bool touches = c.depth_m > 0 || !Vector3d(c.force).isZero(0);
    (touches ? touched : free).add(made.subject->cost());
    const Nanoseconds now = monotonicNow();
    return std::string(now < end || (free.wall_ns.size() + touched.wall_ns.size() < kEnough && now < last) ? ""
                                                                                                           : "enough");
  };
  std::string enough;
  for (const Place& place : recipe.touch.places)
    if (enough.empty())
      enough = press(*made.subject, place, [&](const Answer& a, const PressStep& step) { return look(a, step.p); });
  if (enough.empty()) along(*made.subject, look);
  const uint64_t claim = made.subject->report().worst_ns;
  const std::string wrong = tooSlow(touched, "in contact", claim);
  return wrong.empty() ? tooSlow(free, "without contact", claim) : wrong;
}

Verdict noAllocation(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  watchAllocations();
  uint64_t steps = 0, seen = 0;
  Vector3d first = Vector3d::Zero();
  alongAndDeep(*made.subject, [&](const Answer&, const Vector3d& p) {
    ++steps;
    if (seen == 0) first = p;
    seen = made.subject->allocations();
    return "";
  });
  const uint64_t count = made.subject->allocations();
  if (count == 0) return "";
  return counted(count, "allocation") + " in " + std::to_string(steps) + " steps, first with the probe at " +
         text(first) + firstAllocationIn(recipe.file) + "; expected memory that activate() takes";
}

Verdict noLock(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  if (!countLocksOf(recipe.file)) return skipped("the file imports no lock function");
  uint64_t steps = 0;
  Vector3d first = Vector3d::Zero();
  alongAndDeep(*made.subject, [&](const Answer&, const Vector3d& p) {
    ++steps;
    if (made.subject->locks() == 0) first = p;
    return "";
  });
  const uint64_t locks = made.subject->locks();
  if (locks == 0) return "";
  return counted(locks, "lock") + " in " + std::to_string(steps) + " steps, first after the probe was at " +
         text(first) + "; do not lock in a step: another thread that holds the lock would make the servo wait";
}

/// Fails if a step makes a system call. Most often this is a print, so output is not buffered here: each line is then a
/// system call.
Verdict noSystemCall(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  std::setvbuf(stdout, nullptr, _IONBF, 0);
  if (!watchSystemCalls()) return skipped("system calls cannot be watched here (this needs Linux 5.11 on x86-64)");
  uint64_t steps = 0;
  Vector3d first = Vector3d::Zero();
  alongAndDeep(*made.subject, [&](const Answer&, const Vector3d& p) {
    if (steps++ == 0 || systemCalls().steps == 0) first = p;
    return "";
  });
  const SystemCalls calls = systemCalls();
  if (calls.steps == 0) return "";
  const std::string what = calls.prints ? "it prints" : "it makes system calls (" + systemCallName(calls.number) + ")";
  return what + " in " + std::to_string(calls.steps) + " of " + std::to_string(steps) +
         " steps, first with the probe at " + text(first) +
         "; a step only computes: write, read and wait outside of touch() and step()";
}

/// Compares the cost with the claim. The claim was measured on the author's machine, so only a large difference is a
/// failure.
Verdict stepCost(const Recipe& recipe, uint64_t) {
  constexpr uint64_t kFar = 10;  // factor over the claim from which the test fails
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  const uint64_t claim = std::max(made.subject->report().worst_ns, made.subject->report().typical_ns);
  std::vector<uint64_t> spent;
  along(*made.subject, [&](const Answer&, const Vector3d&) {
    spent.push_back(made.subject->stepNs());
    return "";
  });
  const uint64_t typical = median(spent);
  const std::string takes = "a step takes " + std::to_string(typical) + " ns (median)";
  if (claim == 0) return skipped("it claims no cost (report.worst_ns); " + takes);
  if (typical <= claim) return "";
  const std::string claimed = "; the claimed worst is " + std::to_string(claim) + " (report.worst_ns)";
  return typical <= kFar * claim ? warned("here " + takes + claimed) : takes + claimed;
}

}  // namespace

std::vector<ConformanceTest> costTests() {
  return {
      {"steps-end-in-time", "every step returns, and in time", &stepsEndInTime},
      {"no-system-call-in-step", "steps make no system call", &noSystemCall, kInTime},
      {"no-allocation-in-step", "steps do not allocate", &noAllocation, kInTime},
      {"no-lock-in-step", "steps do not lock", &noLock, kInTime},
      {"step-cost-vs-claim", "steps take no longer than claimed", &stepCost, kInTime},
  };
}

}  // namespace hapticd::conformance
