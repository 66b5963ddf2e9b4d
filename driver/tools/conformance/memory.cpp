// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <random>

#include "conformance/building_blocks.hpp"

namespace hapticd::conformance {
namespace {

using Eigen::Vector3d;

/// Returns the answers of one instance along the path and in a press at each place.
std::vector<Answer> answersOf(Subject& subject, int steps, double phase = 0) {
  std::vector<Answer> answers;
  for (int i = 0; i < steps; ++i)
    answers.push_back(
        subject.step({onPath(subject, static_cast<double>(i) / kConformanceSteps, phase)}, kConformanceDt));
  for (const Place& place : subject.places())
    press(subject, place, [&](const Answer& answer, const PressStep&) {
      answers.push_back(answer);
      return "";
    });
  return answers;
}

std::string firstDifference(const std::vector<Answer>& a, const std::vector<Answer>& b) {
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (!sameBits(a[i], b[i]))
      return "the same probes get other answers from step " + std::to_string(i) +
             " on; look for static or global variables, memory that is not set, time and random numbers";
  return "";
}

constexpr const char* kForget =
    "; expected reset() to forget what earlier steps have left: "
    "foot points that are followed, stuck points of friction, filters, detents";

/// [N] Returns the force at `to` in the first steps after reset(). Without a jump, a shape can only forget in reset().
std::vector<Vector3d> forcesAfterReset(Subject& subject, const Vector3d& to) {
  constexpr int kSteps = 3;
  subject.reset();
  std::vector<Vector3d> forces;
  for (int i = 0; i < kSteps; ++i) forces.emplace_back(subject.step({to}, kConformanceDt).contacts[0].force);
  return forces;
}

/// Fails if a shape keeps the state of a contact (a point of static friction, a filter, a detent) over reset(). Outside
/// of the shape, where other tests call reset(), such a state has ended by itself.
std::string keptOverReset(const Recipe& recipe, Subject& subject) {
  constexpr size_t kMostPlaces = 4;
  constexpr int kStay = 50;  // [ticks]
  const std::vector<Place>& places = recipe.touch.places;
  for (size_t i = 0; i < std::min(kMostPlaces, places.size()); ++i) {
    const Place &from = places[i], &next = places[(i + 1) % places.size()];
    const double depth = std::min(pressDepth(subject, from), pressDepth(subject, next));
    const Vector3d below = from.foot - depth * from.out, aside = below + depth * from.out.unitOrthogonal(),
                   to = next.foot - depth / 2 * next.out;
    for (int k = 0; k < kStay; ++k) subject.step({below}, kConformanceDt, k == 0 ? uint32_t{HSP_IN_JUMP} : 0);
    for (int k = 0; k < kStay; ++k) subject.step({aside}, kConformanceDt);
    const Made fresh = madeAtRest(recipe);
    const auto got = forcesAfterReset(subject, to), expected = forcesAfterReset(*fresh.subject, to);
    for (size_t k = 0; k < got.size(); ++k)
      if (const double apart = (got[k] - expected[k]).norm(); apart > 1e-3 * (1 + expected[k].norm()))
        return placed("after reset() in a contact elsewhere the force differs by " + text(apart) +
                          " N from that of a new instance, in step " + std::to_string(k + 1) + kForget,
                      to);
  }
  return "";
}

Verdict resetEqualsFresh(const Recipe& recipe, uint64_t) {
  const Made used = madeAtRest(recipe), fresh = madeAtRest(recipe);
  if (!used.error.empty()) return used.error;
  size_t steps = answersOf(*used.subject, kConformanceSteps / 2, 0.7).size();
  // A shape may keep a phase that repeats every 2, 3, 5 or 7 steps. After whole periods, it would not show.
  constexpr size_t kRounds = 2 * 3 * 5 * 7;
  for (; steps % kRounds != 1; ++steps) used.subject->step({onPath(*used.subject, 0.5)}, kConformanceDt);
  used.subject->reset();
  const auto a = answersOf(*used.subject, kConformanceSteps / 4), b = answersOf(*fresh.subject, kConformanceSteps / 4);
  for (size_t i = 0; i < a.size(); ++i) {
    const double apart = (Vector3d(a[i].contacts[0].force) - Vector3d(b[i].contacts[0].force)).norm();
    if (!(apart <= 1e-6 * (1 + Vector3d(b[i].contacts[0].force).norm())))
      return "after reset() the force differs by " + text(apart) + " N from that of a new instance, in step " +
             std::to_string(i + 1) + kForget;
  }
  const bool soft = (used.subject->description().flags & HSP_C_DEFORMS) != 0;
  const bool remembers = soft || used.subject->extension(HSP_EXT_STATE) != nullptr;
  return remembers ? "" : keptOverReset(recipe, *used.subject);
}

/// Tests that two probes get the same answers together as alone. The two probes stay apart, because a plugin may use
/// what it found for one probe to start the search of another probe nearby, as TracedShape::searchAbout does. Then the
/// search ends at the same foot with other last bits (1e-15 N with eight probes of nurbs_rigid, and another "certified"
/// flag). This does not couple forces and is allowed.
Verdict batchEqualsSingle(const Recipe& recipe, uint64_t) {
  const Made batch = madeAtRest(recipe, 2), one = madeAtRest(recipe), two = madeAtRest(recipe);
  if (!batch.error.empty()) return "two probes: " + batch.error;
  if ((batch.subject->description().flags & HSP_C_DEFORMS) != 0)
    return skipped("a shape that deforms couples the probes");
  for (int i = 0; i < kConformanceSteps; ++i) {
    const double part = static_cast<double>(i) / kConformanceSteps;
    const Vector3d p = onPath(*batch.subject, part), q = onPath(*batch.subject, part, 1.1);
    const Answer both = batch.subject->step({p, q}, kConformanceDt);
    if (std::string wrong = wrongStatus(both); !wrong.empty())
      return "with two probes in one step, at " + text(p) + " and " + text(q) + ": " + wrong;
    const Answer &a = one.subject->step({p}, kConformanceDt), &b = two.subject->step({q}, kConformanceDt);
    if (std::memcmp(&both.contacts[0], &a.contacts[0], sizeof(hsp_contact)) != 0 ||
        std::memcmp(&both.contacts[1], &b.contacts[0], sizeof(hsp_contact)) != 0)
      return "in step " + std::to_string(i + 1) +
             " two probes in one step get other answers than each alone; expected a state of its own for each probe";
  }
  return "";
}

Verdict determinism(const Recipe& recipe, uint64_t) {
  const Made first(recipe), second(recipe);
  if (!first.error.empty()) return first.error;
  return firstDifference(answersOf(*first.subject, kConformanceSteps), answersOf(*second.subject, kConformanceSteps));
}

/// Fails if the foot after a jump is not the nearest one.
std::string searchesAfterJump(const Recipe& recipe, Subject& subject, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> part(0, 1);
  for (int i = 0; i < 100; ++i) {
    const Vector3d p = onPath(subject, part(random), part(random));
    const double jumped = subject.step({p}, kConformanceDt, HSP_IN_JUMP).contacts[0].depth_m;
    const Made fresh = madeAtRest(recipe);
    const double alone = fresh.subject->step({p}, kConformanceDt).contacts[0].depth_m;
    if (!(std::abs(jumped - alone) <= 1e-4 * (1e-2 + std::abs(alone))))
      return "after a jump to " + text(p) + " the depth is " + text(jumped) + " m, but that of a new instance is " +
             text(alone) + " m; expected a new search for the nearest foot point at HSP_IN_JUMP";
  }
  return "";
}

/// [N] Returns the force at `to` after a jump. Before the jump, the probe stays at each point of `way` for a while.
Vector3d forceAfterJump(Subject& subject, const std::vector<Vector3d>& way, const Vector3d& to) {
  constexpr int kStay = 200;  // [ticks] in this time, effects of filters fade
  for (size_t i = 0; i < way.size(); ++i)
    for (int k = 0; k < kStay; ++k)
      subject.step({way[i]}, kConformanceDt, i + static_cast<size_t>(k) == 0 ? uint32_t{HSP_IN_JUMP} : 0);
  return Vector3d(subject.step({to}, kConformanceDt, HSP_IN_JUMP).contacts[0].force);
}

/// Fails if a shape keeps its state (a detent that has given way, a point of static friction) over a jump. The force is
/// compared with that of an instance whose probe was outside for as long, because a force may depend on time.
std::string keptOverJump(const Recipe& recipe, const std::vector<Place>& places, Subject& subject) {
  constexpr size_t kMostPlaces = 4;
  for (size_t i = 0; i < std::min(kMostPlaces, places.size()); ++i) {
    const Place &from = places[i], &next = places[(i + 1) % places.size()];
    const double depth = std::min(pressDepth(subject, from), pressDepth(subject, next)),
                 deep = std::min(5 * depth, deepestPress(subject, from));
    const Vector3d below = from.foot - deep * from.out, aside = below + depth * from.out.unitOrthogonal();
    const Vector3d to = next.foot - depth / 2 * next.out, outside = next.foot + depth * next.out;
    const Made fresh = madeAtRest(recipe);
    const Vector3d expected = forceAfterJump(*fresh.subject, {outside, outside}, to);
    subject.reset();
    const Vector3d got = forceAfterJump(subject, {below, aside}, to);
    if ((got - expected).norm() <= 1e-3 * (1 + expected.norm())) continue;
    return placed(
        "after a jump from a press " + text(deep * 1e3) + " mm deep elsewhere the force differs by " +
            text((got - expected).norm()) + " N from that of an instance that was never pressed; expected " +
            "that the shape forgets the state of a probe at HSP_IN_JUMP, as in reset() (what the shape itself " +
            "remembers is saved by hsp.state/1)",
        to);
  }
  return "";
}

Verdict jumpFlag(const Recipe& recipe, uint64_t seed) {
  const Made made = madeAtRest(recipe);
  if (!made.error.empty()) return made.error;
  if ((made.subject->description().flags & HSP_C_DEFORMS) != 0)
    return skipped("a shape that deforms remembers where it was touched");
  const std::string wrong = searchesAfterJump(recipe, *made.subject, seed);
  const bool remembers = made.subject->extension(HSP_EXT_STATE) != nullptr;
  return wrong.empty() && !remembers ? keptOverJump(recipe, recipe.touch.places, *made.subject) : wrong;
}

Verdict stateRoundtrip(const Recipe& recipe, uint64_t) {
  auto first = Subject::make(recipe), second = Subject::make(recipe);
  if (!first) return first.error();
  const auto* state = static_cast<const hsp_ext_state*>((*first)->extension(HSP_EXT_STATE));
  if (state == nullptr) return skipped("it does not offer hsp.state/1");
  if (auto active = (*first)->activate(); !active) return active.error();
  answersOf(**first, kConformanceSteps / 2);
  (*first)->deactivate();
  std::vector<char> bytes(static_cast<size_t>(std::max<int64_t>(0, state->save((*first)->handle(), nullptr, 0))));
  state->save((*first)->handle(), bytes.data(), bytes.size());
  if (state->load((*second)->handle(), bytes.data(), bytes.size()) < 0)
    return "load() refused the bytes that save() wrote";
  std::vector<char> again(bytes.size());
  const int64_t size = state->save((*second)->handle(), again.data(), again.size());
  return size == static_cast<int64_t>(bytes.size()) && bytes == again
             ? ""
             : "after load(), save() writes other bytes than were loaded";
}

Verdict stateGarbage(const Recipe& recipe, uint64_t seed) {
  auto made = Subject::make(recipe);
  if (!made) return made.error();
  const auto* state = static_cast<const hsp_ext_state*>((*made)->extension(HSP_EXT_STATE));
  if (state == nullptr) return skipped("it does not offer hsp.state/1");
  std::mt19937_64 random(seed);
  for (const size_t size : {0u, 1u, 7u, 64u, 1000u}) {
    std::vector<char> bytes(size);
    for (char& byte : bytes) byte = static_cast<char>(random());
    if (state->load((*made)->handle(), bytes.data(), bytes.size()) >= 0)
      return "load() accepted " + std::to_string(size) +
             " random bytes as a state; expected a check of size and content";
  }
  return "";
}

Verdict denormals(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  for (const double tiny : {0.0, -0.0, 5e-324, 1e-310, -1e-310, 1e-160}) {
    hsp_probe probe{};
    probe.orientation[0] = 1;
    for (int i = 0; i < 3; ++i) probe.position[i] = probe.velocity[i] = tiny * (i + 1);
    for (int i = 0; i < 10; ++i)
      if (std::string wrong = wrongStatus(made.subject->stepRaw(probe, kConformanceDt)); !wrong.empty())
        return "with a probe at " + text(tiny) + " m " + wrong;
  }
  return "";
}

Verdict twoInstances(const Recipe& recipe, uint64_t) {
  const Made alone(recipe), first(recipe), second(recipe);
  if (!alone.error.empty()) return alone.error;
  const auto expected = answersOf(*alone.subject, kConformanceSteps / 2);
  std::vector<Answer> mixed;
  for (int i = 0; i < kConformanceSteps / 2; ++i) {
    const double part = static_cast<double>(i) / kConformanceSteps;
    mixed.push_back(first.subject->step({onPath(*first.subject, part)}, kConformanceDt));
    second.subject->step({onPath(*second.subject, part, 2.1)}, kConformanceDt);
  }
  for (const Place& place : first.subject->places())
    press(*first.subject, place, [&](const Answer& answer, const PressStep& step) {
      mixed.push_back(answer);
      second.subject->step({step.p}, kConformanceDt);
      return "";
    });
  return firstDifference(expected, mixed);
}

Verdict layoutGolden(const Recipe& recipe, uint64_t) {
  // two probes: the record of the first is where it would be without strides, too
  const Made made(recipe, 2), wide(recipe, 2);
  if (!made.error.empty()) return made.error;
  const hsp_class& c = made.subject->description();
  if (c.struct_size < offsetof(hsp_class, extension))
    return "hsp_class.struct_size is " + std::to_string(c.struct_size) +
           " bytes, less than in version 1.0 of the ABI; " + "expected sizeof(hsp_class)";
  if (c.param_count > 0 && c.params[0].struct_size < sizeof(hsp_param))
    return "hsp_param.struct_size is " + std::to_string(c.params[0].struct_size) +
           " bytes, less than in version 1.0 of the ABI; expected sizeof(hsp_param)";
  if (made.subject->report().struct_size != sizeof(hsp_report))
    return "activate() changed report.struct_size, which the host sets; expected that it stays";
  wide.subject->widen(32);  // the records of a later host may be larger
  for (int i = 0; i < kConformanceSteps / 4; ++i) {
    const double part = static_cast<double>(i) / kConformanceSteps;
    const Vector3d p = onPath(*made.subject, part), q = onPath(*made.subject, part, 1.1);
    const Answer expected = made.subject->step({p, q}, kConformanceDt);
    if (!sameBits(expected, wide.subject->step({p, q}, kConformanceDt)))
      return "the answers change if the records of a step are larger; expected HSP_AT with step.in_stride and " +
             std::string("step.out_stride instead of in[i] and out[i]");
    if (!wide.subject->roomUntouched())
      return "it writes behind its hsp_contact; expected writes to the record of the probe alone";
  }
  return "";
}

/// Fails if velocity or orientation change the answers of a shape that did not ask for them, because the host fills
/// them in only if asked.
Verdict asksForWhatItReads(const Recipe& recipe, uint64_t) {
  struct Asked {
    uint32_t flag;
    const char *member, *name;
  };
  for (const Asked& asked : {Asked{HSP_R_VELOCITY, "velocity", "HSP_R_VELOCITY"},
                             Asked{HSP_R_ORIENTATION, "orientation", "HSP_R_ORIENTATION"}}) {
    const Made without(recipe), with(recipe);
    if (!without.error.empty()) return without.error;
    if ((without.subject->report().flags & asked.flag) != 0) continue;
    with.subject->give(asked.flag);
    const auto a = answersOf(*without.subject, kConformanceSteps / 2),
               b = answersOf(*with.subject, kConformanceSteps / 2);
    for (size_t i = 0; i < a.size(); ++i) {
      const Vector3d one(a[i].contacts[0].force), other(b[i].contacts[0].force);
      if (!((one - other).norm() > 1e-9 * (1 + one.norm()))) continue;
      return std::string("it reads probe.") + asked.member + ", which changes its force by " +
             text((one - other).norm()) + " N, but does not ask for it: the host gives " +
             (asked.flag == HSP_R_VELOCITY ? "zero" : "identity") + "; expected report.flags |= " + asked.name +
             " in activate()";
    }
  }
  return "";
}

}  // namespace

std::vector<ConformanceTest> memoryTests() {
  return {
      {"determinism-bitwise", "same input, same bits", &determinism, kRests},
      {"layout-golden", "structs have at least their size of version 1.0, and strides are used", &layoutGolden, kSame},
      {"create-destroy-leak", "create() to destroy() leaks no memory", &createDestroyLeak, kInTime},
      {"asks-for-what-it-reads", "velocity and orientation are read only if the shape asks for them",
       &asksForWhatItReads, kSame},
      {"reset-equals-fresh", "after reset() the shape answers as a new instance", &resetEqualsFresh, kSame},
      {"batch-equals-single", "probes of one step do not mix", &batchEqualsSingle, kSame},
      {kGuarded, "each of eight probes has memory of its own, and no block is overrun", &eightProbes, kSame},
      {"jump-flag", "after a jump the nearest foot is found, and the place before is forgotten", &jumpFlag, kSame},
      {"state-roundtrip", "a saved state can be loaded", &stateRoundtrip, kFinite},
      {"state-garbage-rejected", "garbage is refused as a state", &stateGarbage},
      {"denormals", "tiny numbers give finite answers", &denormals, kFinite},
      {"two-instances-independent", "instances do not influence each other", &twoInstances, kSame},
  };
}

}  // namespace hapticd::conformance
