// SPDX-License-Identifier: MIT
/// bench_motion: measures the processor time of one tick of each kind of motion, without the tracing of surfaces. It is
/// not a test. The goal is less than 1 us for each.
#include <benchmark/benchmark.h>

#include "kernels/contact/friction.hpp"
#include "kernels/contact/wall.hpp"
#include "kernels/dynamics/button.hpp"
#include "kernels/dynamics/oscillator.hpp"
#include "kernels/dynamics/pendulum.hpp"
#include "kernels/dynamics/rigid_body.hpp"

namespace {

using namespace hapticd;
using namespace hapticd::dynamics;
using Eigen::Vector3d;

constexpr double kTick = 1e-3;

RigidBody bodyOf(Joint joint, double angular_damping, const Vector3d& rate) {
  RigidBodyLaw law;
  law.inertia = Vector3d(1, 2, 2.5).asDiagonal();
  law.tether = 20;
  law.damping = 1;
  law.angular_damping = angular_damping;
  law.joint = joint;
  law.pivot = {0.1, 0, 0};
  RigidBody body(law, Vector3d::Zero(), Eigen::Quaterniond::Identity(), {0, -9.81, 0});
  body.setVelocity({0.1, 0, 0}, rate);
  return body;
}

/// A body with several contacts that last, because the probes move with the body.
void pressed(benchmark::State& state, Joint joint) {
  RigidBody body = bodyOf(joint, 0.01, {0.3, 1, 0.2});
  const auto count = static_cast<size_t>(state.range(0));
  std::array<PredictedContact, 8> presses;
  for (auto _ : state) {
    for (size_t i = 0; i < count; ++i) {
      LastContact last;
      last.normal = Vector3d(1, 0.1 * static_cast<double>(i), -0.2).normalized();
      last.point = body.center() + 0.05 * last.normal;
      last.probe = last.point - 1e-3 * last.normal;
      last.depth = 1e-3;
      last.law = {1000, 5, 1, 1e-3};
      presses[i] = predict(last, last.probe, 0.01, body.velocityAt(last.point), kTick);
    }
    body.step({presses.data(), count}, kTick);
    benchmark::DoNotOptimize(body.position());
  }
}
BENCHMARK_CAPTURE(pressed, free, Joint::kFree)->Arg(0)->Arg(1)->Arg(2)->Arg(8);
BENCHMARK_CAPTURE(pressed, hinge, Joint::kHinge)->Arg(0)->Arg(1);
BENCHMARK_CAPTURE(pressed, slider, Joint::kSlider)->Arg(0)->Arg(1);

void freeTop(benchmark::State& state) {
  RigidBody body = bodyOf(Joint::kFree, 0, static_cast<double>(state.range(0)) * Vector3d(0.1, 1, 0.1));
  for (auto _ : state) {
    body.step(Vector3d::Zero(), Vector3d::Zero(), kTick);
    benchmark::DoNotOptimize(body.position());
  }
}
BENCHMARK(freeTop)->ArgName("rad_per_s")->Arg(1)->Arg(30)->Arg(300);

void turn(benchmark::State& state) {
  Rotation rotation;
  for (auto _ : state) {
    rotation.turnWorld({1e-3, -2e-3, 2e-3});
    benchmark::DoNotOptimize(rotation.quaternion());
  }
}
BENCHMARK(turn);

void pendulum(benchmark::State& state) {
  PendulumLaw law;
  law.damping = static_cast<double>(state.range(0)) / 100;
  PendulumState now{2, 0};
  for (auto _ : state) {
    now = advance(law, now, 1e-3, kTick);
    benchmark::DoNotOptimize(now);
  }
}
BENCHMARK(pendulum)->ArgName("damping_percent")->Arg(0)->Arg(1)->Arg(10'000);

void button(benchmark::State& state) {
  std::vector<DetentCurve::Knot> knots = {{0, 0}};
  for (int i = 1; i < state.range(0); ++i) knots.push_back({1e-3 * i, 2.0 + (i % 3)});
  const DetentCurve detent(knots, 8000);
  ButtonState now;
  double phase = 0;
  for (auto _ : state) {
    phase += 1e-3;
    benchmark::DoNotOptimize(now.step(2000, detent, 4e-3 + 4e-3 * std::sin(phase)));
  }
}
BENCHMARK(button)->ArgName("points")->Arg(4)->Arg(64);

void oscillator(benchmark::State& state) {
  const OscillatorStep step = oscillatorStep(1, 0.1, 1000, kTick);
  double x = 1, v = 0;
  for (auto _ : state) {
    advance(step, x, v);
    benchmark::DoNotOptimize(x);
  }
}
BENCHMARK(oscillator);

void wall(benchmark::State& state) {
  const contact::WallLaw law{6000, 20, static_cast<double>(state.range(0)) / 100, 1e-3};
  double depth = 1e-3;
  for (auto _ : state) {
    depth = 2e-3 - depth;
    benchmark::DoNotOptimize(contact::wallForce(law, depth, 0.1));
  }
}
BENCHMARK(wall)->ArgName("exponent_percent")->Arg(50)->Arg(100)->Arg(150);

void friction(benchmark::State& state) {
  contact::Friction now;
  const contact::FrictionLaw law{0.6, 0.4, 800, 1};
  double x = 0;
  for (auto _ : state) {
    x += 1e-5;
    benchmark::DoNotOptimize(now.step(law, {x, 0, 0}, Vector3d::UnitY(), 2, {0.01, 0, 0}));
  }
}
BENCHMARK(friction);

}  // namespace

BENCHMARK_MAIN();
