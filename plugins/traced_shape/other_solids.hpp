// SPDX-License-Identifier: MIT
/// Finds out if a point lies inside other solids of a part. Each solid is asked alone, because a search over all solids
/// returns only the nearest face, and if a bolt fills a hole, the faces of both are equally near.
#pragma once
#include <memory>
#include <vector>

#include "kernels/brep/tracer.hpp"

namespace hapticd {

class OtherSolids {
 public:
  explicit OtherSolids(const brep::Model& part) : part_(part), alone_(part.part().bodies.size()) {}

  /// [main] True if a point (in the model frame) is inside another solid than that of `place`. Returns true also if the
  /// part has so many bodies that the search would take too long.
  bool hold(const Eigen::Vector3d& point, const brep::Placement& place);

 private:
  struct Alone {
    explicit Alone(brep::Part part) : model(std::move(part)), tracer(model) {}
    brep::Model model;
    brep::Tracer tracer;
  };
  const brep::Model& part_;
  std::vector<std::unique_ptr<Alone>> alone_;  ///< by body; made at its first use
  int made_ = 0;
};

}  // namespace hapticd
