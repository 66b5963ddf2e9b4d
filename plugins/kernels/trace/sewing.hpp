// SPDX-License-Identifier: MIT
/// Finds how the patches of a model are joined: vertices, seams, common edges, poles, shells.
#pragma once
#include <string>
#include <vector>

#include "kernels/trace/model.hpp"

namespace hapticd::trace {

/// Fills the topology of a Model under construction. Only the constructor of Model uses it.
class Sewing {
 public:
  Sewing(Model& model, const ModelOptions& options);
  /// [main] Joins first the sides that the options name, then the sides that run within the tolerance of each other, in
  /// either direction. A warning is added for sides that cannot be joined (T-junctions, a third surface at an edge),
  /// and for joined surfaces whose outward normals are on opposite sides.
  void run();

 private:
  static constexpr int kSamples = 5;  ///< number of points that are compared along a side
  struct SideCurve {
    int patch, side;
    std::array<Eigen::Vector3d, kSamples> points;
    bool used = false;
  };

  void findVertices();
  void findPoles();
  void collectCurves();
  void joinStated();
  void joinByGeometry();
  void join(SideCurve& a, SideCurve& b, bool flipped);
  static bool runsBack(const SideCurve& a, const SideCurve& b);
  bool runsAlong(const SideCurve& a, const SideCurve& b, bool flipped) const;
  void reportTJunctions();
  void reportDisagreement();
  void findShells();
  void findVertexNormals();
  std::string describe(int patch, int side) const;

  Model& model_;
  const ModelOptions& options_;
  double tolerance_;
  std::vector<SideCurve> curves_;
};

}  // namespace hapticd::trace
