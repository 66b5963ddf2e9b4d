// SPDX-License-Identifier: MIT
/// The medial axis of a body from samples of its surface, as spheres joined by edges and triangles.
///
/// Shrinking balls (Ma, Bae and Choi 2012) give a point of the axis for each sample; the fewest of them whose spheres,
/// grown by the tolerance, cover the surface are kept (the covering of Dou et al. 2022, solved greedily); all others
/// are witnesses of what is joined: the two spheres nearest to one are an edge, the three nearest a triangle (the
/// witness complex of de Silva and Carlsson 2004). What would stand out of the body is left out.
#pragma once
#include <Eigen/Core>
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "import/triangles.hpp"

namespace hapticd::importing {

struct SurfaceSamples {
  std::vector<Eigen::Vector3d> points, normals;  ///< normals: outward, unit
  double spacing = 0;                            ///< [m] about the distance of neighbours
};

struct MedialOptions {
  double tolerance = 1e-3;  ///< [m] by which spheres may be too small or extend too far
  int most_spheres = 2000;  ///< at which covering ends
  double least_angle = 60;  ///< [degrees] between the two feet of a medial point: fewer are ripples of the surface
};

struct MedialAxis {
  std::vector<Eigen::Vector4d> spheres;  ///< centre and radius
  std::vector<std::array<int, 2>> edges;
  std::vector<std::array<int, 3>> triangles;
  double covered = 0;  ///< share of the surface within the tolerance of a sphere
  int parts = 0;       ///< that are not joined
};

/// [main] About `count` points spread evenly over the triangles, always the same points.
SurfaceSamples sampleSurface(const Triangles& mesh, std::size_t count);

/// [main] `progress` is told what is being done. Fails if nothing is inside.
Result<MedialAxis> medialAxis(const SurfaceSamples& samples, const MedialOptions& options,
                              const std::function<void(const std::string&)>& progress);

}  // namespace hapticd::importing
