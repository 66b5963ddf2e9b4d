/// The contour of a body as triangles, for drawing: top and bottom of a skeleton surface closed round its rim, or the
/// tube about a skeleton curve closed by caps. Vertices lie on the envelope of the spheres itself, and move with the
/// body.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "kernels/medial/influence.hpp"
#include "kernels/medial/skeleton.hpp"

namespace hapticd::medial {

/// Displacement of each control point: skeleton (x, y, z) and radius [m].
using Displacements = std::vector<Eigen::Vector4f>;

class Contour {
 public:
  /// [main] Triangles within about `chord_error` [m] of the contour at rest.
  Contour(const Skeleton& skeleton, double chord_error);

  std::size_t vertexCount() const noexcept { return vertices_.size(); }
  /// Three vertices a triangle, counter-clockwise seen from outside.
  const std::vector<uint32_t>& indices() const noexcept { return indices_; }

  /// [any] Writes at most `capacity` vertices, 3 floats each, of the body displaced as `displacement(i)` says of
  /// control point i (an Eigen vector of 4). Allocates nothing.
  template <class Displacement>
  std::size_t write(const Displacement& displacement, float* xyz, std::size_t capacity) const noexcept {
    const std::size_t count = capacity < vertices_.size() ? capacity : vertices_.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Vertex& vertex = vertices_[i];
      Eigen::Vector4f moved = Eigen::Vector4f::Zero();
      const Influence &a = lines_[0][vertex.line[0]], &b = lines_[1][vertex.line[1]];
      for (int r = 0; r < a.count; ++r)
        for (int c = 0; c < b.count; ++c)
          moved += static_cast<float>(a.basis[static_cast<std::size_t>(r)] * b.basis[static_cast<std::size_t>(c)]) *
                   displacement(static_cast<std::size_t>((a.first + r) * columns_ + b.first + c));
      const float radius = vertex.radius + moved[3];
      Eigen::Map<Eigen::Vector3f>(xyz + 3 * i) =
          vertex.center + moved.head<3>() + (radius > 0 ? radius : 0) * vertex.normal;
    }
    return count;
  }
  /// [main] The body at rest.
  std::vector<float> atRest() const;
  /// [main] Unit normals of a displaced mesh: the mean of the triangles around each vertex.
  std::vector<float> normalsOf(const std::vector<float>& xyz) const;

 private:
  struct Vertex {
    std::array<uint32_t, 2> line;  ///< parameter lines that cross here
    Eigen::Vector3f center, normal;
    float radius;
  };
  /// A place of the skeleton with all that a vertex there needs.
  struct Place {
    std::array<uint32_t, 2> line;
    Eigen::Vector3d center, tangent_u, tangent_v, across;
    double radius = 0;
    Eigen::Vector3d slope;  ///< gradient of the radius along the skeleton, at most 1 long
  };

  void chooseLines(const Skeleton& skeleton, double chord_error);
  int segments(const Skeleton& skeleton, std::size_t axis, std::size_t interval, double chord_error) const;
  int arcSegments(double chord_error) const;
  Place place(const Skeleton& skeleton, uint32_t i, uint32_t j) const;
  uint32_t add(const Place& place, const Eigen::Vector3d& normal);
  void triangle(uint32_t a, uint32_t b, uint32_t c);
  void strip(const std::vector<uint32_t>& low, const std::vector<uint32_t>& high);
  void buildSheet(const Skeleton& skeleton, double chord_error);
  void closeRim(const Skeleton& skeleton, const std::array<std::vector<uint32_t>, 2>& faces, int steps);
  void buildTube(const Skeleton& skeleton, double chord_error);

  std::array<std::vector<double>, 2> at_;  ///< parameters of the lines; only while building
  std::array<std::vector<Influence>, 2> lines_;
  std::vector<Vertex> vertices_;
  std::vector<uint32_t> indices_;
  int columns_ = 1;
  double greatest_radius_ = 0;
};

}  // namespace hapticd::medial
