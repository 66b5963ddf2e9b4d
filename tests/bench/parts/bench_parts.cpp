// SPDX-License-Identifier: MIT
/// Measures time, work and memory of nearest points on parts, for walks over the surface and for cold queries (single
/// points, without memory of the last). Meshes are compared with other libraries in the same run.
///   bench_parts FILE.hpart...     without a file: parts made here, and bumpy balls of 100,000 and 1,000,000 triangles
///   bench_parts --balls           the balls alone
///   bench_parts --four FILE.hpart an assembly of four of them
///   bench_parts --edges FILE.hpart...     how far the force turns over smooth edges
///   bench_parts FILE.hpart --occt FILE.step ...     the part beside Open CASCADE on the file that it was imported from
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <numeric>
#include <random>
#include <string>

#include "edge_steps.hpp"
#include "kernels/brep/contact/tracer.hpp"
#include "kernels/brep/model/empty_balls.hpp"
#include "kernels/part/file.hpp"
#include "occt.hpp"
#include "peers.hpp"
#include "unit/plugins/kernels/brep/sample_meshes.hpp"
#include "unit/plugins/kernels/brep/sample_solids.hpp"

namespace hapticd::bench {
namespace {

using brep::Model;
using brep::Part;
using Eigen::Vector3d;
using Clock = std::chrono::steady_clock;

double nanoseconds(Clock::duration d) {
  return std::chrono::duration<double, std::nano>(d).count();
}

struct Times {
  std::vector<double> ns;
  double at(double share) const { return ns[static_cast<std::size_t>(share * static_cast<double>(ns.size() - 1))]; }
  double mean() const { return std::accumulate(ns.begin(), ns.end(), 0.0) / static_cast<double>(ns.size()); }
  void print(const char* what, double mean_nodes = -1, double mean_elements = -1) {
    std::sort(ns.begin(), ns.end());
    std::printf("  %-38s p50 %8.0f  p99 %8.0f  p99.9 %8.0f  max %8.0f  mean %8.0f ns", what, at(0.5), at(0.99),
                at(0.999), at(1), mean());
    if (mean_nodes >= 0) std::printf("   %.1f nodes, %.1f elements a tick", mean_nodes, mean_elements);
    std::printf("\n");
  }
};

/// Returns the median time [ns] of a measurement with nothing to measure. Every measured time contains this cost of the
/// clock.
double clockAlone() {
  constexpr int kReadings = 100001;
  static const double median = [] {
    std::vector<double> ns(kReadings);
    for (double& reading : ns) {
      const auto begin = Clock::now();
      reading = nanoseconds(Clock::now() - begin);
    }
    std::nth_element(ns.begin(), ns.begin() + kReadings / 2, ns.end());
    return ns[kReadings / 2];
  }();
  return median;
}

/// Returns the ratio theirs / ours of two measured times [ns], after the cost of the clock is subtracted from both. A
/// time of at most this cost counts as 1 ns.
double ratioWithoutClock(double theirs, double ours) {
  constexpr double kLeast = 1;
  return std::max(theirs - clockAlone(), kLeast) / std::max(ours - clockAlone(), kLeast);
}

constexpr std::size_t kStroke = 1000;  ///< ticks of one walk over the surface

/// Returns walks over the surface that begin at random places, at heights from 1 mm inside to 0.5 mm outside. @param
/// step [m] motion per tick
std::vector<Vector3d> strokes(const Model& model, double step, int count) {
  brep::Tracer guide(model);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> normal;
  std::vector<Vector3d> path;
  const Eigen::AlignedBox3d box = model.bounds();
  Vector3d p = box.center(), way = Vector3d::UnitX();
  for (int i = 0; i < count; ++i) {
    if (static_cast<std::size_t>(i) % kStroke == 0) {
      p = box.min() + Vector3d(share(random), share(random), share(random)).cwiseProduct(box.sizes());
      way = Vector3d(normal(random), normal(random), normal(random)).normalized();
    }
    const contact::Foot foot = guide.nearest(p);
    const double height = -0.00025 + 0.00075 * std::sin(1e-2 * i);
    way = (way - way.dot(foot.normal) * foot.normal).stableNormalized();
    p = foot.point + height * foot.normal + step * way;
    path.push_back(p);
  }
  return path;
}

/// Prints the times of the ticks of a walk. The time of a tick is the shortest of five rounds: each round does the same
/// work, and other load of the machine only makes it longer.
void measureWalks(const Model& model, const char* what, const std::vector<Vector3d>& path) {
  constexpr int kRounds = 5;
  brep::Search search(model);
  Times times;
  times.ns.assign(path.size(), std::numeric_limits<double>::infinity());
  double nodes = 0, elements = 0, sum = 0;
  std::size_t unproved = 0;
  for (int round = 0; round < kRounds; ++round) {
    search.reset();
    for (std::size_t i = 0; i < path.size(); ++i) {
      const auto begin = Clock::now();
      const brep::Nearest& found = search.nearest(path[i]);
      times.ns[i] = std::min(times.ns[i], nanoseconds(Clock::now() - begin));
      if (round > 0) continue;
      nodes += found.nodes;
      elements += found.elements;
      unproved += !found.proved;
      sum += found.hit.d2;
    }
  }
  const auto count = static_cast<double>(path.size());
  times.print(what, nodes / count, elements / count);
  if (unproved > 0) std::printf("      %zu of %zu feet not proved (sum %.3g)\n", unproved, path.size(), sum);
}

/// Prints the times of ticks with contacts that are held, measured as those of walks. A stroke begins as after a jump:
/// its path is unknown.
void measureContact(const Model& model, const std::vector<Vector3d>& path) {
  constexpr int kRounds = 5;
  brep::Tracer tracer(model);
  Times times;
  times.ns.assign(path.size(), std::numeric_limits<double>::infinity());
  for (int round = 0; round < kRounds; ++round)
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (i % kStroke == 0) tracer.forgetContact();
      const auto begin = Clock::now();
      tracer.step(path[i], {});
      times.ns[i] = std::min(times.ns[i], nanoseconds(Clock::now() - begin));
    }
  times.print("contact tick, 0.3 m/s");
  const auto ofOneRound = [](std::uint64_t count) { return static_cast<unsigned long long>(count / kRounds); };
  const brep::TraceCounts& counts = tracer.counts();
  std::printf("      %llu nearest, %llu held, %llu degraded\n", ofOneRound(counts.nearest), ofOneRound(counts.held),
              ofOneRound(counts.degraded));
}

/// Compares this kernel with a peer on strokes of one speed and rate. The two take turns after each stroke, so that
/// other load of the machine affects both alike. The peer may use its result of the last tick: the distance to that
/// point is an upper bound of the new distance.
void measureStrokes(const Model& model, Peer& peer, double speed, double rate, int count) {
  const auto path = strokes(model, speed / rate, count);
  brep::Search search(model);
  Times ours, theirs;
  double worst = 0;
  std::size_t proved = 0;
  std::vector<double> distances(kStroke);
  for (std::size_t first = 0; first < path.size(); first += kStroke) {
    for (std::size_t i = 0; i < kStroke; ++i) {
      const auto begin = Clock::now();
      const brep::Nearest& found = search.nearest(path[first + i]);
      ours.ns.push_back(nanoseconds(Clock::now() - begin));
      distances[i] = found.distance();
      proved += found.proved;
    }
    Vector3d near;
    double bound = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < kStroke; ++i) {
      const Vector3d& p = path[first + i];
      if (i > 0) bound = (p - near).norm() * (1 + 1e-5) + 1e-7;
      const auto begin = Clock::now();
      const double distance = peer.distance(p, bound, near);
      theirs.ns.push_back(nanoseconds(Clock::now() - begin));
      worst = std::max(worst, std::abs(distance - distances[i]));
    }
  }
  std::printf("  %.2f m/s at %.0f Hz: %zu of %zu feet proved, differ by at most %.2g m\n", speed, rate, proved,
              path.size(), worst);
  ours.print("  ours");
  theirs.print(("  " + peer.name()).c_str());
  std::printf("    ratios: median %.1f (%.1f without the clock), p99 %.1f, mean %.1f\n", theirs.at(0.5) / ours.at(0.5),
              ratioWithoutClock(theirs.at(0.5), ours.at(0.5)), theirs.at(0.99) / ours.at(0.99),
              theirs.mean() / ours.mean());
}

