// SPDX-License-Identifier: MIT
/// Random walks over real parts. No foot that is certified (proved to be the nearest) may be farther away than another
/// point of the part. HAPTICD_PART_TICKS sets the number of ticks of all parts together, such as 1e8 for a long run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <numbers>
#include <random>

#include "kernels/brep/elements/newton_feet.hpp"
#include "kernels/brep/search/search.hpp"
#include "kernels/part/file.hpp"
#include "sample_meshes.hpp"
#include "sample_solids.hpp"
#include "sample_splines.hpp"
#include "traced_shape/model_file.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 1e-12;  ///< [m], and as a share of a distance

std::int64_t ticksOfAll() {
  const char* asked = std::getenv("HAPTICD_PART_TICKS");
  return asked != nullptr ? static_cast<std::int64_t>(std::atof(asked)) : 240'000;
}

Part readShipped(const std::string& name) {
  std::ifstream in(HAPTICD_SOURCE_DIR "/config/models/" + name, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  return readPart(std::as_bytes(std::span(bytes)), name);
}

Part splines(const std::string& name) {
  return samples::sheetOf(readModelFile(HAPTICD_SOURCE_DIR "/config/models/" + name).surfaces);
}

/// Returns a wavy mesh of 2 n^2 triangles over a square of 40 mm x 40 mm.
Part wavyMesh(std::uint32_t n) {
  Part part;
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t j = 0; j <= n; ++j) {
      const double x = 0.04 * i / n, y = 0.04 * j / n;
      part.points.push_back({x, y, 0.002 * std::sin(300 * x) * std::cos(250 * y)});
    }
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
      Triangle lower, upper;
      lower.corner = {a, b, b + 1};
      upper.corner = {a, b + 1, a + 1};
      part.triangles.insert(part.triangles.end(), {lower, upper});
    }
  samples::endBody(part, BodyKind::kMesh, 0);
  return part;
}

/// Returns a spline sheet of 25 mm along z, whose first two control points across z coincide. So its first derivative
/// vanishes all along that border, and at one end of two edges.
Part sheetWithCoincidingPoints() {
  spline::SurfaceData data;
  data.degree = {1, 2};
  data.knots = {std::vector<double>{0, 0, 1, 1}, std::vector<double>{0, 0, 0, 1, 2, 2, 2}};
  for (const double z : {0.0, 0.025})
    for (const auto& [x, y] :
         {std::pair(0.0, 0.0), std::pair(0.0, 0.0), std::pair(-0.025, 0.025), std::pair(-0.025, 0.0)})
      data.points.emplace_back(x, y, z);
  return samples::sheetOf({data});
}

/// Returns half a tube of 20 mm radius, which is extruded from a polyline of 40 chords.
Part extrudedPolyline() {
  constexpr int kChords = 40;
  constexpr double kLong = 30, kRadius = 0.02;
  Part part;
  std::vector<double> knots{0};
  std::vector<double> points;
  for (int i = 0; i <= kChords; ++i) {
    const double angle = std::numbers::pi * i / kChords;
    knots.push_back(i);
    points.insert(points.end(), {kRadius * std::cos(angle), kRadius * std::sin(angle), 0});
  }
  knots.push_back(kChords);
  const auto polyline = [&](double z) {
    for (std::size_t i = 2; i < points.size(); i += 3) points[i] = z;
    Curve3 curve;
    curve.kind = CurveKind::kSpline;
    curve.degree = 1;
    curve.count = kChords + 1;
    curve.data = samples::addReals(part, knots);
    samples::addReals(part, points);
    return curve;
  };
  const std::uint32_t right = samples::addVertex(part, {kRadius, 0, 0}),
                      left = samples::addVertex(part, {-kRadius, 0, 0});
  const std::uint32_t below = samples::addEdge(part, polyline(0), 0, kChords, right, left);
  const std::uint32_t basis = samples::last(part.curves3);
  const std::uint32_t above = samples::addEdge(part, polyline(kLong * samples::kMm), 0, kChords,
                                               samples::addVertex(part, {kRadius, 0, kLong * samples::kMm}),
                                               samples::addVertex(part, {-kRadius, 0, kLong * samples::kMm}));
  Surface surface;
  surface.kind = SurfaceKind::kExtrusion;
  surface.basis = basis;
  surface.z = {0, 0, samples::kMm};
  samples::addFace(part, surface, 0, {0, 0}, {kChords, kLong});
  samples::addLoop(part);
  const auto side = [&](double x, double u, std::uint32_t from, std::uint32_t flags) {
    Curve3 line;
    line.o = {x, 0, 0};
    line.x = {0, 0, samples::kMm};
    samples::addCoedge(part, samples::addEdge(part, line, 0, kLong, from, from + 2), samples::line2({u, 0}, {0, 1}),
                       flags);
  };
  samples::addCoedge(part, below, samples::line2({0, 0}, {1, 0}), 0);
  side(-kRadius, kChords, left, 0);
  samples::addCoedge(part, above, samples::line2({0, kLong}, {1, 0}), kReversed);
  side(kRadius, 0, right, kReversed);
  samples::endBody(part, BodyKind::kSheet, 0);
  return part;
}

