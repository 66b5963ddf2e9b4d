// SPDX-License-Identifier: MIT
/// Runs a recording again: the same loop, arms, limits and models get the recorded samples, activation records, orders
/// and times. Every result is compared with the recorded one, bit by bit.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "record/recording.hpp"
#include "servo/loop/loop.hpp"
#include "session/replay/about.hpp"
#include "session/replay/later_models.hpp"
#include "session/telemetry/telemetry.hpp"
#include "world/world.hpp"

namespace hapticd::servo {

/// The first number that differs from the recording.
struct Difference {
  uint64_t tick = 0;
  double t = 0;      ///< [s]
  std::string what;  ///< such as "contacts: fx of model teapot"
  double recorded = 0, replayed = 0;
};

struct ReplayOutcome {
  uint64_t ticks = 0, recorded_ticks = 0;
  std::optional<Difference> first;
  double largest_force_error = 0;  ///< [N] largest difference of a force sent to a device, over all ticks
  std::string note;                ///< why the replay ended before the end of the recording; "" if it reached the end
};

class Replay {
 public:
  /// [main] Builds the world of the recording, and the models that came later. @param run the result of readAbout(),
  /// with `later`; the caller may have changed it to see the effect
  static Result<std::unique_ptr<Replay>> prepare(const record::Recording& recording, RecordedRun run,
                                                 const host::Services::Log& log);
  ~Replay();

  /// Called between two ticks with the rows of `ticks`: the recorded one, and what the replay gives.
  using EachTick = std::function<void(const std::byte* recorded, const std::byte* replayed)>;

  ReplayOutcome run(const EachTick& each = {});  ///< [main] call once

 private:
  class Player;
  Replay(const record::Recording& recording, RecordedRun run);
  Result<void> buildWorld(const host::Services::Log& log);
  Result<void> openArms(const host::Services::Log& log);
  void buildLater(const host::Services::Log& log);

  const record::Recording& recording_;
  RecordedRun run_;
  std::vector<std::unique_ptr<host::Playback>> playbacks_;
  bool paced_ = false;  ///< true if the samples of an arm drove the recorded run
  std::unique_ptr<World> world_;
  LaterModels later_;
  Arms arms_;
  std::unique_ptr<Telemetry> telemetry_;
  std::unique_ptr<Player> player_;
  std::unique_ptr<Loop> loop_;
  EachTick each_;
};

}  // namespace hapticd::servo