void measurePeers(const Model& model, const std::vector<Vector3d>& cold) {
  std::vector<std::array<std::uint32_t, 3>> corners;
  for (const auto& t : model.part().triangles) corners.push_back(t.corner);
  for (const auto& peer : makePeers(model.part().points, corners)) {
    for (const double rate : {1000.0, 4000.0})
      for (const double speed : {0.05, 0.1, 0.3})
        measureStrokes(model, *peer, speed, rate, peer->slow() ? 2000 : 20000);
    Times from_cold;
    Vector3d near = cold[0];
    for (const Vector3d& p : cold) {
      const auto begin = Clock::now();
      peer->distance(p, std::numeric_limits<double>::infinity(), near);
      from_cold.ns.push_back(nanoseconds(Clock::now() - begin));
    }
    from_cold.print((peer->name() + ", cold").c_str());
  }
}

/// The largest differences between our distances and theirs [m].
struct Differences {
  double nearer = 0, farther = 0;
};

/// Finds the nearest points of a path with both libraries. They take turns after kBlock points, so that other load of
/// the machine affects both alike. The time of a point is the mean over its block. If each point were timed alone, the
/// clock would take a third of our time, and each library would begin with caches and branch predictors that the other
/// has filled.
Differences timeInTurns(const Model& model, OcctPart& theirs, const std::vector<Vector3d>& path, bool tracked,
                        Times& our_times, Times& their_times) {
  constexpr std::size_t kBlock = 16;
  brep::Search search(model);
  Differences most;
  std::array<double, kBlock> ours{};
  double distance = std::numeric_limits<double>::infinity();
  for (std::size_t first = 0; first + kBlock <= path.size(); first += kBlock) {
    const auto begin = Clock::now();
    for (std::size_t i = 0; i < kBlock; ++i) {
      if (!tracked) search.reset();
      ours[i] = search.nearest(path[first + i]).distance();
    }
    const auto middle = Clock::now();
    std::array<double, kBlock> others{};
    for (std::size_t i = 0; i < kBlock; ++i) {
      const Vector3d& p = path[first + i];
      const double way = first + i > 0 ? (p - path[first + i - 1]).norm() : 0;
      others[i] = distance = theirs.distance(p, tracked ? distance + way + 1e-9 : distance);
      if (!tracked) distance = std::numeric_limits<double>::infinity();
    }
    const auto end = Clock::now();
    our_times.ns.push_back(nanoseconds(middle - begin) / kBlock);
    their_times.ns.push_back(nanoseconds(end - middle) / kBlock);
    for (std::size_t i = 0; i < kBlock; ++i) {
      most.nearer = std::max(most.nearer, others[i] - ours[i]);
      most.farther = std::max(most.farther, ours[i] - others[i]);
    }
  }
  return most;
}

