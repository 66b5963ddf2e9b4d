// SPDX-License-Identifier: MIT
/// Traces with the kernel alone, for sizes that a scene cannot have, because the host's search is limited to 1 km.

#include "extreme_case.hpp"
#include "kernels/trace/tracer.hpp"

namespace hapticd::extremes {

std::vector<Answer> traceAlone(const Case& c) {
  constexpr int kSearchEvery = 5;  // ticks
  const trace::Model model(c.surfaces);
  trace::Tracer tracer(model);
  trace::Found found;
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < c.probe.size(); ++i) {
    if (i % kSearchEvery == 0) {
      model.search(c.probe[i], 2 * model.bounds().diagonal().stableNorm(), found);
      for (const auto* records : {&found.nearest, &found.rivals})
        for (const trace::Near& near : *records) tracer.activate(near.surface, near.u, near.v, near.distance);
    }
    const trace::Foot foot = tracer.step(c.probe[i]);
    answers.push_back({foot.point, foot.normal, foot.surface >= 0, foot.evaluations});
  }
  return answers;
}

}  // namespace hapticd::extremes