/// Points on the surface. None of them may be nearer to the probe than a certified foot.
class Witnesses {
 public:
  explicit Witnesses(const Model& model) {
    const Part& part = model.part();
    for (const Placement& place : model.placements()) {
      const Body& body = part.bodies[place.body];
      for (std::uint32_t f = 0; f < body.face_count; ++f) addFace(model, place, body.first_face + f);
      for (std::uint32_t e = 0; e < body.edge_count; ++e) addEdge(model, place, body.first_edge + e);
      for (std::uint32_t p = 0; p < body.point_count; ++p) add(place, vec(part.points[body.first_point + p]));
    }
  }

  std::size_t count() const { return x_.size(); }

  /// Returns the distance [m] from p to the nearest of the points.
  double distance(const Vector3d& p) const {
    double best = 1e300;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const double dx = x_[i] - p.x(), dy = y_[i] - p.y(), dz = z_[i] - p.z();
      best = std::min(best, dx * dx + dy * dy + dz * dz);
    }
    return std::sqrt(best);
  }

 private:
  void add(const Placement& place, const Vector3d& at) {
    const Vector3d p = place.rotation * at + place.position;
    x_.push_back(p.x()), y_.push_back(p.y()), z_.push_back(p.z());
  }
  void addFace(const Model& model, const Placement& place, std::uint32_t index) {
    constexpr int kSide = 8;
    const Face& face = model.part().faces[index];
    spline::SurfacePoint at;
    for (int k = 0; k < kSide * kSide; ++k) {
      const double u = face.lo[0] + (face.hi[0] - face.lo[0]) * (k / kSide + 0.5) / kSide;
      const double v = face.lo[1] + (face.hi[1] - face.lo[1]) * (k % kSide + 0.5) / kSide;
      if (!model.face(index).trim.inside(u, v)) continue;
      model.geometry().surface(face.surface, u, v, at);
      add(place, at.S);
    }
  }
  void addEdge(const Model& model, const Placement& place, std::uint32_t index) {
    constexpr int kPoints = 16;
    const Edge& edge = model.part().edges[index];
    if (edge.curve == kNone) return;
    spline::CurvePoint at;
    for (int k = 0; k <= kPoints; ++k) {
      model.geometry().curve(edge.curve, edge.t0 + (edge.t1 - edge.t0) * k / kPoints, at);
      add(place, at.C);
    }
  }

  std::vector<double> x_, y_, z_;
};

struct Tally {
  std::int64_t ticks = 0, proved = 0, wrong = 0;
};

/// Walks at several speeds around a part and through it. A foot is wrong if a point of the surface is nearer, if a
/// search without memory finds a nearer point, or if the distance has changed by more than the probe has moved.
class Walk {
 public:
  Walk(const Model& model, unsigned seed)
      : model_(model), witnesses_(model), walking_(model), cold_(model), random_(seed) {}

  Tally run(std::int64_t ticks) {
    for (std::int64_t i = 0; i < ticks; ++i) {
      if (i % 5000 == 0) begin(i / 5000);
      move();
      look(i);
    }
    return tally_;
  }

 private:
  void begin(std::int64_t number) {
    std::uniform_real_distribution<double> share(-0.25, 1.25);
    const Eigen::AlignedBox3d& box = model_.bounds();
    p_ = box.min() + Vector3d(share(random_), share(random_), share(random_)).cwiseProduct(box.sizes());
    step_ = std::array{1e-6, 1e-4, 3e-4, 1e-3, 1e-2}[static_cast<std::size_t>(number % 5)];
    way_ = Vector3d(normal_(random_), normal_(random_), normal_(random_)) * step_;
    if (number % 7 == 0) walking_.reset();
    before_ = -1;
  }
  /// Moves the probe in a direction that changes slowly. If the probe is far away from the part, it turns back.
  void move() {
    way_ = 0.98 * way_ + 0.14 * step_ * Vector3d(normal_(random_), normal_(random_), normal_(random_));
    const Eigen::AlignedBox3d& box = model_.bounds();
    const double size = box.diagonal().norm();
    if (box.exteriorDistance(p_) > 0.5 * size) way_ += 0.1 * step_ * (box.center() - p_).normalized();
    moved_ = way_.norm();
    p_ += way_;
  }
  void look(std::int64_t i) {
    const Nearest& found = walking_.nearest(p_);
    ++tally_.ticks;
    if (!found.found() || !found.proved) {
      before_ = -1;
      return;
    }
    ++tally_.proved;
    const double distance = found.distance(), slack = kRounding * (1 + distance);
    bool wrong = before_ >= 0 && std::abs(distance - before_) > moved_ + slack;
    before_ = distance;
    if (i % 8 == 0) {
      cold_.reset();
      wrong = wrong || cold_.nearest(p_).distance() < distance - slack;
    }
    if (i % 16 == 0) wrong = wrong || witnesses_.distance(p_) < distance - slack;
    tally_.wrong += wrong;
    if (wrong && tally_.wrong <= 3)
      ADD_FAILURE() << "at " << p_.transpose() << ": " << distance << ", a witness at " << witnesses_.distance(p_);
  }