void measureBeside(const Model& model, OcctPart& theirs, const char* what, const std::vector<Vector3d>& path,
                   bool tracked) {
  Times our_times, their_times;
  const Differences most = timeInTurns(model, theirs, path, tracked, our_times, their_times);
  our_times.print((std::string(what) + ", ours").c_str());
  their_times.print((std::string(what) + ", Open CASCADE").c_str());
  std::printf("      ratio of medians %.1f, of means %.1f; ours farther by at most %.2g m, nearer by at most %.2g m\n",
              their_times.at(0.5) / our_times.at(0.5), their_times.mean() / our_times.mean(), most.farther,
              most.nearer);
}

Part readFile(const char* file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const auto begin = Clock::now();
  Part part = brep::readPart(std::as_bytes(std::span(bytes)), file);
  std::printf("%s: %zu bytes, read in %.1f ms\n", file, bytes.size(), nanoseconds(Clock::now() - begin) * 1e-6);
  return part;
}

/// Returns the part with four copies of its last instance, rotated and shifted so that they overlap.
Part fourOf(Part part) {
  const double c = std::cos(0.3), s = std::sin(0.3);
  for (int k = 1; k < 4; ++k) {
    brep::Instance instance = part.instances.back();
    instance.pose = {c, -s, 0, 0.003 * k, s, c, 0, 0.001 * (k - 1), 0, 0, 1, 0.004 * k};
    part.instances.push_back(instance);
  }
  return part;
}

