// SPDX-License-Identifier: MIT
/// What a run was like: the numbers of `--report`, and the same for people.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/result.hpp"
#include "record/client_report.hpp"
#include "record/contact_statistics.hpp"
#include "record/histogram.hpp"

namespace hapticd::record {

/// What one arm felt of a model.
struct ArmContact {
  std::string device;
  ContactStatistics contact;
};

struct ModelReport {
  std::string name, plugin;
  ContactStatistics contact;        ///< of the arm that is deepest in each tick
  uint64_t degraded_ticks = 0;      ///< in which it answered coarser than asked, for a tick's budget
  uint32_t coarsest = 0;            ///< level of accuracy, 0: as asked
  double residual_m = 0;            ///< largest error that a coarser answer told
  double given_j = 0, taken_j = 0;  ///< [J] work that its forces did on the hands, and that these did against them
  bool moves = false;               ///< by its plugin, with energy of its own
  std::vector<ArmContact> arms{};   ///< of each, where there are several
};

/// In how many ticks limits made the force of one device smaller than the scene asked for.
struct LimitReport {
  std::string device;
  uint64_t any = 0;                                     ///< ticks in which at least one limit did so
  std::vector<std::pair<std::string, uint64_t>> ticks;  ///< for each limit, the ticks in which it did so
};

/// How long a joint stood at the end of its range.
struct StopReport {
  std::string device;
  uint32_t joint = 0;  ///< counted from 0, as the columns are
  uint64_t ticks = 0;
};

struct RunReport {
  std::string scene;
  double seconds = 0, rate_hz = 0;  ///< simulated or real time of the run; ticks per second that were achieved
  double wall_seconds = 0;          ///< time that passed on the wall clock
  bool virtual_time = false;
  uint64_t ticks = 0, overruns = 0, missed_ticks = 0;
  Histogram lateness_us, compute_us;
  Histogram arms_us;               ///< the arms' part of compute: physics of simulated arms, traffic of others
  long page_faults = 0;            ///< those of the servo thread after its warm-up
  uint64_t servo_allocations = 0;  ///< the same
  uint64_t resident_bytes = 0;
  double start_ms = 0;  ///< from the start of the program to the first tick
  std::vector<ModelReport> models;
  std::vector<LimitReport> limits;  ///< one per device
  std::vector<StopReport> stops;    ///< joints that stood at a stop
  std::vector<std::string> faults;
  std::vector<ClientReport> clients;  ///< programs that pushed
  double answer_time = 0;             ///< [s] how long the servo listened for them
};

/// [main] Writes the report as JSON, whole or not at all.
Result<void> writeJson(const RunReport& report, const std::string& file);

/// [main] The report as text for a terminal.
std::string summary(const RunReport& report);

}  // namespace hapticd::record
