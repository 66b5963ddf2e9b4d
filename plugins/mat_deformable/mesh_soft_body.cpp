// SPDX-License-Identifier: MIT
/// Soft bodies from a medial mesh: cones and slabs.
#include <algorithm>
#include <cstdio>

#include "kernels/medial/mesh_body.hpp"
#include "kernels/medial/mesh_contour.hpp"
#include "push_through.hpp"
#include "soft_body.hpp"

namespace hapticd {
namespace {

using Eigen::Vector3d;
using medial::MedialMesh;
using medial::SkeletonFoot;

constexpr double kMeshHullError = 0.05;  ///< chord error of hull(), as a share of the greatest radius

class MeshSoftBody final : public SoftBody {
 public:
  MeshSoftBody(const medial::MeshBodyData& data, const medial::BodyOptions& options) : body_(data, options) {
    felt_ = body_.feltSurface() != nullptr;
    for (const medial::Sphere& sphere : body_.mesh().vertices())
      greatest_radius_ = std::max(greatest_radius_, sphere.radius);
  }

  /// Searches the whole body in every tick: with the tree this is as fast as following the foot, and no foot is ever
  /// lost. The search begins at the foot of the last tick. It ends early in the middle of a body whose parts are all
  /// equally near.
  void find(const Vector3d& p, uint32_t, const FindOptions& options, Track& track) const noexcept override {
    const uint32_t start = track.known ? track.foot.element : MedialMesh::kNoStart;
    track.apart = body_.feet(p, start, options.crease, track.foot, track.rival);
  }
  Felt felt(const Vector3d& p, const Vector3d& moved, Track& track) const noexcept override {
    return feltTurning(p, moved, felt_, track);
  }
  medial::BodyForce press(const Vector3d& p, const SkeletonFoot& foot, const Felt& felt,
                          double closing_speed) const noexcept override {
    return body_.press(p, foot, felt.normal, felt.depth, closing_speed);
  }
  void placeOf(const Vector3d& p, const SkeletonFoot& foot, const Felt& felt, medial::Envelope,
               medial::FeltPlace& place) noexcept override {
    const double distance = (p - foot.center).norm();
    const double cosine = distance > 0 ? felt.normal.dot(p - foot.center) / distance : 0;
    body_.placeOf(p, foot, felt.normal, medial::directness(cosine), place);
  }
  medial::FeltSurface* feltSurface() noexcept override { return body_.feltSurface(); }
  void yield(std::span<const medial::Press> contacts) noexcept override { body_.deformation().press(contacts); }
  SkeletonFoot search(const Vector3d& p, const FindOptions& options) const noexcept override {
    return body_.foot(p, MedialMesh::kNoStart, options.crease);
  }

  medial::Nodes& nodes() noexcept override { return body_.deformation(); }
  const Eigen::AlignedBox3d& bounds() const noexcept override { return body_.mesh().bounds(); }
  double greatestRadius() const noexcept override { return greatest_radius_; }
  double greatestStiffness() const noexcept override { return body_.greatestStiffness(); }
  std::unique_ptr<medial::MovingMesh> contour(double chord_error) const override {
    return std::make_unique<medial::MeshContour>(body_.mesh(), chord_error);
  }
  std::unique_ptr<medial::MovingMesh> hull() const override { return contour(kMeshHullError * greatest_radius_); }
  std::size_t bytes() const noexcept override { return sizeof *this - sizeof body_ + body_.bytes(); }

  std::vector<FeltMaterial> feltMaterial() const override {
    std::vector<FeltMaterial> all;
    for (std::size_t i = 0; i < body_.mesh().vertices().size(); ++i) {
      const medial::Sphere& sphere = body_.mesh().vertices()[i];
      const double stiffness = body_.stiffness(i);  // the spring is linear
      all.push_back({sphere.center + sphere.radius * Vector3d::UnitZ(), stiffness, stiffness, stiffness});
    }
    return all;
  }

  Description describe(const std::string&) const override {
    std::size_t cones = 0;
    for (const MedialMesh::Element& element : body_.mesh().elements()) cones += element.count < 3 ? 1 : 0;
    const std::size_t slabs = body_.mesh().elements().size() - cones;
    char text[256];
    std::snprintf(text, sizeof text, "%zu vertices, at rest until touched; a medial mesh of %zu cone%s and %zu slab%s",
                  body_.mesh().vertices().size(), cones, cones == 1 ? "" : "s", slabs, slabs == 1 ? "" : "s");
    return {text, false};
  }

 private:
  medial::MeshBody body_;
  double greatest_radius_ = 0;
  /// The force fades out after a push through the body only if the body is felt.
  bool felt_ = false;
};

}  // namespace

std::unique_ptr<SoftBody> makeSoftBody(const medial::MeshBodyData& data, const medial::BodyOptions& options) {
  return std::make_unique<MeshSoftBody>(data, options);
}

}  // namespace hapticd
