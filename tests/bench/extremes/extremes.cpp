/// Traces every case of folders of extreme surfaces and probe paths with the production tracer, in lockstep with the
/// global search as `hapticd trace` runs it, and prints what came of each. Exit code 1 if any case is not ok.
///   extremes [FOLDER...]      a case: {name, surface, rate, start, probe, distance}, see
///   tests/cases/extremes/README.md
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kernels/trace/tracer.hpp"

namespace {

using Eigen::Vector3d;
using hapticd::spline::SurfaceData;
using namespace hapticd::trace;
using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr double kMostExcess = 1e-4;        // [m] a foot farther than this from the best one is wrong
constexpr double kRecovery = 0.005;         // [s] after a true bifurcation
constexpr double kSearchPeriod = 0.005;     // [s] of the global search beside the servo loop
constexpr double kMaxProbeSpeed = 10;       // [m/s] faster is a jump, which asks for a search
constexpr double kActivationRadius = 0.15;  // [m]
constexpr int kMostEvaluations = 12;

struct Case {
  std::string name;
  SurfaceData surface;
  double rate = 1000;
  double start_u = 0, start_v = 0;
  std::vector<Vector3d> probe;
  std::vector<double> distance;  // not-a-number where the probe is none
};

double numberOf(const Json& value) {
  return value.is_number() ? value.get<double>() : std::nan("");
}

Vector3d vectorOf(const Json& value) {
  const auto coordinate = [&](std::size_t i) {
    if (value.is_null()) return std::nan("");
    if (value[i].is_string()) return std::stod(value[i].get<std::string>());
    return numberOf(value[i]);
  };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

Case readCase(const fs::path& file) {
  std::ifstream in(file);
  const Json json = Json::parse(in);
  const Json& s = json.at("surface");
  Case c;
  c.name = json.at("name");
  for (std::size_t axis = 0; axis < 2; ++axis) {
    c.surface.degree[axis] = s.at("degree")[axis];
    c.surface.knots[axis] = s.at("knots")[axis].get<std::vector<double>>();
  }
  for (const Json& point : s.at("points")) c.surface.points.push_back(vectorOf(point));
  if (s.contains("weights") && !s["weights"].is_null()) c.surface.weights = s["weights"].get<std::vector<double>>();
  c.rate = json.at("rate");
  c.start_u = json.at("start")[0];
  c.start_v = json.at("start")[1];
  for (const Json& point : json.at("probe")) c.probe.push_back(vectorOf(point));
  for (const Json& distance : json.at("distance")) c.distance.push_back(numberOf(distance));
  return c;
}

/// Paths on which the nearest point truly jumps: two feet are equally near, and the tracked one becomes the worse.
bool isBifurcation(const Case& c) {
  for (const char* word : {"through cylinder axis", "centre", "concave"})
    if (c.name.find(word) != std::string::npos) return true;
  return false;
}

struct Outcome {
  double worst_excess = 0;  // [m]
  int bad_ticks = 0, longest_bad = 0;
  int worst_evaluations = 0;
  bool poisoned = false;  // a good sample without a finite foot
  bool lost = false;      // wrong in the last tick

  bool ok(const Case& c) const {
    const double allowed = isBifurcation(c) ? kRecovery * c.rate : 0;
    return !poisoned && !lost && worst_evaluations <= kMostEvaluations && longest_bad <= allowed;
  }
};

Outcome run(const Case& c) {
  const Model model({c.surface});
  Tracer tracer(model);
  tracer.activate(0, c.start_u, c.start_v, 0);
  Outcome out;
  Vector3d last = c.probe.front();
  double next_search = kSearchPeriod;
  bool search = false;
  int bad = 0;
  for (std::size_t i = 0; i < c.probe.size(); ++i) {
    const Vector3d& p = c.probe[i];
    const double t = static_cast<double>(i) / c.rate;
    if (t >= next_search || search) {
      Near near;  // the search knows the newest probe before this tick
      if (model.nearby(last, kActivationRadius, &near, 1) > 0) tracer.activate(0, near.u, near.v, near.distance);
      if (t >= next_search) next_search += kSearchPeriod;
    }
    const Foot foot = tracer.step(p);
    out.worst_evaluations = std::max(out.worst_evaluations, foot.evaluations);
    search = !p.allFinite() || (p - last).norm() > kMaxProbeSpeed / c.rate;
    if (p.allFinite()) last = p;
    if (!std::isfinite(c.distance[i])) continue;
    const double excess = (p - foot.point).norm() - c.distance[i];
    out.poisoned = out.poisoned || foot.surface < 0 || !std::isfinite(excess);
    out.worst_excess = std::max(out.worst_excess, excess);
    // 1e300 m away, a metre is less than rounding.
    const bool wrong = excess > std::max(kMostExcess, 1e-12 * c.distance[i]);
    bad = wrong ? bad + 1 : 0;
    out.bad_ticks += wrong ? 1 : 0;
    out.longest_bad = std::max(out.longest_bad, bad);
  }
  out.lost = bad > 0;
  return out;
}

bool runFolder(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  fmt::print("| case | worst excess mm | bad ticks | longest ms | worst evaluations | |\n|---|---|---|---|---|---|\n");
  bool all_ok = !files.empty();
  for (const fs::path& file : files) {
    try {
      const Case c = readCase(file);
      const Outcome out = run(c);
      const bool ok = out.ok(c);
      all_ok = all_ok && ok;
      fmt::print("| {} | {:.1e} | {} | {:.1f} | {} | {} |\n", c.name, 1e3 * out.worst_excess, out.bad_ticks,
                 1e3 * out.longest_bad / c.rate, out.worst_evaluations,
                 ok ? (out.bad_ticks == 0 ? "ok" : "ok, recovered") : (out.lost || out.poisoned ? "LOST" : "FAILED"));
    } catch (const std::exception& e) {
      fmt::print("| {} | | | | | FAILED: {} |\n", file.filename().string(), e.what());
      all_ok = false;
    }
  }
  return all_ok;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<fs::path> folders(argv + 1, argv + argc);
  if (folders.empty()) folders.emplace_back(HAPTICD_SOURCE_DIR "/tests/cases/extremes");
  bool ok = true;
  for (const fs::path& folder : folders) {
    if (!fs::is_directory(folder)) {
      fmt::print(stderr, "error: {} is not a folder\n", folder.string());
      return 2;
    }
    ok = runFolder(folder) && ok;
  }
  return ok ? 0 : 1;
}
