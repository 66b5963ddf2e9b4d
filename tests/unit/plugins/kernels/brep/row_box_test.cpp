// SPDX-License-Identifier: MIT
/// Tests that the distance to the box of a row is never greater than the distance to a point of its element.
#include "kernels/brep/tree/row_box.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "kernels/brep/model/model.hpp"
#include "sample_solids.hpp"
#include "sample_splines.hpp"
#include "traced_shape/model_file.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Array2d;
using Eigen::Vector3d;

constexpr int kAlong = 9;  ///< intervals between points along a curve, or along each axis of a surface

std::vector<Vector3d> pointsOfSurface(const Model& model, std::uint32_t face, const Array2d& lo, const Array2d& hi) {
  std::vector<Vector3d> points;
  spline::SurfacePoint at;
  for (int i = 0; i <= kAlong; ++i)
    for (int j = 0; j <= kAlong; ++j) {
      const Array2d uv = lo + Array2d(i, j) / kAlong * (hi - lo);
      model.geometry().surface(model.part().faces[face].surface, uv[0], uv[1], at);
      points.push_back(at.S);
    }
  return points;
}

std::vector<Vector3d> pointsOfEdge(const Model& model, std::uint32_t edge, double t0, double t1) {
  std::vector<Vector3d> points;
  spline::CurvePoint at;
  for (int i = 0; i <= kAlong; ++i) {
    model.geometry().curve(model.part().edges[edge].curve, t0 + (t1 - t0) * i / kAlong, at);
    points.push_back(at.C);
  }
  return points;
}

std::vector<Vector3d> pointsOf(const Model& model, Element element) {
  const Part& part = model.part();
  const std::uint32_t i = element.index();
  switch (element.kind()) {
    case ElementKind::kFace:
      return pointsOfSurface(model, i, model.face(i).trim.lo(), model.face(i).trim.hi());
    case ElementKind::kLeaf:
      return pointsOfSurface(model, model.leaf(i).face, model.leaf(i).lo, model.leaf(i).hi);
    case ElementKind::kPiece:
      return pointsOfEdge(model, model.piece(i).edge, model.piece(i).t0, model.piece(i).t1);
    case ElementKind::kPole:
      return {vec(part.vertices[part.edges[i].first_vertex].point)};
    default:
      return pointsOfEdge(model, i, part.edges[i].t0, part.edges[i].t1);
  }
}

struct RowTally {
  std::int64_t looks = 0, close = 0;
};

/// Checks the box of one row for probes at distances from a nanometre to a metre.
void lookAtRow(const Model& model, const BodyTree& body, const RowBox& box, Element element, std::mt19937& random,
               RowTally& tally) {
  std::uniform_real_distribution<double> exponent(-9, 0);
  std::normal_distribution<double> normal;
  const std::vector<Vector3d> points = pointsOf(model, element);
  for (const Vector3d& start : points) {
    const Vector3d aside(normal(random), normal(random), normal(random));
    const Vector3d p = start + std::pow(10, exponent(random)) * aside;
    double truth = 1e300;
    for (const Vector3d& point : points) truth = std::min(truth, (p - point).squaredNorm());
    const auto bound = static_cast<double>(rowDistance(box, BoxProbe(body.tree, p)));
    ASSERT_LE(bound, truth) << p.transpose() << ", element of kind " << static_cast<int>(element.kind());
    ++tally.looks;
    tally.close += bound > 0.5 * truth;
  }
}

void expectBounds(const char* name, Part part) {
  SCOPED_TRACE(name);
  const Model model(std::move(part));
  std::mt19937 random(11);
  RowTally tally;
  for (std::uint32_t b = 0; b < model.part().bodies.size(); ++b) {
    const BodyTree& body = model.body(b);
    for (std::size_t i = 0; i < body.elements.size(); ++i) {
      lookAtRow(model, body, body.rows[i], body.elements[i], random, tally);
      if (testing::Test::HasFatalFailure()) return;
    }
  }
  std::printf("%s: %lld looks, %.0f %% of them close\n", name, static_cast<long long>(tally.looks),
              100.0 * static_cast<double>(tally.close) / static_cast<double>(tally.looks));
  EXPECT_GT(tally.close, tally.looks / 5);
}

Part rowOfSheets(const std::string& file) {
  return samples::sheetOf(readModelFile(HAPTICD_SOURCE_DIR "/config/models/" + file).surfaces);
}

/// Four boxes side by side are as far from a probe as one by one, and an unused place is farther than any of them.
TEST(RowBox, FourSideBySideAreAsFarAsAlone) {
  const Model model(samples::plate(6, 5, 0.6, 1.6, 5));
  const BodyTree& body = model.body(0);
  std::mt19937 random(12);
  std::uniform_real_distribution<double> share(-0.5, 1.5);
  for (std::size_t i = 0; i + 4 <= body.rows.size(); ++i) {
    const Eigen::AlignedBox3d& box = body.tree.bounds();
    const Vector3d aside(share(random), share(random), share(random));
    const BoxProbe probe(body.tree, box.min() + aside.cwiseProduct(box.sizes()));
    FourRowBoxes four = fourOf(body.rows[i], body.rows[i + 1], body.rows[i + 2], body.rows[i + 3]);
    const Float4 distances = rowDistances(four, probe);
    for (int lane = 0; lane < 4; ++lane)
      ASSERT_FLOAT_EQ(distances[lane], rowDistance(body.rows[i + static_cast<std::size_t>(lane)], probe)) << i;
    putNothing(static_cast<int>(i % 4), four);
    ASSERT_GT(rowDistances(four, probe)[static_cast<int>(i % 4)], 1e30F) << i;
  }
}

TEST(RowBox, BoundsNoLeafAndNoPieceFromAbove) {
  expectBounds("teapot", rowOfSheets("teapot.yaml"));
  expectBounds("goblet", rowOfSheets("goblet.yaml"));
  expectBounds("torus", rowOfSheets("torus.yaml"));
}

TEST(RowBox, BoundsNoFaceAndNoEdgeFromAbove) {
  expectBounds("bracket", samples::bracket());
  expectBounds("capped cylinder", samples::cappedCylinder(10, 20));
  expectBounds("cone", samples::cone(10, 20));
  expectBounds("torus", samples::torus(20, 5));
  expectBounds("sphere", samples::sphere(10));
  expectBounds("plate of 30 holes", samples::plate(6, 5, 0.6, 1.6, 5));
}

}  // namespace
}  // namespace hapticd::brep
