// SPDX-License-Identifier: MIT
/// What the conformance tests of all kinds are made of.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "conformance/conformance.hpp"

namespace hapticd::conformance {

constexpr double kConformanceDt = 1e-3;  ///< [s] of every step
constexpr int kConformanceSteps = 2000;  ///< once around the path

/// Tests without which others mean nothing.
constexpr const char *kInTime = "steps-end-in-time", *kFinite = "finite-outputs", *kSame = "determinism-bitwise",
                     *kFoot = "foot-and-normal", *kGuarded = "eight-probes";
/// How an objection begins that names an overrun which did not end the process.
constexpr const char* kBeyond = "it writes behind its hsp_contact";

/// Gives an active instance, or the reason why there is none.
struct Made {
  std::unique_ptr<Subject> subject;
  std::string error;
  explicit Made(const Recipe& recipe, uint32_t probes = 1);
};

std::string text(double value);
std::string text(const Eigen::Vector3d& p);  ///< "X, Y, Z m"

/// An objection that begins with the place where it was found, because advice often follows.
std::string placed(const std::string& objection, const Eigen::Vector3d& p);

/// A smooth closed path through and around the shape, from a corner outside its box and back to it.
Eigen::Vector3d onPath(const Subject& subject, double part, double phase = 0);

/// Runs along the path, then presses wherever the shape can be touched, and gives every answer to `look`; the first
/// objection ends the run.
std::string along(Subject& subject, const std::function<std::string(const Answer&, const Eigen::Vector3d&)>& look,
                  int steps = kConformanceSteps);

/// The same, and then straight in at each place, as deep as `deepestPress`, and out again: a click or a second layer
/// there may allocate, lock or print too.
std::string alongAndDeep(Subject& subject,
                         const std::function<std::string(const Answer&, const Eigen::Vector3d&)>& look);

/// Runs a test at each place where the shape can be touched, on one instance; the first objection ends it. "skip: why"
/// where there is none.
std::string atEachPlace(const Recipe& recipe, const std::function<std::string(Subject&, const Place&)>& test);

/// Why a shape whose force has no surface is not tested.
constexpr const char* kField = "skip: it names no surface (HSP_OUT_TRACED): a force without a surface has no sign";

/// The answer to a probe that jumps to p and rests there; zero if there is none to judge.
hsp_contact answerAtRest(Subject& subject, const Eigen::Vector3d& p);

/// "" or why point, normal and depth do not belong to one surface.
std::string footAndNormal(const Recipe& recipe, uint64_t);

/// "" or by how much the force of a shape that only pushes deviates from its normal.
std::string forceAlongNormal(const Recipe& recipe, uint64_t);

/// "" or the energy that a hand gains when it goes in, along below the surface, and out again.
std::string loopsGiveNoEnergy(const Recipe& recipe, uint64_t);

/// "warn: ..." for parameters whose units are not SI.
std::string unitsSi(const Recipe& recipe, uint64_t);

/// [bytes] What each life keeps, from the memory in use after each: the least that its growth from one quarter of the
/// lives to the next explains, by the least and by the most of a quarter. What is taken once, however late, and what an
/// allocator keeps and gives back, is no leak: it does not grow through all of them. 0 for fewer than eight lives.
double leakOf(const std::vector<double>& used);

/// "" or what create() to destroy() leaks.
std::string createDestroyLeak(const Recipe& recipe, uint64_t);

/// "" or why what it draws by hsp.geometry/1 is not where it is felt; "skip: why" if it draws nothing.
std::string drawingWhereFelt(const Recipe& recipe, uint64_t);

/// "" or what goes wrong with as many probes as a run may have, in guarded memory.
std::string eightProbes(const Recipe& recipe, uint64_t);

/// "" for a status that a step may return, and an answer that is finite.
std::string wrongStatus(const Answer& answer);

const hsp_param& paramAt(const hsp_class& c, uint32_t i);

/// "" or a warning: what `objection` says of each parameter, separated by `between`, and then `advice`.
std::string warningOfParams(const Recipe& recipe, const std::function<std::string(const hsp_param&)>& objection,
                            const std::string& between, const std::string& advice);

}  // namespace hapticd::conformance
