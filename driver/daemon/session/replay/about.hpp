// SPDX-License-Identifier: MIT
/// The part of a recording that describes the run and is stored beside the rows: versions, the whole scene, what each
/// device reported about itself, and a fingerprint of every file on which forces depend.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "record/layout.hpp"
#include "servo/arm/arm.hpp"
#include "session/replay/fingerprint.hpp"
#include "session/replay/run_models.hpp"
#include "world/world.hpp"

namespace hapticd::servo {

/// Settings of the loop in the recorded run. A replay uses the same settings.
struct RunFacts {
  double rate = 1000;  ///< [Hz] rate of the servo
  uint64_t period_ns = 1'000'000, ticks = 0;
  bool virtual_time = false;
  bool found_pressed = false;     ///< old version: a hold button that was down before the run enabled forces
  bool former_claims = false;     ///< old version: claims bounded neither torques nor steps after a parameter was set
  bool full_when_slow = false;    ///< old version: slow real arms pushed with their full force
  bool former_passivity = false;  ///< old version: a program's steady push counted as created energy
  bool counts_unfelt = false;     ///< old version: the depth of a tick was the deepest of all models, felt or not
  bool follows_gaps = false;      ///< old version: a long gap between two ticks was no jump of the probes
};

/// [main] Describes the run. @param streams the result of flightStreams()
record::About aboutRun(const scene::Scene& scene, const World& world, const Arms& arms, const RunFacts& facts,
                       const std::vector<record::StreamSpec>& streams);

/// The description of a recorded run, as a replay needs it.
struct RecordedRun {
  RunFacts facts;
  scene::Scene scene;
  std::vector<hdv_info> devices;
  std::vector<Fingerprint> files;
  std::vector<RunModel> later;  ///< models that came during the run: RunModels::later(), because rows describe them
  std::string version, started;
  /// live parameters: their names by the name of the model and their index; empty in old recordings
  std::map<std::string, std::map<uint32_t, std::string>> live;
  /// processor instructions that the shapes used; "" in old recordings, which do not contain them
  std::string instructions;
};

/// [main] Reads the description from a recording. An error says what is wrong with the text.
Result<RecordedRun> readAbout(const std::string& json_text);

}  // namespace hapticd::servo
