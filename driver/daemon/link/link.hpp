// SPDX-License-Identifier: MIT
/// The only interface between the servo and the simulation side (the proximity search). The servo sends the state of
/// the arms, of which only the newest value matters, and the transforms of moving models. It receives activation
/// records. Transforms and records keep their order. All messages are plain data, so that the two sides could also run
/// in different processes.
#pragma once
#include <array>
#include <cstddef>

#include "base/clock.hpp"
#include "base/spsc_ring.hpp"
#include "base/triple_buffer.hpp"
#include "hapticd/shape.h"

namespace hapticd::link {

constexpr Nanoseconds kSearchPeriod = 5'000'000;  ///< [ns] time between two searches of the whole scene
constexpr uint32_t kMaxProbes = 8;                ///< largest number of arms in a scene

/// Positions of the probes. The servo publishes them every tick.
struct ArmState {
  Nanoseconds time_ns = 0;
  uint32_t probe_count = 0;
  std::array<std::array<double, 3>, kMaxProbes> position{};  ///< [m] world frame
  std::array<double, kMaxProbes> depth{};  ///< [m] greatest depth of the probe in a model, one tick ago; 0: no contact
  std::array<bool, kMaxProbes> valid{};
};

/// A message from the proximity search to the shapes that trace surfaces.
struct ActivationRecord {
  enum class Order : uint32_t {
    kStart,  ///< the surface has come near: begin to trace it
    kOffer,  ///< the surface is traced already: take the foot point of the search if it is nearer than the traced one
    kStop    ///< the surface is no longer near: stop tracing it
  };
  uint32_t model = 0;
  Order order = Order::kStart;
  hsp_near near{};
};

/// The present pose of a moving model.
struct ModelTransform {
  uint32_t model = 0;
  std::array<double, 3> position{};               ///< [m] world frame
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< unit quaternion w,x,y,z
};

/// The queues of both directions. Each queue has one writing thread and one reading thread.
struct Link {
  static constexpr size_t kRecords = 1 << 14;     ///< enough for several searches of a model with thousands of patches
  static constexpr size_t kTransforms = 1 << 12;  ///< enough for dozens of moving models in 5 ms at 10 kHz

  TripleBuffer<ArmState> arm;                        ///< servo to simulation
  SpscRing<ModelTransform> transforms{kTransforms};  ///< servo to simulation
  SpscRing<ActivationRecord> records{kRecords};      ///< simulation to servo
};

}  // namespace hapticd::link
