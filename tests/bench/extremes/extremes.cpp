// SPDX-License-Identifier: MIT
/// Traces extreme surfaces and probe paths with `hapticd trace`, and prints for each case how far its feet are from the
/// true nearest points. Each case of a folder is traced as it is, in one rigid motion (12 under HAPTICD_LONG), and in
/// sessions that are recorded and replayed. The exit code is 1 if any case is not ok.
///   extremes HAPTICD [--random TICKS] [--sessions MOTIONS] [FOLDER...]
/// If no folder is given, it traces tests/cases/extremes, the closed forms and the walks. --sessions gives the number
/// of rigid motions of each case that are traced in sessions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "extreme_case.hpp"
#include "support/sweep.hpp"

namespace {

using Eigen::Vector3d;
using hapticd::extremes::Answer;
using hapticd::extremes::Case;
namespace fs = std::filesystem;

constexpr double kRecovery = 0.005;       // [s] time that a tracer may need after the true nearest point has jumped
constexpr int kMostEvaluations = 12 + 6;  // TraceOptions: max_evaluations, and kForSide at an open shell
constexpr int kDefaultRandomTicks = 50'000;
const int kMotions = hapticd::support::kLong ? 12 : 1;

fs::path hapticd_program;
// rigid motions of each case in sessions; few by default, because a test has less time than a report
int session_motions = 1;

struct Outcome {
  double worst_excess = 0;  // [m]
  int bad_ticks = 0, longest_bad = 0;
  int worst_evaluations = 0;
  bool poisoned = false;  // a finite sample has no finite foot
  bool lost = false;      // the foot is still wrong at the end, and not only just after a jump

