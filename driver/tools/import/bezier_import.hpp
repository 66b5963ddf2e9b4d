// SPDX-License-Identifier: MIT
/// Converts Bezier patches (.bpt) into a model file of format hapticd-model/1.
#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace hapticd::importing {

/// One patch of the file: (degree_u + 1) x (degree_v + 1) points, u-major.
struct BezierPatch {
  int degree_u = 0, degree_v = 0;
  std::vector<Eigen::Vector3d> points;
};

struct BezierModel {
  std::vector<std::string> comments;  ///< comment lines of the file (#), which keep credit and licence with the data
  std::vector<BezierPatch> patches;
  bool reversed = false;  ///< true if Su x Sv points inward
};

/// How a model is brought into the arm's workspace.
struct Placement {
  double scale = 1;     ///< metres per unit of the file
  double fit = 0;       ///< [m] largest extent of the surfaces; replaces scale; 0 if not used
  bool center = false;  ///< true moves the middle of the bounding box to the origin
  char up = 'y';        ///< axis of the file that points up; the world's is y
};

/// [main] Reads patches: a count, then for each patch two degrees and its points; # begins a comment line.
Result<BezierModel> parseBpt(const std::string& text, const std::string& file);

/// [main] Returns the box around the surfaces to within a millionth of its size, in the unit of the model.
Eigen::AlignedBox3d boundsOf(const BezierModel& model);

/// [main] Turns, scales and centres all points.
void placeModel(BezierModel& model, const Placement& placement);

/// [main] Does the same as placeModel() for the points of triangles. Only points that are corners of a triangle count
/// for the bounding box.
void placePoints(std::vector<Eigen::Vector3d>& points, const std::vector<std::array<std::uint32_t, 3>>& used,
                 const Placement& placement);

/// [main] Returns the enclosed volume by the divergence theorem; negative if Su x Sv points inward.
double signedVolume(const BezierModel& model);

/// [main] Return the model as YAML, or as JSON.
std::string toModelYaml(const BezierModel& model);
std::string toModelJson(const BezierModel& model);

}  // namespace hapticd::importing
