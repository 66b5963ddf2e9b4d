// SPDX-License-Identifier: MIT
/// Says what a check waits for while a plugin takes long to set up a model.
#pragma once
#include "description/scene.hpp"
#include "host/child.hpp"

namespace hapticd::diagnostics {

class SlowSetup {
 public:
  /// @param trail names the model that is being set up  @param limit [s] time after which its call is ended
  SlowSetup(const scene::Scene& scene, const host::ChildProgress& trail, double limit)
      : scene_(scene), trail_(trail), limit_(limit) {}

  /// [main] Prints a line on standard error once the call has taken 10 s, 20 s, 40 s and so on.
  /// @param seconds [s] time that the present call has taken
  void look(double seconds);

 private:
  static constexpr double kFirst = 10;  // [s]
  const scene::Scene& scene_;
  const host::ChildProgress& trail_;
  double limit_, next_ = kFirst;
};

}  // namespace hapticd::diagnostics
