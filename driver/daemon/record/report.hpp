// SPDX-License-Identifier: MIT
/// The report of a run: the numbers for `--report`, and the summary for people.
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

/// The contact of one arm with a model.
struct ArmContact {
  std::string device;
  ContactStatistics contact;
};

struct ModelReport {
  std::string name, plugin;
  ContactStatistics contact;        ///< contact of the arm that is deepest in each tick
  uint64_t degraded_ticks = 0;      ///< ticks with a coarser answer, to keep the tick's budget
  uint32_t coarsest = 0;            ///< coarsest level of accuracy; 0 is full accuracy
  double residual_m = 0;            ///< [m] largest error that a coarser answer reported
  double began_j = 0;               ///< [J] energy stored in it where a hand was inside it from the start, at most
  double given_j = 0, taken_j = 0;  ///< [J] work of its forces on the hands; work of the hands against them
  bool moves = false;  ///< true if its plugin moves it, so that it can give energy to the hand without a fault
  double size_m = 0;   ///< [m] size that its plugin reports; 0 if it is not known
  std::vector<ArmContact> arms{};  ///< contact of each arm, if there are several arms
  std::string library{};           ///< file of the plugin; empty if it is not known
};

/// What came between the forces of the models and the hand, for one device.
struct LimitReport {
  std::string device;
  double sent_max_n = 0;                                ///< [N] largest force that was sent to the device
  uint32_t faults = 0;                                  ///< faults of the run, those that are over included
  uint64_t fault_ticks = 0;                             ///< ticks in which a fault kept the force away
  uint64_t not_enabled_ticks = 0;                       ///< ticks in which the enable switch alone kept it away
  double swing_hz = 0;                                  ///< [Hz] swing that no hand makes; 0: there was none
  bool complies = false;                                ///< it is under compliance control
  uint64_t any = 0;                                     ///< ticks in which at least one limit reduced the force
  std::vector<std::pair<std::string, uint64_t>> ticks;  ///< for each limit, the ticks in which it reduced the force
};

/// Counts the ticks in which a joint stood at the end of its range.
struct StopReport {
  std::string device;
  uint32_t joint = 0;  ///< counted from 0, as in the columns
  uint64_t ticks = 0;
};

struct RunReport {
  std::string scene;
  /// [s] simulated or real duration of the run; [Hz] ticks per second that the run achieved
  double seconds = 0, rate_hz = 0;
  double wall_seconds = 0;  ///< time that passed on the wall clock
  bool virtual_time = false;
  uint64_t ticks = 0, overruns = 0, missed_ticks = 0;
  Histogram lateness_us, compute_us;
  Histogram arms_us;               ///< the arms' part of compute: physics of simulated arms, transfers of others
  long page_faults = 0;            ///< page faults of the servo thread after its warm-up
  uint64_t servo_allocations = 0;  ///< allocations of the servo thread after its warm-up
  uint64_t resident_bytes = 0;
  double start_ms = 0;  ///< [ms] time from the start of the program to the first tick
  std::vector<ModelReport> models;
  std::vector<LimitReport> limits;  ///< one per device
  std::vector<StopReport> stops;    ///< joints that stood at a stop
  std::vector<std::string> faults;
  std::vector<ClientReport> clients;  ///< programs that pushed on arms
  double answer_time = 0;             ///< [s] how long the servo waited for their answers
};

/// [main] Writes the report as JSON, completely or not at all.
Result<void> writeJson(const RunReport& report, const std::string& file);

/// Returns the command that tests the plugin of a model, as a person types it.
std::string checkCommand(const ModelReport& model);

/// [main] Returns the report as text for a terminal.
std::string summary(const RunReport& report);

}  // namespace hapticd::record
