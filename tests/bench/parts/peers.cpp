// SPDX-License-Identifier: MIT
#include "peers.hpp"

#include <cmath>
#include <limits>

#ifdef HAVE_EMBREE
#include <embree3/rtcore.h>
#endif
#ifdef HAVE_FCL
#include <fcl/fcl.h>
#endif
#ifdef HAVE_CGAL
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#endif

namespace hapticd::bench {
namespace {

using Points = std::vector<std::array<double, 3>>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;
using Eigen::Vector3d;

#ifdef HAVE_EMBREE
/// Returns the point of a triangle nearest to p, in single precision (Ericson, Real-Time Collision Detection, 5.1.5).
Eigen::Vector3f nearestOfTriangle(const Eigen::Vector3f& p, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                                  const Eigen::Vector3f& c) {
  const Eigen::Vector3f ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const float d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  if (d6 >= 0 && d5 <= d6) return c;
  const float va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  return a + (vb * ab + vc * ac) / (va + vb + vc);
}

/// Embree's point query. Embree stores vertices and boxes in single precision and leaves the distance to a triangle to
/// the caller. The caller uses the stored corners, so that all of it is in single precision.
class Embree final : public Peer {
 public:
  /// @param bounded true to limit a query to the upper bound that the last tick gives; false for a plain query, as in
  /// Embree's documentation
  Embree(const Points& points, const Triangles& triangles, bool bounded) : triangles_(triangles), bounded_(bounded) {
    device_ = rtcNewDevice(nullptr);
    scene_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* v = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, points.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) v[3 * i + k] = static_cast<float>(points[i][k]);
    corners_ = v;
    auto* t = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles.size()));
    for (std::size_t i = 0; i < triangles.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) t[3 * i + k] = triangles[i][k];
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcCommitScene(scene_);
  }
  ~Embree() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  double distance(const Vector3d& p, double bound, Vector3d& near) override {
    p_ = p.cast<float>();
    best_ = std::numeric_limits<float>::infinity();
    RTCPointQuery query{};
    query.x = static_cast<float>(p.x());
    query.y = static_cast<float>(p.y());
    query.z = static_cast<float>(p.z());
    query.radius = bounded_ ? static_cast<float>(bound) : std::numeric_limits<float>::infinity();
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &query, &context, &Embree::look, this);
    near = near_.cast<double>();
    return static_cast<double>(std::sqrt(best_));
  }
  std::string name() const override {
    return bounded_ ? "Embree 3 point query (single), bounded" : "Embree 3 point query (single)";
  }

 private:
  static bool look(RTCPointQueryFunctionArguments* args) {
    auto& self = *static_cast<Embree*>(args->userPtr);
    const auto& t = self.triangles_[args->primID];
    const auto at = [&](std::uint32_t i) { return Eigen::Vector3f(self.corners_ + 3 * std::size_t{i}); };
    const Eigen::Vector3f foot = nearestOfTriangle(self.p_, at(t[0]), at(t[1]), at(t[2]));
    const float d2 = (foot - self.p_).squaredNorm();
    if (!(d2 < self.best_)) return false;
    self.best_ = d2;
    self.near_ = foot;
    args->query->radius = std::sqrt(d2);
    return true;
  }
  const Triangles& triangles_;
  const bool bounded_;
  const float* corners_ = nullptr;  ///< corners in the buffer of the geometry
  RTCDevice device_;
  RTCScene scene_;
  Eigen::Vector3f p_, near_;
  float best_ = 0;
};
#endif

#ifdef HAVE_FCL
/// fcl's distance between the mesh and a tiny sphere at the probe.
class Fcl final : public Peer {
 public:
  Fcl(const Points& points, const Triangles& triangles)
      : mesh_(std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>()), ball_(std::make_shared<fcl::Sphered>(1e-9)) {
    std::vector<fcl::Vector3d> v;
    std::vector<fcl::Triangle> t;
    for (const auto& p : points) v.emplace_back(p[0], p[1], p[2]);
    for (const auto& c : triangles) t.emplace_back(c[0], c[1], c[2]);
    mesh_->beginModel();
    mesh_->addSubModel(v, t);
    mesh_->endModel();
  }
  double distance(const Vector3d& p, double, Vector3d& near) override {
    fcl::CollisionObjectd a(mesh_), b(ball_, fcl::Matrix3d::Identity(), p);
    fcl::DistanceRequestd request(true);
    fcl::DistanceResultd result;
    fcl::distance(&a, &b, request, result);
    near = result.nearest_points[0];
    return result.min_distance;
  }
  std::string name() const override { return "fcl distance to a point"; }
  bool slow() const override { return true; }

 private:
  std::shared_ptr<fcl::BVHModel<fcl::OBBRSSd>> mesh_;
  std::shared_ptr<fcl::Sphered> ball_;
};
#endif

#ifdef HAVE_CGAL
class Cgal final : public Peer {
 public:
  using Kernel = CGAL::Simple_cartesian<double>;
  using Tree = CGAL::AABB_tree<
      CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, std::vector<Kernel::Triangle_3>::iterator>>>;
  Cgal(const Points& points, const Triangles& triangles) {
    const auto at = [&](std::uint32_t i) { return Kernel::Point_3(points[i][0], points[i][1], points[i][2]); };
    for (const auto& c : triangles) triangles_.emplace_back(at(c[0]), at(c[1]), at(c[2]));
    tree_.rebuild(triangles_.begin(), triangles_.end());
    tree_.accelerate_distance_queries();
  }
  double distance(const Vector3d& p, double bound, Vector3d& near) override {
    const Kernel::Point_3 q(p.x(), p.y(), p.z());
    const Kernel::Point_3 found = std::isfinite(bound)
                                      ? tree_.closest_point(q, Kernel::Point_3(near.x(), near.y(), near.z()))
                                      : tree_.closest_point(q);
    near = Vector3d(found.x(), found.y(), found.z());
    return (near - p).norm();
  }
  std::string name() const override { return "CGAL AABB tree (double)"; }

 private:
  std::vector<Kernel::Triangle_3> triangles_;
  Tree tree_;
};
#endif

}  // namespace

std::vector<std::unique_ptr<Peer>> makePeers(const Points& points, const Triangles& triangles) {
  std::vector<std::unique_ptr<Peer>> peers;
#ifdef HAVE_EMBREE
  for (const bool bounded : {false, true}) peers.push_back(std::make_unique<Embree>(points, triangles, bounded));
#endif
#ifdef HAVE_FCL
  if (triangles.size() <= 200000) peers.push_back(std::make_unique<Fcl>(points, triangles));
#endif
#ifdef HAVE_CGAL
  peers.push_back(std::make_unique<Cgal>(points, triangles));
#endif
  return peers;
}

}  // namespace hapticd::bench
