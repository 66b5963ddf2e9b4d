// SPDX-License-Identifier: MIT
#include "kernels/medial/moving_mesh.hpp"

#include <Eigen/Geometry>

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

Vector3d at(const float* xyz, uint32_t i) noexcept {
  return Eigen::Map<const Vector3f>(xyz + 3 * std::size_t{i}).cast<double>();
}

}  // namespace

uint32_t MovingMesh::add(const Vector3d& center, const Vector3d& normal, double radius, std::span<const Share> shares) {
  const auto first = static_cast<uint32_t>(shares_.size());
  for (const Share& share : shares)
    if (share.weight != 0) shares_.push_back(share);
  vertices_.push_back({center.cast<float>(), normal.cast<float>(), static_cast<float>(radius), first,
                       static_cast<uint32_t>(shares_.size()) - first});
  return static_cast<uint32_t>(vertices_.size() - 1);
}

void MovingMesh::triangle(uint32_t a, uint32_t b, uint32_t c) {
  if (a != b && b != c && c != a) indices_.insert(indices_.end(), {a, b, c});
}

std::vector<float> MovingMesh::atRest() const {
  std::vector<float> xyz(3 * vertices_.size());
  write([](std::size_t) { return Eigen::Vector4f::Zero(); }, xyz.data(), vertices_.size());
  return xyz;
}

std::vector<float> MovingMesh::normalsOf(const std::vector<float>& xyz) const {
  std::vector<float> normals(xyz.size(), 0);
  for (std::size_t t = 0; t + 2 < indices_.size(); t += 3) {
    const Vector3d a = at(xyz.data(), indices_[t]);
    const Vector3f area =
        (at(xyz.data(), indices_[t + 1]) - a).cross(at(xyz.data(), indices_[t + 2]) - a).cast<float>();
    for (std::size_t k = 0; k < 3; ++k) Eigen::Map<Vector3f>(normals.data() + 3 * std::size_t{indices_[t + k]}) += area;
  }
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    Eigen::Map<Vector3f> normal(normals.data() + 3 * i);
    const float length = normal.norm();
    normal = length > 0 ? Vector3f(normal / length) : vertices_[i].normal;
  }
  return normals;
}

double MovingMesh::sixVolumes(const float* xyz, std::size_t first, std::size_t last) const noexcept {
  double sum = 0;
  for (std::size_t t = 3 * first; t < 3 * last && t + 2 < indices_.size(); t += 3)
    sum += at(xyz, indices_[t]).dot(at(xyz, indices_[t + 1]).cross(at(xyz, indices_[t + 2])));
  return sum;
}

double MovingMesh::volume(const std::vector<float>& xyz) const noexcept {
  return sixVolumes(xyz.data(), 0, indices_.size() / 3) / 6;
}

double MovingMesh::area(const std::vector<float>& xyz) const noexcept {
  double sum = 0;
  for (std::size_t t = 0; t + 2 < indices_.size(); t += 3) {
    const Vector3d a = at(xyz.data(), indices_[t]);
    sum += (at(xyz.data(), indices_[t + 1]) - a).cross(at(xyz.data(), indices_[t + 2]) - a).norm() / 2;
  }
  return sum;
}

std::size_t MovingMesh::bytes() const noexcept {
  return vertices_.capacity() * sizeof(Vertex) + shares_.capacity() * sizeof(Share) +
         indices_.capacity() * sizeof(uint32_t);
}

}  // namespace hapticd::medial
