// SPDX-License-Identifier: MIT
#include "cli/ctl/answer.hpp"

#include <cstdio>

#include "cli/support/command.hpp"
#include "document/json_text.hpp"

namespace hapticd::cli {

Result<nlohmann::ordered_json> acceptedAnswer(const Result<std::string>& line) {
  if (!line) return Error{line.error()};
  auto json = document::parseJson(*line);
  if (!json.is_object()) return Error{"the daemon's answer is not valid JSON: " + *line};
  if (!json.value("ok", false)) return Error{json.value("error", std::string("refused"))};
  return json;
}

int exitCodeOf(const Result<std::string>& line, bool of_scene) {
  const auto json = line ? document::parseJson(*line) : nlohmann::ordered_json();
  const std::string code = json.is_object() ? json.value("code", std::string()) : "";
  if (code == "bad_request" || code == "unknown" || code == "out_of_range") return kBadInput;
  return of_scene && code == "failed" ? kBadInput : kFailed;
}

void printNote(const nlohmann::ordered_json& answer) {
  if (const std::string note = answer.value("note", std::string()); !note.empty())
    std::fprintf(stderr, "note: %s\n", note.c_str());
}

}  // namespace hapticd::cli
