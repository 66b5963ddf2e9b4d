// SPDX-License-Identifier: MIT
/// The contour of a body as triangles, for drawing. About a skeleton surface it has a top and a bottom that are joined
/// round the rim; about a skeleton curve it is a tube with caps. The vertices lie exactly on the envelope of the
/// spheres, and move with the body.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "kernels/medial/influence.hpp"
#include "kernels/medial/moving_mesh.hpp"
#include "kernels/medial/skeleton.hpp"

namespace hapticd::medial {

class Contour : public MovingMesh {
 public:
  /// [main] Makes triangles that are within about `chord_error` [m] of the contour at rest.
  Contour(const Skeleton& skeleton, double chord_error);

 private:
  /// A point of the skeleton with the values that a vertex of the contour needs there.
  struct Place {
    std::array<uint32_t, 2> line;
    Eigen::Vector3d center, tangent_u, tangent_v, across;
    double radius = 0;
    Eigen::Vector3d slope;  ///< gradient of the radius along the skeleton, of length 1 at most
  };

  void chooseLines(const Skeleton& skeleton, double chord_error);
  int segments(const Skeleton& skeleton, std::size_t axis, std::size_t interval, double chord_error) const;
  int arcSegments(double chord_error) const;
  Place place(const Skeleton& skeleton, uint32_t i, uint32_t j) const;
  uint32_t addAt(const Place& place, const Eigen::Vector3d& normal);
  void strip(const std::vector<uint32_t>& low, const std::vector<uint32_t>& high);
  void buildSheet(const Skeleton& skeleton, double chord_error);
  void closeRim(const Skeleton& skeleton, const std::array<std::vector<uint32_t>, 2>& faces, int steps);
  void buildTube(const Skeleton& skeleton, double chord_error);

  std::array<std::vector<double>, 2> at_;  ///< parameters of the lines; used only while building
  /// influence of the control points at these parameters; used only while building
  std::array<std::vector<Influence>, 2> lines_;
  int columns_ = 1;
  double greatest_radius_ = 0;
};

}  // namespace hapticd::medial