  bool ok(const Case& c) const {
    // direct parametric tracing may lose the nearest foot
    if (c.direct_steps > 0) return !poisoned && worst_evaluations <= kMostEvaluations;
    const double allowed = c.bifurcation ? kRecovery * c.rate : 0;
    return !poisoned && !lost && worst_evaluations <= kMostEvaluations && longest_bad <= allowed;
  }
  void add(const Outcome& other) {
    worst_excess = std::max(worst_excess, other.worst_excess);
    bad_ticks += other.bad_ticks;
    longest_bad = std::max(longest_bad, other.longest_bad);
    worst_evaluations = std::max(worst_evaluations, other.worst_evaluations);
    poisoned = poisoned || other.poisoned;
    lost = lost || other.lost;
  }
};

/// Traces a case without a session.
std::vector<Answer> byTrace(const Case& c) {
  return c.alone ? traceAlone(c) : traceThroughDoor(c, hapticd_program);
}
std::vector<Answer> inSession(const Case& c) {
  return traceInSession(c, hapticd_program, HAPTICD_TEST_DEVICES);
}

Outcome run(const Case& c, std::vector<Answer> (*trace)(const Case&) = byTrace) {
  const std::vector<Answer> answers = trace(c);
  Outcome out;
  int bad = 0;
  for (std::size_t i = 0; i < c.probe.size(); ++i) {
    const Answer& answer = answers.at(i);
    out.worst_evaluations = std::max(out.worst_evaluations, answer.evaluations);
    if (!std::isfinite(c.distance[i])) continue;
    const double excess = (c.probe[i] - answer.point).stableNorm() - c.distance[i];
    out.poisoned = out.poisoned || !answer.traced || !std::isfinite(excess) || !answer.normal.allFinite();
    out.worst_excess = std::max(out.worst_excess, excess);
    // At 1e300 m, the rounding error of a distance is far more than a metre.
    const bool wrong = !(excess <= std::max(c.allowed, 1e-12 * c.distance[i]));
    bad = wrong ? bad + 1 : 0;
    out.bad_ticks += wrong ? 1 : 0;
    out.longest_bad = std::max(out.longest_bad, bad);
  }
  out.lost = bad > (c.bifurcation ? kRecovery * c.rate : 0);
  return out;
}

/// Traces rigid motions of a case, and returns the worst results of all.
Outcome runMoved(const Case& c, int motions, std::vector<Answer> (*trace)(const Case&) = byTrace) {
  std::mt19937 random(16);
  Outcome all;
  for (int i = 0; i < motions; ++i) all.add(run(moved(c, random), trace));
  return all;
}

bool print(const Case& c, const Outcome& out) {
  const bool ok = out.ok(c);
  fmt::print("| {} | {:.1e} | {} | {:.1f} | {} | {} |\n", c.name, 1e3 * out.worst_excess, out.bad_ticks,
             1e3 * out.longest_bad / c.rate, out.worst_evaluations,
             ok ? (out.bad_ticks == 0 ? "ok" : (c.direct_steps > 0 ? "bounded" : "ok, recovered"))
                : (out.lost || out.poisoned ? "LOST" : "FAILED"));
  return ok;
}

void printHead() {
  fmt::print("| case | worst excess mm | bad ticks | longest ms | worst evaluations | |\n|---|---|---|---|---|---|\n");
}

bool runFolder(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  bool all_ok = !files.empty();
  for (const fs::path& file : files) {
    try {
      Case c = hapticd::extremes::readCase(file);
      const std::string name = c.name;
      all_ok = print(c, run(c)) && all_ok;
      const Outcome in_motions = runMoved(c, kMotions);
      c.name = fmt::format("{}, {} rigid motions", name, kMotions);
      all_ok = print(c, in_motions) && all_ok;
      Outcome in_sessions = run(c, inSession);
      in_sessions.add(runMoved(c, session_motions, inSession));
      c.name = fmt::format("{}, in {} sessions", name, session_motions + 1);
      all_ok = print(c, in_sessions) && all_ok;
    } catch (const std::exception& e) {
      fmt::print("| {} | | | | | FAILED: {} |\n", file.filename().string(), e.what());
      all_ok = false;
    }
  }
  return all_ok;
}

bool runAll(const std::vector<Case>& cases) {
  bool ok = true;
  for (const Case& c : cases) {
    try {
      ok = print(c, run(c)) && ok;
    } catch (const std::exception& e) {
      fmt::print("| {} | | | | | FAILED: {} |\n", c.name, e.what());
      ok = false;
    }
  }
  return ok;
}

bool runRandomWalks(int ticks) {
  Outcome all;
  Case any;
  for (const Case& c : hapticd::extremes::randomWalks(ticks)) {
    all.add(run(c));
    any.bifurcation = c.bifurcation;
  }
  any.name = fmt::format("{} random ticks within 10 mm of 20 random patches", ticks);
  return print(any, all);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<fs::path> folders;
  int random_ticks = kDefaultRandomTicks;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--random" && i + 1 < argc) {
      random_ticks = std::atoi(argv[++i]);
    } else if (std::string(argv[i]) == "--sessions" && i + 1 < argc) {
      session_motions = std::atoi(argv[++i]);
    } else if (hapticd_program.empty()) {
      hapticd_program = argv[i];
    } else {
      folders.emplace_back(argv[i]);
    }
  }
  if (hapticd_program.empty()) {
    fmt::print(stderr, "usage: extremes HAPTICD [--random TICKS] [--sessions MOTIONS] [FOLDER...]\n");
    return 2;
  }
  const bool all = folders.empty();
  if (all) folders.emplace_back(HAPTICD_SOURCE_DIR "/tests/cases/extremes");
  bool ok = true;
  printHead();
  for (const fs::path& folder : folders) {
    if (!fs::is_directory(folder)) {
      fmt::print(stderr, "error: {} is not a folder\n", folder.string());
      return 2;
    }
    ok = runFolder(folder) && ok;
  }
  if (all) {
    ok = runAll(hapticd::extremes::closedForms()) && ok;
    ok = runAll(hapticd::extremes::modelWalks()) && ok;
    ok = runRandomWalks(random_ticks) && ok;
  }
  return ok ? 0 : 1;
}
