// SPDX-License-Identifier: MIT
/// What the status page of a run says at one moment, for people (a table) and programs (JSON).
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "diagnostics/machine/client_warnings.hpp"
#include "status/page.hpp"

namespace hapticd::live_status {

struct ModelLine {
  std::string name, plugin;
  status::ModelStatus now;
  status::ModelFeet feet;
  std::string silenced;              ///< why the model was silenced; "" if it was not
  double p50 = 0, p99 = 0, max = 0;  ///< [us] times of a step
  bool traced = false;               ///< stepped lately, with a depth
  /// [any] Returns at which end of its range its joint stands: "lowest", "highest", or "".
  std::string end() const;
};

struct ArmLine {
  std::string name, module;
  status::ArmStatus now;
  double force() const;       ///< [any] [N] length of the force that was sent
  std::string fault() const;  ///< [any] what the fault is; "" if there is none
};

struct LiveStatus {
  status::TickStatus now;
  double rate = 0, held = 0;  ///< [Hz] rate that the scene asks for, and ticks per second since the last look
  double late[3] = {}, compute[3] = {};  ///< [us] p50, p99 and maximum of lateness, and of the work of a tick
  std::vector<ArmLine> arms;
  std::vector<ModelLine> models;
  std::vector<diagnostics::ClientStatus> clients;
  double answer_time = 0;  ///< [s]
};

/// [any] Reads a page. `held` is not in it, so it stays 0.
LiveStatus readPage(const status::Page& page);

/// [any] @param by `step` (p99, the longest first), `force`, `depth` or `name`
void sortModels(std::vector<ModelLine>& models, const std::string& by);

nlohmann::ordered_json toJson(const LiveStatus& live);   ///< [any] keys have their units
std::string table(const LiveStatus& live, size_t rows);  ///< [any] @param rows most models that are listed

}  // namespace hapticd::live_status
