// SPDX-License-Identifier: MIT
/// Bezier patches (.bpt) into a model file of format hapticd-model/1.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace hapticd::importing {

/// One patch as the file has it: (degree_u + 1) x (degree_v + 1) points, u-major.
struct BezierPatch {
  int degree_u = 0, degree_v = 0;
  std::vector<Eigen::Vector3d> points;
};

struct BezierModel {
  std::vector<std::string> comments;  ///< lines that began with #: credit and licence stay with the data
  std::vector<BezierPatch> patches;
  bool reversed = false;  ///< Su x Sv points inward
};

/// How a model is brought into the arm's workspace.
struct Placement {
  double scale = 1;     ///< file units to m
  double fit = 0;       ///< [m] largest extent of the control points; replaces scale; 0: not used
  bool center = false;  ///< middle of the bounding box to the origin
  char up = 'y';        ///< axis of the file that points up; the world's is y
};

/// [main] Reads patches: a count, then for each patch two degrees and its points; # begins a comment line.
Result<BezierModel> parseBpt(const std::string& text, const std::string& file);

/// [main] Turns, scales and centres all points.
void placeModel(BezierModel& model, const Placement& placement);

/// [main] The same for the points of triangles; the box holds only the corners that are used.
void placePoints(std::vector<Eigen::Vector3d>& points, const std::vector<std::array<std::uint32_t, 3>>& used,
                 const Placement& placement);

/// [main] Volume under the signed surface, by the divergence theorem; negative if Su x Sv points inward.
double signedVolume(const BezierModel& model);

/// [main] The model as YAML, or as JSON.
std::string toModelYaml(const BezierModel& model);
std::string toModelJson(const BezierModel& model);

}  // namespace hapticd::importing
