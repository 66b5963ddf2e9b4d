// SPDX-License-Identifier: MIT
/// What a running daemon answers about itself, one line of JSON each. Control thread only: the servo goes on meanwhile,
/// so all of it comes from pages and rings that may be read beside it.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "description/scene.hpp"
#include "session/leads.hpp"
#include "session/runner.hpp"

namespace hapticd::servo {

/// A place that a model may have, as the control thread knows it. Its number is the model's number in every row.
struct ModelPlace {
  scene::Model model;  ///< parameters as they are now
  bool taken = false, enabled = true;
};

struct Session {
  const Runner& runner;
  const std::vector<ModelPlace>& places;
  const Leads& leads;
  const std::string& scene_file;
};

/// [any] JSON as one line.
std::string lineOf(const nlohmann::ordered_json& json);

/// [main] How a program that pushes has behaved until now.
record::ClientReport reportOf(const ClientForces::Client& client, const Leads::Pusher& pusher,
                              const std::string& device);

/// [main] Times, devices, and models that are not felt. @param socket "" if there is none
std::string statusAnswer(const Session& session, const std::string& name, const std::string& socket);

/// [main] Why a model is not felt for the rest of the run; "" if it is felt.
std::string silencedWhy(const Session& session, uint32_t place);

/// [main] A tip was in the model when it was added or enabled, so it is felt once no tip is in it.
bool waitsForTip(const Session& session, uint32_t place);

/// [main] Why an arm gets no force now, and what to do; "" if it gets what is asked for.
std::string noForceWhy(const Session& session, uint32_t arm);

/// [main] Models: names, numbers, poses, leaders, and live parameters with their values.
std::string listAnswer(const Session& session);

/// [main] What a program needs that begins to read rows now: the next row of each stream, every model with its pose,
/// including resting ones, and every device.
std::string snapshotAnswer(const Session& session);

/// [main] The words for a parameter that the plugin does not have, with those that it has.
/// @param flags HSP_P_LIVE: only live ones were meant; 0: all
std::string noSuchParameter(const hsp_class& plugin, const std::string& parameter, uint32_t flags);

/// [any] The error for a device that a scene does not have, with those that it has.
std::string noSuchDevice(const scene::Scene& scene, const std::string& device);

/// [main] The value of one parameter, or of all.
Result<std::string> valuesAnswer(const Session& session, uint32_t place, const std::string& parameter);

/// [main] One event as a JSON object, without a line end.
std::string eventText(const Session& session, const hapticd_event& event);

/// [main] The value of a numeric parameter of the plugin's table, as given or by default.
double valueOf(const scene::Model& model, const hsp_param& param, uint32_t index);

}  // namespace hapticd::servo
