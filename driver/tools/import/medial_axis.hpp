// SPDX-License-Identifier: MIT
/// Computes the medial axis of a body from samples of its surface, as spheres joined by edges and triangles.
///
/// For each sample, a shrinking ball (Ma, Bae and Choi 2012) gives a point of the axis. As few of these balls as
/// possible are kept: their spheres, grown by the tolerance, must cover the surface (the covering of Dou et al. 2022,
/// solved greedily). All other balls are witnesses, which decide which spheres are joined. The two spheres nearest to a
/// witness get an edge, the three nearest a triangle (the witness complex of de Silva and Carlsson 2004). Edges and
/// triangles that would stick out of the body are left out.
#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "import/progress_line.hpp"
#include "import/triangles.hpp"

namespace hapticd::importing {

struct SurfaceSamples {
  std::vector<Eigen::Vector3d> points, normals;  ///< [m]; unit normals that point outward
  double spacing = 0;                            ///< [m] approximate distance of neighbouring samples
};

struct MedialOptions {
  double tolerance = 1e-3;  ///< [m] spheres may miss the surface by this, inward or outward
  int most_spheres = 2000;  ///< largest number of spheres
  double least_angle = 60;  ///< [degrees] least angle between the two feet of a medial point, seen from it; points with
                            ///< a smaller angle come from ripples of the surface
};

struct MedialAxis {
  std::vector<Eigen::Vector4d> spheres;  ///< centre and radius
  std::vector<std::array<int, 2>> edges;
  std::vector<std::array<int, 3>> triangles;
  double covered = 0;  ///< share of the surface samples that lie within the tolerance of a sphere
  int parts = 0;       ///< number of parts that are not joined to each other
};

/// [main] Returns about `count` points spread evenly over the triangles, the same in every call.
SurfaceSamples sampleSurface(const Triangles& mesh, std::size_t count);

/// [main] Computes the medial axis. Shows each step in `progress`. Fails if no ball fits inside the
/// surface.
Result<MedialAxis> medialAxis(const SurfaceSamples& samples, const MedialOptions& options, ProgressLine& progress);

}  // namespace hapticd::importing
