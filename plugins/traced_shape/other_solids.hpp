// SPDX-License-Identifier: MIT
/// Finds out if a point lies inside other solids of a part. Each solid is searched separately, because a search over
/// all solids returns only the nearest face. If a bolt fills a hole, for example, a face of the bolt and a face of the
/// hole are equally near.
#pragma once
#include "kernels/brep/contact/tracer.hpp"

namespace hapticd {

class OtherSolids {
 public:
  explicit OtherSolids(const brep::Model& part) : part_(part), search_(part) {}

  /// [main] True if a point (in the model frame) is inside a solid other than that of `place`.
  bool hold(const Eigen::Vector3d& point, const brep::Placement& place);

 private:
  const brep::Model& part_;
  brep::Search search_;
};

}  // namespace hapticd
