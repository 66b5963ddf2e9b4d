// SPDX-License-Identifier: MIT
#include "cad_import/placed_part.hpp"

#include <cstdio>
#include <set>
#include <stdexcept>
#include <string>

namespace hapticd::cad {
namespace {

using brep::Part;
using brep::SurfaceKind;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Scales the numbers of a part. Splines may share their numbers, so each point is scaled only once.
class Scaler {
 public:
  Scaler(Part& part, double scale) : part_(part), scale_(scale) {}

  void run() {
    for (brep::Surface& surface : part_.surfaces) scaleSurface(surface);
    for (brep::Curve3& curve : part_.curves3) {
      scale(curve.o), scale(curve.x), scale(curve.y);
      if (curve.kind == brep::CurveKind::kSpline) scalePoints(curve.data + curve.count + curve.degree + 1, curve.count);
    }
    for (brep::Vertex& vertex : part_.vertices) scale(vertex.point), vertex.tolerance *= scale_;
    for (brep::Edge& edge : part_.edges) edge.tolerance *= scale_;
    for (brep::Face& face : part_.faces) face.tolerance *= scale_;
    for (brep::Instance& instance : part_.instances)
      for (const std::size_t at : {3, 7, 11}) instance.pose[at] *= scale_;
    for (brep::Loss& loss : part_.losses) loss.size *= scale_;
    part_.tolerance *= scale_;
  }

 private:
  void scale(brep::Vector& v) const {
    for (double& x : v) x *= scale_;
  }

  void scalePoints(std::uint64_t first, std::uint64_t count) {
    if (!scaled_.insert(first).second) return;
    for (std::uint64_t i = first; i < first + 3 * count; ++i) part_.reals[i] *= scale_;
  }

  void scaleSurface(brep::Surface& s) {
    scale(s.o);
    for (double& r : s.r) r *= scale_;
    if (s.kind == SurfaceKind::kPlane) scale(s.x), scale(s.y);
    if (s.kind == SurfaceKind::kPlane || s.kind == SurfaceKind::kCylinder || s.kind == SurfaceKind::kCone ||
        s.kind == SurfaceKind::kExtrusion)
      scale(s.z);
    if (s.kind == SurfaceKind::kSpline)
      scalePoints(s.data + s.count[0] + s.degree[0] + 1 + s.count[1] + s.degree[1] + 1,
                  std::uint64_t{s.count[0]} * s.count[1]);
  }

  Part& part_;
  double scale_;
  std::set<std::uint64_t> scaled_;  ///< where the points of splines begin that were scaled
};

/// Returns the rotation that makes y of the axis that points up.
Matrix3d turnOf(char up) {
  Matrix3d turn = Matrix3d::Identity();
  if (up == 'z') turn << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  if (up == 'x') turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  return turn;
}

/// Moves all instances. Each has a pose of its own in the part's frame.
void movePart(Part& part, const Matrix3d& turn, const Vector3d& by) {
  for (brep::Instance& instance : part.instances) {
    Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> pose(instance.pose.data());
    pose = (turn * pose).eval();
    pose.col(3) += by;
    pose = pose.array() + 0.0;  // no minus zero
  }
}

/// [m] Larger numbers are refused by the reader of parts.
constexpr double kLargest = 1e6;

std::string tooLarge(double scale, double extent) {
  char text[160];
  std::snprintf(text, sizeof text, "the part is %.4g m large with the factor %.4g, expected at most %.0f m\n  fix: %s",
                scale * extent, scale, kLargest, "give a smaller --scale, or --fit METRES");
  return text;
}

std::string wordsOf(const Placement& placement) {
  std::string words;
  if (placement.up != 'y') words = std::string("turned, ") + placement.up + " is up";
  if (placement.center) words += (words.empty() ? "" : ", ") + std::string("centred");
  return words;
}

}  // namespace

void scalePart(Part& part, double scale) {
  Scaler(part, scale).run();
}

void placePart(Part& part, const Placement& placement, const Eigen::AlignedBox3d& box) {
  const double extent = box.sizes().maxCoeff();
  const double scale = placement.fit > 0 && extent > 0 ? placement.fit / extent : placement.scale;
  if (scale * extent > kLargest) throw std::runtime_error(tooLarge(scale, extent));
  if (scale != 1) scalePart(part, scale);
  const Matrix3d turn = turnOf(placement.up);
  const Vector3d by = placement.center ? Vector3d(turn * (-scale * box.center())) : Vector3d(0, 0, 0);
  if (placement.center || placement.up != 'y') movePart(part, turn, by);
  part.source.scale = scale;
  part.source.placed = wordsOf(placement);
}

}  // namespace hapticd::cad
