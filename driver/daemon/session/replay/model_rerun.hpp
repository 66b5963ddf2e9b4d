// SPDX-License-Identifier: MIT
/// Touches one model with the recorded tips again, so that a soft body gets the shape that it had in the recorded run.
/// The result is only for drawings: unlike a replay, this class leaves out arms, other models and orders.
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
  static constexpr double kMemory = 2;  ///< [s] a body that was last touched longer ago than this is at rest

  /// [main] Fails if the rows have no tip positions. @param recording must outlive the result @param world must outlive
  /// the result; it has one model, and a probe for each arm of the recording
  static Result<std::unique_ptr<ModelRerun>> prepare(const record::Recording& recording, World& world);

  /// [main] Steps the model to the time t [s] of the recording. It goes on from the time of the last call if t is less
  /// than kMemory later; otherwise it begins with a body at rest at t - kMemory. The call takes as long as all these
  /// steps of the model.
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
  uint64_t next_ = 0;  ///< number of the next row
  double last_ = 0;    ///< [s] time of the last tick that was stepped
  bool begun_ = false;
};

}  // namespace hapticd::servo
