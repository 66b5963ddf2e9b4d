// SPDX-License-Identifier: MIT
#include "session/replay/model_rerun.hpp"

#include <algorithm>
#include <cstring>
#include <string>

namespace hapticd::servo {

namespace {

using record::Column;
using record::ColumnType;

/// Returns a column if it and the next `count` - 1 columns are numbers of 8 bytes; otherwise nullptr.
const Column* reals(const record::RecordedStream& stream, const std::string& name, uint32_t count) {
  const Column* column = stream.find(name);
  const bool fits = column != nullptr && column->type == ColumnType::kReal &&
                    column->offset + count * sizeof(double) <= stream.rowBytes();
  return fits ? column : nullptr;
}

constexpr int kSettle = 50;     ///< ticks without a touch, after which a soft body is at rest
constexpr double kTick = 1e-3;  ///< [s] length of the ticks of kSettle

}  // namespace

Result<std::unique_ptr<ModelRerun>> ModelRerun::prepare(const record::Recording& recording, World& world) {
  const record::RecordedStream* ticks = recording.stream("ticks");
  if (ticks == nullptr || ticks->rows() == 0) return Error{"the recording has no ticks"};
  std::unique_ptr<ModelRerun> rerun(new ModelRerun(*ticks, world));
  rerun->time_ = ticks->find("t");
  if (rerun->time_ == nullptr)
    return Error{"the stream ticks of the recording has no column t (the times of the ticks)"};
  rerun->probes_.resize(world.core().probeCount());
  for (size_t i = 0; i < rerun->probes_.size(); ++i) {
    const std::string arm = "arm" + std::to_string(i) + "_";
    const Tip tip{ticks->find(arm + "valid"), reals(*ticks, arm + "x", 3), reals(*ticks, arm + "qw", 4),
                  reals(*ticks, arm + "vx", 3)};
    if (!tip.valid || !tip.position || !tip.orientation || !tip.velocity)
      return Error{"the recording has no tip position, orientation or velocity for " + arm.substr(0, arm.size() - 1)};
    rerun->tips_.push_back(tip);
  }
  return rerun;
}

/// Returns the number of rows that are not later than t.
uint64_t ModelRerun::rowsUntil(double t) const {
  uint64_t low = 0, high = ticks_->rows();
  while (low < high) {
    const uint64_t middle = low + (high - low) / 2;
    if (timeOf(middle) <= t)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

void ModelRerun::beginAt(uint64_t row) {
  world_->shapes()[0]->reset();
  lockstep_.emplace(world_->lockstep());
  for (Probe& probe : probes_) probe.valid = false;
  begun_ = false;
  for (int i = kSettle; i > 0; --i) tick(timeOf(row) - i * kTick);
  next_ = row;
}

void ModelRerun::goTo(double t) {
  const uint64_t end = rowsUntil(t), begin = std::min(rowsUntil(t - kMemory), ticks_->rows() - 1);
  if (!lockstep_ || end < next_ || begin > next_) beginAt(begin);
  while (next_ < end) step();
}

void ModelRerun::step() {
  const std::byte* row = ticks_->row(next_);
  for (size_t i = 0; i < probes_.size(); ++i) {
    const Tip& tip = tips_[i];
    Probe& probe = probes_[i];
    double orientation[4];
    std::memcpy(probe.position.data(), row + tip.position->offset, 3 * sizeof(double));
    std::memcpy(probe.velocity.data(), row + tip.velocity->offset, 3 * sizeof(double));
    std::memcpy(orientation, row + tip.orientation->offset, sizeof orientation);
    probe.orientation = quaternionOf(orientation);
    probe.valid = ticks_->number(next_, *tip.valid) == 1 && probe.position.allFinite() && probe.velocity.allFinite() &&
                  probe.orientation.coeffs().allFinite();
  }
  tick(timeOf(next_++));
}

/// Steps the model to time t with the present probes. In a damaged file times may run backward; such a row is skipped.
void ModelRerun::tick(double t) {
  const double dt = begun_ ? t - last_ : 0;
  if (!(dt >= 0)) return;
  world_->core().publish(t, probes_);
  lockstep_->before(t);
  world_->core().tick(t, dt, probes_);
  last_ = t;
  begun_ = true;
}

}  // namespace hapticd::servo
