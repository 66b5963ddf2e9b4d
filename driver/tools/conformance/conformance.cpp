// SPDX-License-Identifier: MIT
#include "conformance/conformance.hpp"

#include <cmath>
#include <random>

#include "conformance/building_blocks.hpp"

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

namespace {

/// A source of random numbers from 0 to 1.
class Dice {
 public:
  explicit Dice(uint64_t seed) : random_(seed) {}
  double operator()() { return unit_(random_); }

 private:
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> unit_{0, 1};
};

/// Gives about half of the parameters that the recipe leaves open a random value of their range.
/// @return "", or which value was refused
std::string setAtRandom(Subject& subject, const Recipe& recipe, Dice& unit) {
  const hsp_class& c = subject.description();
  for (uint32_t i = 0; i < c.param_count; ++i) {
    const hsp_param& p = paramAt(c, i);
    if (p.kind > HSP_ENUM || givenIn(recipe.set, p.id) != nullptr || unit() < 0.5) continue;
    hsp_value value{};
    value.kind = p.kind;
    const double most = p.kind == HSP_ENUM ? p.choice_count - 1.0 : p.max, least = p.kind == HSP_ENUM ? 0 : p.min;
    value.number = least + unit() * (most - least);
    if (p.kind != HSP_REAL) value.number = std::floor(value.number);
    if (!std::isfinite(value.number)) continue;
    if (c.set(subject.handle(), i, &value) < 0)
      return std::string(p.id) + " refused " + text(value.number) + ", which is in its range";
  }
  return "";
}

/// Makes one step. @return "", or what is wrong with it
std::string fuzzedStep(Subject& subject, const Vector3d& q, double dt, uint32_t flags) {
  if (std::string wrong = wrongStatus(subject.step({q}, dt, flags)); !wrong.empty()) return wrong;
  if (subject.allocations() > 0) return "it allocates";
  // [ns] If a step waits for longer than this, it sleeps or blocks, which fails the test. Waits that the system
  // forced on it (preemption) do not count.
  constexpr uint64_t kLong = 2'000'000;
  const StepCost& cost = subject.cost();
  if (cost.waited && cost.wall_ns > cost.cpu_ns + kLong)
    return "it waits for " + text(static_cast<double>(cost.wall_ns - cost.cpu_ns) * 1e-6) + " ms";
  return "";
}

}  // namespace

std::string fuzzOnce(const Recipe& recipe, uint64_t seed) {
  Dice unit(seed);
  auto made = Subject::make(recipe);
  if (!made) return made.error();
  if (std::string refused = setAtRandom(**made, recipe, unit); !refused.empty()) return refused;
  if (!(*made)->activate()) return "";  // parameters may contradict each other, so refusing is right
  const auto [low, high] = (*made)->bounds();
  const auto anywhere = [&unit] { return Vector3d(unit(), unit(), unit()); };
  Vector3d q = onPath(**made, unit(), unit());
  (*made)->measureCost();
  for (int i = 0; i < 500; ++i) {
    const double dice = unit();
    uint32_t flags = 0;
    if (dice < 0.02) {
      (*made)->reset();
    } else if (dice < 0.05) {
      flags = HSP_IN_JUMP;
      q = low + anywhere().cwiseProduct(high - low);
    } else if (dice < 0.07) {
      flags = HSP_IN_INVALID;
    }
    q += 2e-3 * (anywhere() - Vector3d::Constant(0.5));
    const double dt = dice > 0.98 ? 0.05 : kConformanceDt;
    if (const std::string wrong = fuzzedStep(**made, q, dt, flags); !wrong.empty())
      return "at step " + std::to_string(i) + ", " + placed(wrong, q);
  }
  return "";
}

}  // namespace hapticd::conformance
