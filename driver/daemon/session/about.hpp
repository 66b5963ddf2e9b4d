// SPDX-License-Identifier: MIT
/// What a recording says of the run besides its rows: versions, the scene in full, what each device said of itself, and
/// fingerprints of every file that forces depend on.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "record/layout.hpp"
#include "servo/arm/arm.hpp"
#include "world/world.hpp"

namespace hapticd::servo {

/// What the loop was told; a replay tells it the same.
struct RunFacts {
  double rate = 1000;  ///< [Hz]
  uint64_t period_ns = 1'000'000, ticks = 0;
  bool virtual_time = false;
  bool found_pressed = false;     ///< as formerly, a hold button that was down before the run enabled forces
  bool former_claims = false;     ///< as formerly, claims bounded neither torques nor steps after a parameter was set
  bool full_when_slow = false;    ///< as formerly, real arms pushed with their full force however slow they were
  bool former_passivity = false;  ///< as formerly, a program's steady push counted as created energy
};

/// [main] @param streams of flightStreams
record::About aboutRun(const scene::Scene& scene, const World& world, const std::vector<std::unique_ptr<Arm>>& arms,
                       const RunFacts& facts, const std::vector<record::StreamSpec>& streams);

/// A file on which forces depend, as it was during the run.
struct Fingerprint {
  std::string path, hash;
};

/// What a replay needs to know of the run.
struct RecordedRun {
  RunFacts facts;
  scene::Scene scene;
  std::vector<hdv_info> devices;
  std::vector<Fingerprint> files;
  std::string version, started;
  std::string instructions;  ///< instructions that the shapes used; "": the recording is older than the choice
};

/// [main] Reads it back. An error says what is wrong with the text.
Result<RecordedRun> readAbout(const std::string& json_text);

/// [main] FNV-1a of a file's bytes in hexadecimal; "" if it cannot be read.
std::string fingerprint(const std::string& file);

}  // namespace hapticd::servo
