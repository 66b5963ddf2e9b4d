// SPDX-License-Identifier: MIT
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "extreme_case.hpp"
#include "kernels/trace/model.hpp"

namespace hapticd::extremes {
namespace {

using Eigen::Vector3d;
using spline::SurfaceData;
using Truth = std::function<double(const Vector3d&)>;

const double kRoot = std::sqrt(0.5);

/// Returns the surface of revolution of a profile about y. A point of the profile is (radius, height, weight). The
/// circles are exact: each is a rational quadratic with nine control points.
SurfaceData revolved(const std::vector<Vector3d>& profile, const std::vector<double>& knots, const Vector3d& at) {
  const double circle[9][3] = {{1, 0, 1},       {1, 1, kRoot}, {0, 1, 1},      {-1, 1, kRoot}, {-1, 0, 1},
                               {-1, -1, kRoot}, {0, -1, 1},    {1, -1, kRoot}, {1, 0, 1}};
  SurfaceData data;
  data.degree = {2, 2};
  data.knots = {{{0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}, knots}};
  for (const auto& [z, x, w] : circle)
    for (const Vector3d& q : profile) {
      data.points.emplace_back(at + Vector3d(q[0] * x, q[1], q[0] * z));
      data.weights.push_back(w * q[2]);
    }
  return data;
}

SurfaceData sphere(double r, const Vector3d& at = Vector3d::Zero()) {
  return revolved({{0, -r, 1}, {r, -r, kRoot}, {r, 0, 1}, {r, r, kRoot}, {0, r, 1}}, {0, 0, 0, 1, 1, 2, 2, 2}, at);
}

SurfaceData torus(double big, double small) {
  std::vector<Vector3d> profile;
  const double circle[9][3] = {{1, 0, 1},       {1, 1, kRoot}, {0, 1, 1},      {-1, 1, kRoot}, {-1, 0, 1},
                               {-1, -1, kRoot}, {0, -1, 1},    {1, -1, kRoot}, {1, 0, 1}};
  for (const auto& [x, y, w] : circle) profile.emplace_back(big + small * x, small * y, w);
  return revolved(profile, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}, Vector3d::Zero());
}

/// Returns a flat patch of 0.1 m x 0.1 m in the plane z = 0.
SurfaceData flat(int degree, int count, std::function<double(int, int)> weight = {}) {
  SurfaceData data;
  data.degree = {degree, degree};
  for (auto& knots : data.knots) {
    knots.assign(static_cast<std::size_t>(degree + 1), 0);
    for (int i = 1; i < count - degree; ++i) knots.push_back(i);
    knots.insert(knots.end(), static_cast<std::size_t>(degree + 1), count - degree);
  }
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      data.points.emplace_back(0.1 * i / (count - 1), 0.1 * j / (count - 1), 0);
      if (weight) data.weights.push_back(weight(i, j));
    }
  return data;
}

Case make(std::string name, SurfaceData surface, int ticks, double rate, const std::function<Vector3d(double)>& path,
          const Truth& truth) {
  Case c;
  c.name = std::move(name);
  c.surfaces = {std::move(surface)};
  c.rate = rate;
  for (int i = 0; i < ticks; ++i) {
    c.probe.push_back(path(i / rate));
    c.distance.push_back(truth(c.probe.back()));
  }
  return c;
}

Truth sphereTruth(double r, const Vector3d& at = Vector3d::Zero()) {
  return [=](const Vector3d& p) { return std::abs((p - at).stableNorm() - r); };
}

double torusTruth(const Vector3d& p) {
  return std::abs(std::hypot(std::hypot(p.x(), p.z()) - 0.05, p.y()) - 0.02);
}

/// Returns a path that circles a sphere at `reach` [m] from its centre and at `speed` [m/s], and passes near both
/// poles.
std::function<Vector3d(double)> round(double reach, double speed, const Vector3d& at = Vector3d::Zero()) {
  return [=](double t) {
    const double a = speed * t / reach;
    return Vector3d(at + reach * Vector3d(0.3 * std::sin(a), std::cos(a), std::sqrt(0.91) * std::sin(a)));
  };
}

void addSizes(std::vector<Case>& cases) {
  for (double r : {1e-310, 1e-150, 1e-30, 1e-6, 1e6, 1e30, 1e59}) {
    char name[64];
    std::snprintf(name, sizeof name, "sphere of radius %g m, inside at 0.9 R", r);
    Case c = make(name, sphere(r), 2000, 1000, round(0.9 * r, 2 * r), sphereTruth(r));
    c.allowed = std::max(1e-6 * r, 1e-9);  // 1e-9 m is the tolerance of the tracer
    cases.push_back(c);
  }
  const Vector3d far(1e6, -1e6, 1e6);
  cases.push_back(
      make("sphere of 1 mm at 1e6 m", sphere(1e-3, far), 2000, 1000, round(0.9e-3, 0.01, far), sphereTruth(1e-3, far)));
  cases.back().allowed = 1e-5;
  cases.push_back(make(
      "1e300 m between probe and surface", sphere(0.05), 200, 1000, [](double) { return Vector3d(1e300, 0, 0); },
      [](const Vector3d&) { return std::nan(""); }));
  for (Case& c : cases) c.alone = true;
}

