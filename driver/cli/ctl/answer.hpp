// SPDX-License-Identifier: MIT
/// An answer of the daemon, as the requests of `hapticd ctl` take it.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "base/result.hpp"

namespace hapticd::cli {

/// [main] Returns the answer as JSON if the daemon carried out the request. The error is that of `line`, or the reason
/// why the daemon refused. @param line the answer as it came
Result<nlohmann::ordered_json> acceptedAnswer(const Result<std::string>& line);

/// [main] Returns the exit code of a request whose answer was not accepted: bad input if the daemon did not understand
/// the request, does not know what it names, or does not allow the value; else a failure.
/// @param line the answer as it came  @param of_scene the request names a scene, so a failure is one of its files
int exitCodeOf(const Result<std::string>& line, bool of_scene = false);

/// [main] Prints the note of an answer, if it has one, where it is not taken for output.
void printNote(const nlohmann::ordered_json& answer);

}  // namespace hapticd::cli
