// SPDX-License-Identifier: MIT
/// Tests contacts with parts, tick by tick.
#include "kernels/brep/contact/tracer.hpp"

#include <gtest/gtest.h>

#include <random>

#include "sample_solids.hpp"

namespace hapticd::brep {
namespace {

using contact::ContactRule;
using contact::Foot;
using contact::FootStatus;
using contact::Sides;
using Eigen::Vector3d;

/// Moves the probe straight from a to b in steps of about `step` [m], and calls see(foot, p) for each.
template <class See>
void walk(Tracer& tracer, const ContactRule& rule, const Vector3d& a, const Vector3d& b, double step, const See& see) {
  const int count = std::max(1, static_cast<int>((b - a).norm() / step));
  for (int i = 0; i <= count; ++i) {
    const Vector3d p = a + (b - a) * i / count;
    see(tracer.step(p, rule), p);
  }
}

TEST(Contact, BeginsOnTheFaceThatIsCrossedAndIsHeldInAThinWall) {
  const Model model(samples::prism({{0, 0}, {30, 0}, {30, 20}, {0, 20}}, 1));  // 1 mm thick
  Tracer tracer(model);
  double last = -1;
  walk(tracer, {}, {0.015, 0.010, 0.005}, {0.015, 0.010, -0.004}, 1e-4, [&](const Foot& foot, const Vector3d& p) {
    // the probe goes through the far side and beyond, and is pushed back all the time
    EXPECT_NEAR(foot.depth, 0.001 - p.z(), 1e-12);
    EXPECT_NEAR(foot.normal.z(), 1, 1e-12);
    EXPECT_GE(foot.depth, last - 1e-12);
    last = foot.depth;
  });
  EXPECT_EQ(tracer.counts().degraded, 0u);
  EXPECT_GT(tracer.counts().held, 20u);
}

TEST(Contact, WithoutHysteresisIsTheNearestFace) {
  const Model model(samples::prism({{0, 0}, {30, 0}, {30, 20}, {0, 20}}, 1));
  Tracer tracer(model);
  const ContactRule nearest{Sides::kFront, 0};
  walk(tracer, nearest, {0.015, 0.010, 0.002}, {0.015, 0.010, -0.001}, 1e-4,
       [&](const Foot& foot, const Vector3d& p) { EXPECT_NEAR(foot.depth, std::min(p.z(), 0.001 - p.z()), 1e-12); });
}

TEST(Contact, IsReleasedOverAConvexEdge) {
  const Model model(samples::prism({{0, 0}, {30, 0}, {30, 20}, {0, 20}}, 10));
  Tracer tracer(model);
  // The probe is pressed 2 mm into the top face and dragged over the edge at x = 30 mm.
  walk(tracer, {}, {0.025, 0.010, 0.012}, {0.025, 0.010, 0.008}, 1e-4, [](const Foot&, const Vector3d&) {});
  walk(tracer, {}, {0.025, 0.010, 0.008}, {0.035, 0.010, 0.008}, 1e-4, [&](const Foot& foot, const Vector3d& p) {
    if (p.x() < 0.030 - 1e-9) {
      EXPECT_NEAR(foot.depth, 0.002, 1e-12) << p.x();
      EXPECT_NEAR(foot.normal.z(), 1, 1e-12);
    } else {
      EXPECT_LE(foot.depth, 1e-12) << p.x();
    }
  });
}

TEST(Contact, RestsAgainstBothFacesOfAConcaveEdge) {
  const Model model(samples::bracket());  // the inner edge at x = y = 10 mm
  Tracer tracer(model);
  Foot foot;
  walk(tracer, {}, {0.020, 0.012, 0.010}, {0.020, 0.008, 0.010}, 1e-4,
       [&](const Foot& f, const Vector3d&) { foot = f; });
  EXPECT_NEAR(foot.depth, 0.002, 1e-12);
  walk(tracer, {}, {0.020, 0.008, 0.010}, {0.007, 0.008, 0.010}, 1e-4, [&](const Foot& f, const Vector3d& p) {
    foot = f;
    const double beyond = std::max(0.010 - p.x(), 0.0);
    EXPECT_NEAR(f.depth, std::hypot(0.002, beyond), 1e-9) << p.x();
  });
  EXPECT_NEAR((foot.point - Vector3d(0.010, 0.010, 0.010)).norm(), 0, 1e-12);
  EXPECT_NEAR(foot.normal.dot(Vector3d(3, 2, 0).normalized()), 1, 1e-9);
}

/// A probe slides over a smooth body, 1 mm deep. Foot and normal must not jump where it crosses seams and poles.
TEST(Contact, SlidesOverSeamsAndPolesWithoutAJump) {
  const Model model(samples::sphere(15));
  Tracer tracer(model);
  tracer.step({0, 0, 0.0155}, {});
  Vector3d last(0, 0, 1);
  for (int i = 0; i <= 20000; ++i) {
    const double a = 1e-3 * i, b = 0.37 * a;  // a curve that winds around the ball
    const Vector3d n(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
    const Foot foot = tracer.step(0.014 * n, {});
    ASSERT_NEAR(foot.depth, 0.001, 1e-12) << i;
    ASSERT_LT((foot.normal - n).norm(), 1e-7) << i;
    ASSERT_LT((foot.normal - last).norm(), 2e-3) << i;
    ASSERT_FALSE(foot.on_edge);
    last = foot.normal;
  }
  EXPECT_EQ(tracer.counts().degraded, 0u);
}

/// Ticks that begin far outside and end deep inside, as at 1000 Hz and 5 m/s, in random directions.
TEST(Contact, FindsTheFirstFaceInTheWay) {
  const Model model(samples::plate(6, 4, 1.5, 5, 2));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  int began = 0;
  for (int i = 0; i < 2000; ++i) {
    Tracer tracer(model);
    const Vector3d from(0.03 * share(random), 0.02 * share(random), 0.0045);
    const Vector3d to(0.03 * share(random), 0.02 * share(random), 0.0005 + 0.001 * share(random));
    tracer.step(from, {});
    const Foot foot = tracer.step(to, {});
    const Vector3d at_top = from + (to - from) * (0.0045 - 0.002) / (0.0045 - to.z());
    double clear = 1;  // distance from the rim of the nearest hole to the point where the path meets the top face
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 4; ++b)
        clear = std::min(clear, std::hypot(at_top.x() - (a + 0.5) * 5e-3, at_top.y() - (b + 0.5) * 5e-3) - 1.5e-3);
    double end = 1;
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 4; ++b)
        end = std::min(end, std::hypot(to.x() - (a + 0.5) * 5e-3, to.y() - (b + 0.5) * 5e-3) - 1.5e-3);
    if (clear > 1e-6 && end > 1e-6) {  // the path goes through the top face and ends below it
      ++began;
      ASSERT_NEAR(foot.depth, 0.002 - to.z(), 1e-9) << i;
    }
  }
  EXPECT_GT(began, 300);
}

TEST(Contact, ShellsAreFeltFromTheSideTheyWereEntered) {
  Part part = samples::prism({{0, 0}, {30, 0}, {30, 20}, {0, 20}}, 10);
  // Only the top face, as a sheet.
  samples::Polyhedron sheet;
  sheet.addPolygon({{{0, 0, 0}, {30, 0, 0}, {30, 20, 0}, {0, 20, 0}}});
  samples::endBody(sheet.part, BodyKind::kSheet, 0);
  const Model model(std::move(sheet.part));
  EXPECT_TRUE(model.open());
  const ContactRule both{Sides::kBoth, std::numeric_limits<double>::infinity()};
  for (const double side : {1.0, -1.0}) {
    Tracer tracer(model);
    walk(tracer, both, {0.015, 0.010, 0.003 * side}, {0.015, 0.010, -0.003 * side}, 1e-4,
         [&](const Foot& foot, const Vector3d& p) {
           EXPECT_NEAR(foot.depth, -side * p.z(), 1e-12);
           EXPECT_NEAR(foot.normal.z(), side, 1e-12);
         });
  }
}

/// A probe in the box of an L, and outside of the L, stays outside while it moves less than the distance to it: no tick
/// needs to search the L again. This must not change any foot, also where the bodies overlap.
TEST(Assembly, BodiesThatStayOutsideAreNotSearchedAgain) {
  Part part = samples::bracket();
  for (const double offset : {0.004, 0.015}) {
    part.instances.push_back(part.instances[0]);
    for (const std::size_t at : {3U, 7U}) part.instances.back().pose[at] = offset;
  }
  const Model model(std::move(part));
  const Vector3d middle = model.bounds().center(), half = 0.5 * model.bounds().diagonal();
  Tracer walking(model), cold(model);
  std::mt19937 random(4);
  std::normal_distribution<double> step(0, 1e-4);
  Vector3d p = middle;
  int evaluations = 0, cold_evaluations = 0, inside = 0;
  for (int i = 0; i < 100000; ++i) {
    p += Vector3d(step(random), step(random), step(random));
    if (((p - middle).cwiseAbs() - half).maxCoeff() > 0.002) p = middle + 0.5 * (p - middle);
    cold.reset();
    const Foot foot = walking.nearest(p), known = cold.nearest(p);
    ASSERT_NEAR(foot.depth, known.depth, 1e-15) << p.transpose();
    inside += foot.depth > 0;
    evaluations += foot.evaluations;
    cold_evaluations += known.evaluations;
  }
  EXPECT_GT(inside, 10000);
  EXPECT_LT(inside, 90000);
  EXPECT_LT(evaluations, 0.5 * cold_evaluations);
}

/// Returns 20 brackets around the point (12, 12, 10) mm. It is in the boxes of all of them, 1 to 2 mm outside of their
/// solids, but 5 mm inside the one of index `inside`.
Part bracketsAround(std::size_t inside) {
  Part part = samples::bracket();
  const Instance first = part.instances[0];
  part.instances.clear();
  for (std::size_t i = 0; i < 20; ++i) {
    part.instances.push_back(first);
    for (const std::size_t at : {3U, 7U})
      part.instances[i].pose[at] = i == inside ? 0.007 : 5e-5 * static_cast<double>(i);
  }
  return part;
}

/// However many boxes contain the probe, a foot is told to be the nearest only if all their bodies were looked at.
TEST(Assembly, ABodyAmongManyIsFeltByAProbeInIt) {
  constexpr int kEnough = 4;  // ticks that search all of the bodies
  const Vector3d p(0.012, 0.012, 0.010);
  for (std::size_t inside = 0; inside < 20; ++inside) {
    const Model model(bracketsAround(inside));
    Tracer tracer(model);
    for (int tick = 0; tick < kEnough; ++tick) {
      const Foot foot = tracer.nearest(p);
      if (foot.status == FootStatus::kNearest || tick == kEnough - 1) {
        EXPECT_NEAR(foot.depth, 0.005, 1e-12) << "tick " << tick << ", inside body " << inside;
        EXPECT_EQ(foot.status, FootStatus::kNearest) << inside;
      }
    }
  }
}

/// The body that is nearest may not be found in a short search. Then a foot in another body is not the nearest for
/// sure.
TEST(Assembly, AFootIsNotCertainIfOneOfTheSearchesWasNot) {
  const Model model(bracketsAround(7));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  int certain = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d p = model.bounds().min() +
                       Vector3d(share(random), share(random), share(random)).cwiseProduct(model.bounds().sizes());
    Tracer quick(model), thorough(model);
    const int most = 1 + i % 64;
    const Foot foot = quick.nearest(p, {most, most});
    Foot known = thorough.nearest(p);
    for (int more = 0; more < 3; ++more) known = thorough.nearest(p);
    if (foot.status != FootStatus::kNearest) continue;
    ++certain;
    ASSERT_NEAR(foot.depth, known.depth, 1e-12) << p.transpose();
  }
  EXPECT_GT(certain, 0);
}

}  // namespace
}  // namespace hapticd::brep
