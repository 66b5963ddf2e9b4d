// SPDX-License-Identifier: MIT
/// The answers of a running daemon about itself, one line of JSON each. Only the request worker may call these
/// functions. The servo runs meanwhile, so all values come from pages and ring buffers that may be read while the servo
/// writes them.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "description/scene.hpp"
#include "session/requests/leads.hpp"
#include "session/run/runner.hpp"

namespace hapticd::servo {

/// A place for a model, as the request worker sees it. The number of the place is the number of the model in every row.
struct ModelPlace {
  scene::Model model;  ///< the model, with the present values of its parameters
  bool taken = false, enabled = true;
  uint64_t since = 0;  ///< tick from which on it is there. Another model may have had its name and place before.
};

struct Session {
  const Runner& runner;
  const std::vector<ModelPlace>& places;
  const Leads& leads;
  const std::string& scene_file;
};

/// [any] Writes JSON as one line.
std::string lineOf(const nlohmann::ordered_json& json);

/// [any] Returns a pose as answers have it.
nlohmann::ordered_json jsonOf(const scene::Pose& pose);

/// [main] Returns the counts of a pushing program so far.
record::ClientReport reportOf(const ClientForces::Client& client, const Leads::Pusher& pusher,
                              const std::string& device);

/// [main] Answers `status`: times, devices, and models that are not felt. @param socket "" if there is none
std::string statusAnswer(const Session& session, const std::string& name, const std::string& socket);

/// [main] Returns why a model is not felt for the rest of the run, or "" if it may be felt.
std::string silencedWhy(const Session& session, uint32_t place);

/// [main] True if a tip was inside the model when it was added or enabled, and has not left it since. The model is not
/// felt until then.
bool waitsForTip(const Session& session, uint32_t place);

/// [main] Returns why an arm gets no force now, and what to do; "" if nothing keeps its force off.
std::string noForceWhy(const Session& session, uint32_t arm);

/// [main] Lists the models: names, numbers, poses, leaders, and live parameters with their values.
std::string listAnswer(const Session& session);

/// [main] Answers a program that begins to read rows now. The answer contains the number of the next row of each
/// stream, every device, and every model with its pose, even if the model rests.
std::string snapshotAnswer(const Session& session);

/// [main] Returns the error for a parameter that the plugin does not have, with a list of its parameters.
/// @param flags HSP_P_LIVE: list only live parameters; 0: list all
std::string noSuchParameter(const hsp_class& plugin, const std::string& parameter, uint32_t flags);

/// [any] Returns the error for a device that a scene does not have, with a list of its devices.
std::string noSuchDevice(const scene::Scene& scene, const std::string& device);

/// [main] Returns the value of one parameter, or of all if `parameter` is "".
Result<std::string> valuesAnswer(const Session& session, uint32_t place, const std::string& parameter);

/// [main] Returns an event as a JSON object, without a line end.
std::string eventText(const Session& session, const hapticd_event& event);

}  // namespace hapticd::servo
