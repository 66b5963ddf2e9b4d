// SPDX-License-Identifier: MIT
/// The one narrow interface between the servo and the simulation side: arm state out (newest value wins, loss is fine),
/// activation records in and model transforms out (reliable, ordered). Plain data only, so that another process or a
/// network domain can stand between the two without a change on either side.
#pragma once
#include <array>
#include <cstddef>

#include "base/clock.hpp"
#include "base/spsc_ring.hpp"
#include "base/triple_buffer.hpp"
#include "hapticd/shape.h"

namespace hapticd::link {

constexpr Nanoseconds kSearchPeriod = 5'000'000;  ///< between two global searches
constexpr uint32_t kMaxProbes = 8;                ///< arms (fingers) of one scene

/// Where the probes are. Published by the servo every tick.
struct ArmState {
  Nanoseconds time_ns = 0;
  uint32_t probe_count = 0;
  std::array<std::array<double, 3>, kMaxProbes> position{};  ///< [m] world
  std::array<bool, kMaxProbes> valid{};
};

/// An order from the simulation side to the tracers.
struct ActivationRecord {
  enum class Order : uint32_t {
    kStart,  ///< the surface has come near: trace it
    kOffer,  ///< it is traced already; here is the global foot, to be taken if it is nearer
    kStop    ///< it has left the neighbourhood
  };
  uint32_t model = 0;
  Order order = Order::kStart;
  hsp_near near{};
};

/// Where a moving model is now.
struct ModelTransform {
  uint32_t model = 0;
  std::array<double, 3> position{};               ///< [m] world
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< w,x,y,z
};

/// Both directions of one link. Each member has one writing thread and one reading thread.
struct Link {
  static constexpr size_t kRecords = 1 << 14;     ///< several searches' worth of a model of thousands of patches
  static constexpr size_t kTransforms = 1 << 12;  ///< 5 ms of records of dozens of moving models at 10 kHz

  TripleBuffer<ArmState> arm;                        ///< servo to simulation
  SpscRing<ModelTransform> transforms{kTransforms};  ///< servo to simulation
  SpscRing<ActivationRecord> records{kRecords};      ///< simulation to servo
};

}  // namespace hapticd::link