void addForms(std::vector<Case>& cases) {
  const auto plane = [](const Vector3d& p) { return std::abs(p.z()); };
  const auto over = [](double speed) {
    return [speed](double t) {
      return Vector3d(0.05 + 0.03 * std::sin(speed * t / 0.03), 0.05 + 0.03 * std::cos(speed * t / 0.03), -0.002);
    };
  };
  cases.push_back(make("weights 1e-9 and 1e9 in turn",
                       flat(3, 8, [](int i, int j) { return (i + j) % 2 ? 1e9 : 1e-9; }), 2000, 1000, over(0.3),
                       plane));
  std::mt19937 random(9);
  std::uniform_real_distribution<double> exponent(-9, 9);
  cases.push_back(make("random weights 1e-9 to 1e9",
                       flat(3, 8, [&](int, int) { return std::pow(10, exponent(random)); }), 2000, 1000, over(0.01),
                       plane));
  SurfaceData thin = flat(3, 8);
  for (auto& knots : thin.knots) knots[5] = knots[4] + 1e-12;
  cases.push_back(make("knot spans of 1e-12 in both directions", thin, 2000, 1000, over(0.3), plane));
  SurfaceData line = flat(2, 4);
  for (auto& point : line.points) point.y() = 0;
  cases.push_back(make("zero area: a patch squeezed to a line", line, 1000, 1000, over(0.3), [](const Vector3d& p) {
    return std::hypot(p.y(), p.z(), p.x() - std::clamp(p.x(), 0.0, 0.1));
  }));
  SurfaceData dot = flat(2, 4);
  for (auto& point : dot.points) point.setConstant(0.01);
  cases.push_back(make("zero area: a patch squeezed to a point", dot, 1000, 1000, over(0.3),
                       [](const Vector3d& p) { return (p - Vector3d::Constant(0.01)).norm(); }));
}

void addCentres(std::vector<Case>& cases) {
  const auto still = [](double) { return Vector3d(0, 0, 0); };
  cases.push_back(make("at rest exactly in the centre of a sphere", sphere(0.05), 200, 1000, still, sphereTruth(0.05)));
  cases.push_back(make(
      "at rest exactly in the centre of a torus's tube", torus(0.05, 0.02), 200, 1000,
      [](double) { return Vector3d(0.05, 0, 0); }, torusTruth));
  cases.push_back(make(
      "along the centre line of a torus's tube", torus(0.05, 0.02), 2000, 1000,
      [](double t) { return Vector3d(0.05 * std::cos(t), 0, 0.05 * std::sin(t)); }, torusTruth));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Case c = make(std::isnan(bad) ? "every third sample not a number" : "every third sample infinite", sphere(0.05),
                  2000, 1000, round(0.049, 1), sphereTruth(0.05));
    for (std::size_t i = 2; i < c.probe.size(); i += 3) c.probe[i] = Vector3d(0, bad, 0), c.distance[i] = std::nan("");
    cases.push_back(c);
  }
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(-0.09, 0.09);
  Vector3d p;
  int tick = 0;
  cases.push_back(make(
      "torus, a teleport every 20 ms", torus(0.05, 0.02), 2000, 1000,
      [&](double) {
        if (tick++ % 20 == 0) p = {place(random), place(random), place(random)};
        return p;
      },
      torusTruth));
  cases.back().bifurcation = true;
}

void addSpeeds(std::vector<Case>& cases) {
  for (double rate : {500.0, 1000.0, 20000.0})
    for (double speed : {0.01, 0.1, 1.0, 10.0}) {
      char name[80];
      std::snprintf(name, sizeof name, "torus in contact, %g m/s at %g Hz", speed, rate);
      cases.push_back(make(
          name, torus(0.05, 0.02), 4000, rate,
          [speed](double t) {
            const double a = speed * t / 0.07, b = 0.37 * a;
            const double r = 0.05 + 0.018 * std::cos(b);
            return Vector3d(r * std::cos(a), 0.018 * std::sin(b), r * std::sin(a));
          },
          torusTruth));
    }
  for (double offset : {-0.9, -0.5, 0.5, 1.0, 2.0}) {
    char name[80];
    std::snprintf(name, sizeof name, "stand-off %+.1f R of a sphere of 50 mm, 2 m/s", offset);
    cases.push_back(make(name, sphere(0.05), 4000, 1000, round(0.05 * (1 + offset), 2), sphereTruth(0.05)));
    cases.back().allowed = 3e-5;
  }
}

}  // namespace

std::vector<Case> closedForms() {
  std::vector<Case> cases;
  addSizes(cases);
  addForms(cases);
  addCentres(cases);
  addSpeeds(cases);
  return cases;
}

std::vector<Case> randomWalks(int ticks) {
  constexpr int kPatches = 20;
  std::mt19937 random(12);
  std::uniform_real_distribution<double> bump(-0.008, 0.008), span(0.5, 1.5), weight(0.5, 2);
  std::normal_distribution<double> push(0, 0.05);
  std::vector<Case> cases;
  for (int n = 0; n < kPatches; ++n) {
    SurfaceData data = flat(
        2 + n % 3, 7 + n % 4,
        n % 2 == 0 ? std::function<double(int, int)>() : [&](int, int) { return weight(random); });
    for (auto& point : data.points) point.z() = bump(random);
    const trace::Model model({data});
    Case c;
    c.name = "random patch " + std::to_string(n) + ", random walk within 10 mm";
    c.surfaces = {data};
    c.bifurcation = c.walk = true;
    Vector3d p(0.05, 0.05, 0.005), v(0, 0, 0);
    for (int i = 0; i < ticks / kPatches; ++i) {
      v = 0.98 * v + Vector3d(push(random), push(random), push(random)) -
          Vector3d(0.2, 0.2, 2).cwiseProduct(p - Vector3d(0.05, 0.05, 0));
      p += 1e-3 * v;
      c.probe.push_back(p);
      trace::Near near;
      model.nearby(p, 1, &near, 1);
      c.distance.push_back(near.distance);
    }
    cases.push_back(std::move(c));
  }
  return cases;
}

}  // namespace hapticd::extremes
