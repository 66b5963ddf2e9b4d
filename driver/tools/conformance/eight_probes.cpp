// SPDX-License-Identifier: MIT
/// Tests eight probes, as many as a run may have: a shape must keep the state of each separately.
#include <vector>

#include "conformance/building_blocks.hpp"
#include "conformance/guarded_memory.hpp"
#include "conformance/step_watch.hpp"

namespace hapticd::conformance {
namespace {

using Eigen::Vector3d;
using Positions = std::vector<Vector3d>;  ///< positions of all probes in one step

constexpr uint32_t kProbes = 8;
/// [bytes] The gap between the end of a single record and the guarded page. After each step it is checked that nothing
/// was written into this gap.
constexpr size_t kBehind = 8;

/// One step of the run.
struct Together {
  Positions at;
  uint32_t flags = 0;
};

/// Returns the steps: first each probe follows its own part of the path, then each presses where the shape can be
/// touched.
std::vector<Together> stepsOf(const Subject& subject) {
  constexpr int kAlong = kConformanceSteps / 4;
  std::vector<Together> steps;
  for (int i = 0; i < kAlong; ++i) {
    Together step;
    for (uint32_t probe = 0; probe < kProbes; ++probe)
      step.at.push_back(onPath(subject, static_cast<double>(i) / kAlong, 0.7 * probe));
    steps.push_back(step);
  }
  const auto& places = subject.places();
  std::vector<std::vector<PressStep>> presses;
  for (size_t probe = 0; probe < kProbes && !places.empty(); ++probe)
    presses.push_back(pressAt(places[probe % places.size()], pressDepth(subject, places[probe % places.size()])));
  for (size_t i = 0; !presses.empty() && i < presses[0].size(); ++i) {
    Together step{{}, i == 0 ? uint32_t{HSP_IN_JUMP} : 0};
    for (const auto& press : presses) step.at.push_back(press[i].p);
    steps.push_back(step);
  }
  return steps;
}

/// Makes a shape for this number of probes, with guarded memory and guarded records.
std::unique_ptr<Subject> guardedSubject(const Recipe& recipe, uint32_t probes, std::string& error) {
  tellOverruns(probes);
  const GuardedMemory guarded;
  Made made(recipe, probes);
  error = made.error;
  if (!error.empty()) return nullptr;
  if (probes == 1) made.subject->widen(kBehind);
  made.subject->reserve(probes);
  return std::move(made.subject);
}

/// Returns a text about the first probe whose answer depends on another probe, or "".
std::string eachAsAlone(const Recipe& recipe, const std::vector<Together>& steps, const std::vector<Answer>& together) {
  for (uint32_t probe = 0; probe < kProbes; ++probe) {
    std::string error;
    const std::unique_ptr<Subject> alone = guardedSubject(recipe, 1, error);
    if (!error.empty()) return error;
    for (size_t i = 0; i < steps.size(); ++i) {
      const Answer& answer = alone->step({steps[i].at[probe]}, kConformanceDt, steps[i].flags);
      if (!alone->roomUntouched())
        return placed(std::string(kBeyond) + " (" + std::to_string(sizeof(hsp_contact)) +
                          " bytes); write only the record of the probe, and find the next record with HSP_AT",
                      steps[i].at[probe]);
      const Vector3d expected(answer.contacts[0].force), got(together[i].contacts[probe].force);
      const double apart = (got - expected).norm();
      if (apart <= 1e-6 * (1 + expected.norm())) continue;
      return placed(
          "probe " + std::to_string(probe + 1) + " of eight in one step gets another force than alone, by " +
              text(apart) + " N at step " + std::to_string(i) +
              "; keep the state of each probe separately: make room for activation.max_probes states in activate()",
          steps[i].at[probe]);
    }
  }
  return "";
}

}  // namespace

Verdict eightProbes(const Recipe& recipe, uint64_t) {
  std::string error;
  const std::unique_ptr<Subject> subject = guardedSubject(recipe, kProbes, error);
  if (!error.empty()) return "eight probes: " + error;
  const std::vector<Together> steps = stepsOf(*subject);
  std::vector<Answer> answers;
  for (const Together& step : steps) {
    answers.push_back(subject->step(step.at, kConformanceDt, step.flags));
    if (std::string wrong = wrongStatus(answers.back()); !wrong.empty()) return "with eight probes: " + wrong;
  }
  const bool coupled = subject->moves() || (subject->description().flags & HSP_C_DEFORMS) != 0;
  return coupled ? "" : eachAsAlone(recipe, steps, answers);  // all probes together push a shape that moves or deforms
}

}  // namespace hapticd::conformance
