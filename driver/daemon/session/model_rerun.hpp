// SPDX-License-Identifier: MIT
/// Touches one model again with the tips of a recording, so that a body which deforms has the shape that it had then.
/// The shape is for drawings alone: unlike a replay this computes neither the arms nor other models nor orders.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/result.hpp"
#include "record/recording.hpp"
#include "world/world.hpp"

namespace hapticd::servo {

class ModelRerun {
 public:
  static constexpr double kMemory = 2;  ///< [s] A body touched longer ago than this has come to rest.

  /// [main] @param recording, world outlive it; the world has one model, and a probe for each arm of the recording.
  /// Fails if the rows hold no tip positions
  static Result<std::unique_ptr<ModelRerun>> prepare(const record::Recording& recording, World& world);

  /// [main] Brings the model to the time t [s] of the recording. It steps on from the last call if that is less than
  /// kMemory away, otherwise from rest at t - kMemory. The call costs as much as these ticks of the model.
  void goTo(double t);

 private:
  struct Tip {
    const record::Column *valid, *position, *orientation, *velocity;
  };
  ModelRerun(const record::RecordedStream& ticks, World& world) : ticks_(&ticks), world_(&world) {}
  double timeOf(uint64_t row) const { return ticks_->number(row, *time_); }
  uint64_t rowsUntil(double t) const;
  void beginAt(uint64_t row);
  void step();
  void tick(double t);

  const record::RecordedStream* ticks_;
  World* world_;
  const record::Column* time_ = nullptr;
  std::vector<Tip> tips_;
  std::vector<Probe> probes_;
  std::optional<Lockstep> lockstep_;
  uint64_t next_ = 0;  ///< row
  double last_ = 0;    ///< [s] of the tick before
  bool begun_ = false;
};

}  // namespace hapticd::servo
