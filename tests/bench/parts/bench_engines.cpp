// SPDX-License-Identifier: MIT
/// Compares two engines on the same untrimmed NURBS model: the tracer of kernels/trace, whose search runs beside the
/// servo, and the bounded search of kernels/brep, which runs in every tick and treats each surface as a face with its
/// own edges.
///   bench_engines MODEL.yaml...
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <numeric>
#include <random>

#include "kernels/brep/search/search.hpp"
#include "kernels/trace/tracer.hpp"
#include "traced_shape/model_file.hpp"
#include "unit/plugins/kernels/brep/sample_splines.hpp"

namespace {

using namespace hapticd;
using Eigen::Vector3d;
using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin) {
  return std::chrono::duration<double, std::nano>(Clock::now() - begin).count();
}

struct Times {
  std::vector<double> ns;
  double mean() const { return std::accumulate(ns.begin(), ns.end(), 0.0) / static_cast<double>(ns.size()); }
  double at(double share) {
    std::sort(ns.begin(), ns.end());
    return ns[static_cast<std::size_t>(share * static_cast<double>(ns.size() - 1))];
  }
};

/// Returns strokes over the surface, at heights from 1 mm inside to 3 mm outside. @param step [m] motion per tick
std::vector<Vector3d> strokes(const brep::Model& model, double step, int count) {
  brep::Search guide(model);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> normal;
  std::vector<Vector3d> path;
  Vector3d p = model.bounds().center(), way = Vector3d::UnitX();
  for (int i = 0; i < count; ++i) {
    if (i % 2000 == 0) {
      p = model.bounds().min() +
          Vector3d(share(random), share(random), share(random)).cwiseProduct(model.bounds().sizes());
      way = Vector3d(normal(random), normal(random), normal(random)).normalized();
    }
    const Vector3d foot = guide.nearest(p).hit.point;
    const Vector3d out = (p - foot).stableNormalized();
    way = (way - way.dot(out) * out).stableNormalized();
    p = foot + (0.001 + 0.002 * std::sin(1e-2 * i)) * out + step * way;
    path.push_back(p);
  }
  return path;
}

/// What the two engines did on one path.
struct Comparison {
  Times tick, beside, one;
  std::size_t unproved = 0, tracer_farther = 0, search_farther = 0;
  double elements = 0;
};

void print(const Comparison& c, std::size_t count, std::size_t traced_bytes, std::size_t searched_bytes) {
  Times tick = c.tick, beside = c.beside, one = c.one;
  std::printf(
      "  tracer    tick p50 %6.0f  p99 %7.0f ns, mean %6.0f, and p50 %7.0f ns for its search beside, each fifth tick; "
      "farther than the other in %zu of %zu ticks; %zu bytes\n",
      tick.at(0.5), tick.at(0.99), tick.mean(), beside.at(0.5), c.tracer_farther, count, traced_bytes);
  std::printf(
      "  one search tick p50 %6.0f  p99 %7.0f ns, mean %6.0f, %.1f feet; not proved in %zu; farther than the other in "
      "%zu; %zu bytes\n",
      one.at(0.5), one.at(0.99), one.mean(), c.elements / static_cast<double>(count), c.unproved, c.search_farther,
      searched_bytes);
}

void compare(const char* file, double speed) {
  std::ifstream in(file);
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const ModelFile surfaces = parseModelFile(text, file);
  trace::ModelOptions options;
  options.edges = surfaces.edges;
  const trace::Model traced(surfaces.surfaces, options);
  const brep::Model searched(brep::samples::sheetOf(surfaces.surfaces));
  trace::Tracer tracer(traced);
  brep::Search search(searched);
  Comparison c;
  trace::Found found;
  const std::vector<Vector3d> path = strokes(searched, speed * 1e-3, 40000);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Vector3d& p = path[i];
    if (i % 5 == 0 || i % 2000 == 0) {
      const auto begin = Clock::now();
      traced.search(p, 0.15, found);
      c.beside.ns.push_back(since(begin));
      if (i % 2000 == 0) tracer.reset();
      for (const auto* records : {&found.nearest, &found.rivals})
        for (const trace::Near& near : *records) tracer.activate(near.surface, near.u, near.v, near.distance);
    }
    trace::TraceOptions nearest;
    nearest.unite = false;
    auto begin = Clock::now();
    const trace::Foot foot = tracer.step(p, nearest);
    c.tick.ns.push_back(since(begin));
    begin = Clock::now();
    const brep::Nearest& answer = search.nearest(p);
    c.one.ns.push_back(since(begin));
    c.unproved += !answer.proved;
    c.elements += answer.elements;
    const double difference = foot.distance - answer.distance();
    c.tracer_farther += difference > 1e-8;
    c.search_farther += difference < -1e-8;
  }
  std::printf("%s, %g m/s\n", file, speed);
  print(c, path.size(), traced.bytes(), searched.bytes());
}

}  // namespace

int main(int count, char** files) {
  for (int i = 1; i < count; ++i)
    for (const double speed : {0.1, 0.5}) compare(files[i], speed);
}
