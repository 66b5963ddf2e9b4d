// SPDX-License-Identifier: MIT
/// A leader moves a wall of 800 N/m under a resting hand: by 5 cm at 0.5 Hz. It sends 60 records per second through a
/// bad network, which loses a fifth of them and delays each by up to 50 ms, so that their order changes. The hand feels
/// roughness if the force steps more from tick to tick than the true motion would make it step.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include "bench.hpp"
#include "servo/core/led_pose.hpp"

namespace hapticd::bench {

namespace {

constexpr double kTravel = 0.05, kTurn = std::numbers::pi, kRate = 60, kLost = 0.2, kJitter = 0.05, kStiffness = 800;
constexpr int kTicks = 20'000;

double place(double t) {
  return kTravel * std::sin(kTurn * t);
}

struct Sent {
  double arrives;
  hapticd_target target;
};

std::vector<Sent> sent(unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Sent> all;
  for (double t = 0.001; t < kTicks * 1e-3; t += 1 / kRate) {
    hapticd_target target{};
    target.position[0] = place(t);
    target.linear[0] = kTravel * kTurn * std::cos(kTurn * t);
    target.orientation[0] = 1;
    target.time = 100 + t;
    if (share(random) >= kLost) all.push_back({t + kJitter * share(random), target});
  }
  std::sort(all.begin(), all.end(), [](const Sent& a, const Sent& b) { return a.arrives < b.arrives; });
  return all;
}

void through(unsigned seed) {
  const std::vector<Sent> records = sent(seed);
  link::PoseSlot slot;
  hsp_pose pose{};
  pose.orientation[0] = 1;
  servo::LedPose led;
  led.begin(slot, pose);
  std::vector<double> errors;
  double last = 0, worst = 0, true_step = 0;
  size_t next = 0;
  for (int i = 0; i < kTicks; ++i) {
    const double t = i * 1e-3;
    for (; next < records.size() && records[next].arrives <= t; ++next) slot.put(records[next].target);
    led.step(t, 1e-3, 100, pose);
    true_step = std::max(true_step, kStiffness * std::abs(place(t) - place(t - 1e-3)));
    if (i > 1000) {
      worst = std::max(worst, kStiffness * std::abs(pose.position[0] - last));
      errors.push_back(std::abs(pose.position[0] - place(t)));
    }
    last = pose.position[0];
  }
  std::sort(errors.begin(), errors.end());
  std::printf(
      "seed %u: error p99 %.2f mm, largest step of the force %.3f N, of the true motion %.3f N, beyond it %.3f N\n",
      seed, 1e3 * errors[errors.size() * 99 / 100], worst, true_step, worst - true_step);
}

}  // namespace

void network() {
  std::printf("60 Hz, 20 %% lost, 50 ms jitter, 5 cm at 0.5 Hz, 800 N/m\n");
  for (unsigned seed = 1; seed <= 5; ++seed) through(seed);
}

}  // namespace hapticd::bench