  const Model& model_;
  Witnesses witnesses_;
  Search walking_, cold_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  Tally tally_;
  Vector3d p_{0, 0, 0}, way_{0, 0, 0};
  double step_ = 0, moved_ = 0, before_ = -1;
};

TEST(CertifiedWalks, NoFootThatIsToldToBeTheNearestIsFarther) {
  std::vector<std::pair<std::string, Part>> parts;
  parts.emplace_back("as1", readShipped("as1.hpart"));
  parts.emplace_back("dm1", readShipped("dm1.hpart"));
  parts.emplace_back("bracket", samples::bracket());
  parts.emplace_back("capped cylinder", samples::cappedCylinder(10, 20));
  parts.emplace_back("cone", samples::cone(10, 20));
  parts.emplace_back("torus", samples::torus(20, 5));
  parts.emplace_back("sphere", samples::sphere(10));
  parts.emplace_back("plate of 30 holes", samples::plate(6, 5, 0.6, 1.6, 5));
  parts.emplace_back("goblet of splines", splines("goblet.yaml"));
  parts.emplace_back("torus of splines", splines("torus.yaml"));
  parts.emplace_back("coinciding points", sheetWithCoincidingPoints());
  parts.emplace_back("extruded polyline", extrudedPolyline());
  parts.emplace_back("mesh", samples::joined(wavyMesh(40)));
  parts.emplace_back("closed mesh", samples::bumpyBall(3000));
  const std::int64_t each = std::max<std::int64_t>(1, ticksOfAll() / static_cast<std::int64_t>(parts.size()));
  Tally all;
  unsigned seed = 19;
  for (auto& [name, part] : parts) {
    SCOPED_TRACE(name);
    const Model model(std::move(part));
    const Tally tally = Walk(model, ++seed).run(each);
    std::printf("%-18s %lld ticks, %lld certified, %lld wrong\n", name.c_str(), static_cast<long long>(tally.ticks),
                static_cast<long long>(tally.proved), static_cast<long long>(tally.wrong));
    std::fflush(stdout);
    EXPECT_EQ(tally.wrong, 0);
    // In the middle of the polyline's tube, all its chords are equally near.
    EXPECT_GT(tally.proved, (name == "coinciding points" || name == "extruded polyline" ? 0.7 : 0.9) *
                                static_cast<double>(tally.ticks));
    all.ticks += tally.ticks, all.proved += tally.proved, all.wrong += tally.wrong;
  }
  std::printf("in all %lld ticks, %lld certified, %lld wrong\n", static_cast<long long>(all.ticks),
              static_cast<long long>(all.proved), static_cast<long long>(all.wrong));
}

/// Where a chord ends, Newton's method must not see the slope of the next one: a search that began there called a foot
/// the nearest that was 12 um too far.
TEST(Kinks, AreSeenFromTheSideOfThePiece) {
  const Model model(extrudedPolyline());
  std::mt19937 random(7);
  std::uniform_real_distribution<double> x(-0.03, 0.03), y(-0.01, 0.03), z(-0.01, 0.04);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d p(x(random), y(random), z(random));
    for (std::uint32_t k = 0; k < model.pieceCount(); ++k) {
      const CurvePiece& piece = model.piece(k);
      const auto from = [&](double share) {
        Hit hit;
        pieceFoot(model.geometry(), piece, p, piece.t0 + share * (piece.t1 - piece.t0), 1, hit);
        return std::sqrt(hit.d2);
      };
      ASSERT_NEAR(from(0), from(0.5), kRounding) << "piece " << k << ", probe " << p.transpose();
      ASSERT_NEAR(from(1), from(0.5), kRounding) << "piece " << k << ", probe " << p.transpose();
    }
    for (std::uint32_t k = 0; k < model.leafCount(); ++k) {
      const Leaf& leaf = model.leaf(k);
      const auto from = [&](double share) {
        Hit hit;
        LeafStart start;
        start.uv = leaf.lo + share * (leaf.hi - leaf.lo);
        leafFoot(model.geometry(), leaf, model.face(leaf.face), model.part().faces[leaf.face].surface, p, start, hit);
        return std::sqrt(hit.d2);
      };
      if (std::isinf(from(0.5))) continue;  // beyond the end of the tube
      ASSERT_NEAR(from(0), from(0.5), kRounding) << "leaf " << k << ", probe " << p.transpose();
      ASSERT_NEAR(from(1), from(0.5), kRounding) << "leaf " << k << ", probe " << p.transpose();
    }
  }
}

}  // namespace
}  // namespace hapticd::brep
