// SPDX-License-Identifier: MIT
/// Which solids of a part hold a point, each asked alone. The search over all of them answers with the nearest face,
/// and where a bolt fills a hole the faces of both are equally near.
#pragma once
#include <memory>
#include <vector>

#include "kernels/brep/tracer.hpp"

namespace hapticd {

class OtherSolids {
 public:
  explicit OtherSolids(const brep::Model& part) : part_(part), alone_(part.part().bodies.size()) {}

  /// [main] Whether a point of the model's frame is inside a solid placed elsewhere than at `place`. A part of very
  /// many bodies is answered with yes where it takes too long to know.
  bool hold(const Eigen::Vector3d& point, const brep::Placement& place);

 private:
  struct Alone {
    explicit Alone(brep::Part part) : model(std::move(part)), tracer(model) {}
    brep::Model model;
    brep::Tracer tracer;
  };
  const brep::Model& part_;
  std::vector<std::unique_ptr<Alone>> alone_;  ///< by body; made when it is asked first
  int made_ = 0;
};

}  // namespace hapticd
