// SPDX-License-Identifier: MIT
#include "conformance/conformance.hpp"

#include <cmath>
#include <random>

#include "conformance/conformance_parts.hpp"

namespace hapticd::conformance {

using Eigen::Vector3d;

const std::vector<ConformanceTest>& conformanceTests() {
  static const std::vector<ConformanceTest> kTests = [] {
    std::vector<ConformanceTest> all = lifeTests();
    for (const auto& more : {costTests(), stepTests(), contactTests(), memoryTests()})
      all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return kTests;
}

std::string fuzzOnce(const Recipe& recipe, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  auto made = Subject::make(recipe);
  if (!made) return made.error();
  const hsp_class& c = (*made)->description();
  for (uint32_t i = 0; i < c.param_count; ++i) {
    const hsp_param& p = paramAt(c, i);
    if (p.kind > HSP_ENUM || recipe.find(p.id) != nullptr || unit(random) < 0.5) continue;
    hsp_value value{};
    value.kind = p.kind;
    const double most = p.kind == HSP_ENUM ? p.choice_count - 1.0 : p.max, least = p.kind == HSP_ENUM ? 0 : p.min;
    value.number = least + unit(random) * (most - least);
    if (p.kind != HSP_REAL) value.number = std::floor(value.number);
    if (!std::isfinite(value.number)) continue;
    if (c.set((*made)->handle(), i, &value) < 0)
      return std::string(p.id) + " refused " + text(value.number) + ", which is in its range";
  }
  if (!(*made)->activate()) return "";  // parameters may contradict each other, so refusing is right
  const auto [low, high] = (*made)->bounds();
  Vector3d q = onPath(**made, unit(random), unit(random));
  (*made)->measureCost();
  for (int i = 0; i < 500; ++i) {
    const double dice = unit(random);
    uint32_t flags = 0;
    if (dice < 0.02) {
      (*made)->reset();
    } else if (dice < 0.05) {
      flags = HSP_IN_JUMP;
      q = low + Vector3d(unit(random), unit(random), unit(random)).cwiseProduct(high - low);
    } else if (dice < 0.07) {
      flags = HSP_IN_INVALID;
    }
    q += 2e-3 * Vector3d(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5);
    const double dt = dice > 0.98 ? 0.05 : kConformanceDt;
    if (std::string wrong = wrongStatus((*made)->step({q}, dt, flags)); !wrong.empty())
      return "at step " + std::to_string(i) + ", " + placed(wrong, q);
    if ((*made)->allocations() > 0) return "at step " + std::to_string(i) + ", " + placed("it allocates", q);
    // [ns] If a step waits for longer than this, it sleeps or blocks, which fails the test. Waits that the system
    // forced on it (preemption) do not count.
    constexpr uint64_t kLong = 2'000'000;
    const StepCost& cost = (*made)->cost();
    if (cost.waited && cost.wall_ns > cost.cpu_ns + kLong)
      return "at step " + std::to_string(i) + ", " +
             placed("it waits for " + text(static_cast<double>(cost.wall_ns - cost.cpu_ns) * 1e-6) + " ms", q);
  }
  return "";
}

}  // namespace hapticd::conformance
