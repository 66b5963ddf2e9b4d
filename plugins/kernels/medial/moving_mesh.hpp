// SPDX-License-Identifier: MIT
/// A closed mesh of triangles that moves with the nodes of a soft body, for drawing and for the body's volume.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace hapticd::medial {

/// Displacement [m] of each node: x, y, z of its position, then its radius.
using Displacements = std::vector<Eigen::Vector4f>;

class MovingMesh {
 public:
  virtual ~MovingMesh() = default;  ///< virtual, because owners do not know the derived class

  std::size_t vertexCount() const noexcept { return vertices_.size(); }
  /// Three vertices per triangle, counter-clockwise if seen from outside.
  const std::vector<uint32_t>& indices() const noexcept { return indices_; }

  /// [any] Writes the vertices of the displaced body, 3 floats each: at most `capacity` vertices, from `first` on.
  /// `displacement(i)` returns the displacement of node i (an Eigen vector of 4); all radii grow by `bulge` [m].
  /// Allocates nothing.
  /// @return the number of vertices written
  template <class Displacement>
  std::size_t write(const Displacement& displacement, float* xyz, std::size_t capacity, float bulge = 0,
                    std::size_t first = 0) const noexcept {
    const std::size_t left = vertices_.size() - (first < vertices_.size() ? first : vertices_.size());
    const std::size_t count = capacity < left ? capacity : left;
    for (std::size_t i = 0; i < count; ++i) {
      const Vertex& vertex = vertices_[first + i];
      Eigen::Vector4f moved = Eigen::Vector4f::Zero();
      for (uint32_t k = vertex.first; k < vertex.first + vertex.count; ++k)
        moved += shares_[k].weight * displacement(shares_[k].node);
      const float radius = vertex.radius + moved[3] + bulge;
      Eigen::Map<Eigen::Vector3f>(xyz + 3 * i) =
          vertex.center + moved.head<3>() + (radius > 0 ? radius : 0) * vertex.normal;
    }
    return count;
  }
  /// [main] Returns the vertices of the body at rest, 3 floats each.
  std::vector<float> atRest() const;
  /// [main] Returns the unit normals of a displaced mesh: at each vertex the mean of the triangles around it.
  std::vector<float> normalsOf(const std::vector<float>& xyz) const;
  /// [any] Returns six times the volume [m^3] between the origin and the triangles `first` to `last` - 1. Summed over
  /// all triangles it is six times the volume of the body.
  double sixVolumes(const float* xyz, std::size_t first, std::size_t last) const noexcept;
  double volume(const std::vector<float>& xyz) const noexcept;  ///< [any] [m^3] volume of the displaced mesh
  double area(const std::vector<float>& xyz) const noexcept;    ///< [any] [m^2] area of the displaced mesh
  std::size_t bytes() const noexcept;

 protected:
  struct Share {
    uint32_t node;
    float weight;
  };
  /// Adds a vertex on the sphere of `radius` about `center`, in the direction `normal`; shares of 0 are left out.
  /// @return its index
  uint32_t add(const Eigen::Vector3d& center, const Eigen::Vector3d& normal, double radius,
               std::span<const Share> shares);
  void triangle(uint32_t a, uint32_t b, uint32_t c);
  Eigen::Vector3d normal(uint32_t vertex) const { return vertices_[vertex].normal.cast<double>(); }

 private:
  struct Vertex {
    Eigen::Vector3f center, normal;
    float radius;
    uint32_t first, count;  ///< range of its shares in shares_
  };

  std::vector<Vertex> vertices_;
  std::vector<Share> shares_;
  std::vector<uint32_t> indices_;
};

}  // namespace hapticd::medial