void measure(Part part, const char* name, const char* source = nullptr) {
  const std::size_t faces = part.faces.size() + part.triangles.size();
  const auto begin = Clock::now();
  const Model model(std::move(part));
  const double load = nanoseconds(Clock::now() - begin) * 1e-6;
  std::printf("%s: %zu faces or triangles, built in %.1f ms, %.0f bytes each, %zu leaves, %zu curve pieces\n", name,
              faces, load, static_cast<double>(model.bytes()) / static_cast<double>(faces), model.leafCount(),
              model.pieceCount());
  std::printf("  a measurement of nothing: p50 %.0f ns, which every time below contains\n", clockAlone());
  constexpr int kTicks = 50000;
  const auto slowest = strokes(model, 5e-5, kTicks), slow = strokes(model, 1e-4, kTicks),
             middle = strokes(model, 3e-4, kTicks), fast = strokes(model, 1e-3, kTicks);
  measureWalks(model, "walk, 0.05 m/s", slowest);
  measureWalks(model, "walk, 0.1 m/s", slow);
  measureWalks(model, "walk, 0.3 m/s", middle);
  measureWalks(model, "walk, 1 m/s", fast);
  measureContact(model, middle);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> share(-0.3, 1.3);
  std::vector<Vector3d> cold(5000);
  for (Vector3d& p : cold)
    p = model.bounds().min() +
        Vector3d(share(random), share(random), share(random)).cwiseProduct(model.bounds().sizes());
  measureWalks(model, "cold queries", cold);
  if (const auto theirs = source != nullptr ? readOcctPart(source) : nullptr) {
    measureBeside(model, *theirs, "tracked, 0.3 m/s", std::vector(middle.begin(), middle.begin() + 5000), true);
    measureBeside(model, *theirs, "cold", std::vector(cold.begin(), cold.begin() + 2000), false);
  } else if (source != nullptr) {
    std::printf("  built without Open CASCADE: %s is not compared\n", source);
  }
  if (model.part().faces.empty()) measurePeers(model, cold);
}

}  // namespace
}  // namespace hapticd::bench

namespace {

/// Returns a bumpy ball with what an import adds.
hapticd::brep::Part importedBall(int triangles) {
  hapticd::brep::Part part = hapticd::brep::samples::bumpyBall(triangles);
  hapticd::brep::findEmptyBalls(part);
  return part;
}

constexpr const char* kUsage =
    "usage: bench_parts FILE.hpart...     without a file: parts made here, and bumpy balls of triangles\n"
    "       bench_parts --balls           the balls alone\n"
    "       bench_parts --four FILE.hpart an assembly of four of them\n"
    "       bench_parts --edges FILE.hpart...\n"
    "       bench_parts FILE.hpart --occt FILE.step ...\n";

void measureAll(int count, char** files) {
  using namespace hapticd;
  if (count == 2 && std::string(files[1]) == "--balls") {
    bench::measure(importedBall(100000), "bumpy ball");
    bench::measure(importedBall(1000000), "bumpy ball");
    return;
  }
  if (count < 2) {
    bench::measure(brep::samples::bracket(), "bracket");
    bench::measure(brep::samples::torus(20, 6), "torus");
    bench::measure(brep::samples::plate(58, 57, 1, 3, 2), "plate with 3306 holes");
    bench::measure(brep::samples::plate(100, 100, 1, 3, 2), "plate with 10,000 holes");
    bench::measure(importedBall(100000), "bumpy ball");
    bench::measure(importedBall(1000000), "bumpy ball");
  }
  if (count > 2 && std::string(files[1]) == "--edges") {
    for (int i = 2; i < count; ++i) bench::measureEdgeSteps(brep::Model(bench::readFile(files[i])));
    return;
  }
  const bool four = count == 3 && std::string(files[1]) == "--four";
  for (int i = four ? 2 : 1; i < count; ++i) {
    brep::Part part = bench::readFile(files[i]);
    if (four) part = bench::fourOf(std::move(part));
    const bool beside = i + 2 < count && std::string(files[i + 1]) == "--occt";
    bench::measure(std::move(part), files[i], beside ? files[i + 2] : nullptr);
    if (beside) i += 2;
  }
}

}  // namespace

int main(int count, char** files) {
  const std::string first = count > 1 ? files[1] : "";
  const bool known = !first.starts_with("-") || first == "--balls" || first == "--four" || first == "--edges";
  const bool help = first == "--help" || first == "-h";
  if (help || !known) return std::fputs(kUsage, help ? stdout : stderr), help ? 0 : 2;
  try {
    measureAll(count, files);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_parts: %s\n", e.what());
    return 1;
  }
}
