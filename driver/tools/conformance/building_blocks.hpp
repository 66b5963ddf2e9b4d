// SPDX-License-Identifier: MIT
/// Building blocks that conformance tests of all kinds share.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "conformance/conformance.hpp"
#include "host/class_params.hpp"

namespace hapticd::conformance {

constexpr double kConformanceDt = 1e-3;  ///< [s] duration of every step
constexpr int kConformanceSteps = 2000;  ///< number of steps once around the path of onPath()

/// Names of tests on which other tests depend (see ConformanceTest::needs).
constexpr const char *kInTime = "steps-end-in-time", *kFinite = "finite-outputs", *kSame = "determinism-bitwise",
                     *kFoot = "foot-and-normal", *kGuarded = "eight-probes", *kRests = "rests-in-no-time";
/// The beginning of the message about an overrun that did not end the process.
constexpr const char* kBeyond = "it writes behind its hsp_contact";

/// Whether the time of a shape that moves goes on from step to step, or stands still (Subject::stopTime()).
enum class Time { kGoesOn, kStands };

/// An instance that is made and activated, or the reason why this failed.
struct Made {
  std::unique_ptr<Subject> subject;
  std::string error;
  explicit Made(const Recipe& recipe, uint32_t probes = 1, Time time = Time::kGoesOn);
};
/// An instance whose time stands still if it moves.
inline Made madeAtRest(const Recipe& recipe, uint32_t probes = 1) {
  return Made(recipe, probes, Time::kStands);
}

std::string text(double value);
std::string roughly(double value);           ///< with two digits
std::string text(const Eigen::Vector3d& p);  ///< "X, Y, Z m"

/// Returns the objection (a text that says what is wrong) with the place in front of it. The place does not stand at
/// the end, because an objection often ends with advice.
std::string placed(const std::string& objection, const Eigen::Vector3d& p);

/// Returns a point of a smooth closed path through and around the shape, which begins and ends at a corner outside its
/// box. @param part how far along the path, from 0 to 1 @param phase changes the path
Eigen::Vector3d onPath(const Subject& subject, double part, double phase = 0);

/// Moves the probe along onPath(), then presses at each place where the shape can be touched. Passes every answer of
/// the shape to `look`, and stops when `look` returns an objection. Returns the objection, or "" if there is none.
std::string along(Subject& subject, const std::function<std::string(const Answer&, const Eigen::Vector3d&)>& look,
                  int steps = kConformanceSteps);

/// Does the same as along(). Then it presses straight in at each place, as deep as deepestPress(), and comes out again.
/// A click or a second layer at that depth may allocate, lock or print too.
std::string alongAndDeep(Subject& subject,
                         const std::function<std::string(const Answer&, const Eigen::Vector3d&)>& look);

/// Runs a test on one instance at each place where the shape can be touched. Stops when `test` returns an objection,
/// and returns it. Skips the test if there is no such place.
Verdict atEachPlace(const Recipe& recipe, const std::function<std::string(Subject&, const Place&)>& test,
                    Time time = Time::kGoesOn);

/// The result of a test of contacts for a shape that names no surface.
inline Verdict fieldOnly() {
  return skipped("it names no surface (HSP_OUT_TRACED), so its force points neither in nor out");
}

/// Returns the answer to a probe that jumps to p and rests there; zero if no answer can be judged.
hsp_contact answerAtRest(Subject& subject, const Eigen::Vector3d& p);

/// Returns why point, normal and depth do not belong to one surface, or "".
Verdict footAndNormal(const Recipe& recipe, uint64_t);

/// Returns by how much the force of a shape that only pushes deviates from its normal, or "".
Verdict forceAlongNormal(const Recipe& recipe, uint64_t);

/// Fails if the torque of a contact is that of its force about the model's origin instead of about the probe.
Verdict torqueAboutProbe(const Recipe& recipe, uint64_t);

/// Returns the energy that a hand gains if it goes in, along below the surface, and out again, or "" if it gains none.
Verdict loopsGiveNoEnergy(const Recipe& recipe, uint64_t);

/// Does the same with loops of 10 and 20 mm, at the places where the stiffness changes most along the surface.
Verdict longLoopsGiveNoEnergy(const Recipe& recipe, uint64_t);

/// Returns the objection to a damper that drives the hand instead of braking it, or that pulls in a shape that reports
/// to push only; otherwise "".
Verdict dampingSign(const Recipe& recipe, uint64_t);

/// Warns of parameters whose units are not SI, or are written in another way than in scenes.
Verdict unitsSi(const Recipe& recipe, uint64_t);

/// [bytes] Returns the memory that leaks in each life of an instance, from create() to destroy(). The lives are divided
/// into four quarters. Each quarter has a least and a greatest use. The leak is the smallest growth of the least or of
/// the greatest use from one quarter to the next, divided by the number of lives in a quarter. Memory that is taken
/// once, however late, and memory that an allocator keeps and gives back do not grow in every quarter, so they do not
/// count. Returns 0 for fewer than eight lives.
/// @param used memory in use after each life
double leakOf(const std::vector<double>& used);

/// Returns how much memory leaks from create() to destroy(), as a text, or "".
Verdict createDestroyLeak(const Recipe& recipe, uint64_t);

/// Fails if the drawing of the shape (hsp.geometry/1) is not where the shape is felt. Skips a shape that draws nothing.
Verdict drawingWhereFelt(const Recipe& recipe, uint64_t);

/// Warns if the shape is felt outside of its bounds(). Skips a shape that gives none.
Verdict boundsWhereFelt(const Recipe& recipe, uint64_t);

/// Fails if a shape that moves gives its contacts in the frame of the pose before the step, or if its class does not
/// say that it may move. Skips a shape that does not move.
Verdict contactsOfTheNewPose(const Recipe& recipe, uint64_t);

/// Fails if a shape that moves changes its pose in steps of 0 s, or if one that does not report to move writes a pose.
/// Skips a shape that does not move.
Verdict restsInNoTime(const Recipe& recipe, uint64_t);

/// Fails if a shape that rests comes nearer to a probe that presses it and is held still: it would drive the hand.
/// Skips a shape that does not move, that does not rest while nothing touches it, or whose force jumps.
Verdict goesWithAPress(const Recipe& recipe, uint64_t);

/// Returns what goes wrong with eight probes, as many as a run may have, in guarded memory, or "".
Verdict eightProbes(const Recipe& recipe, uint64_t);

/// Returns "" if the status is one that a step may return and the answer is finite, otherwise what is wrong.
std::string wrongStatus(const Answer& answer);

using host::paramAt;

/// Returns a warning: what `objection` says about each parameter, separated by `between`, and then `advice`. Passes if
/// there is no objection.
Verdict warningOfParams(const Recipe& recipe, const std::function<std::string(const hsp_param&)>& objection,
                        const std::string& between, const std::string& advice);

}  // namespace hapticd::conformance
