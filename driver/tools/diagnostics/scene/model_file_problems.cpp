// SPDX-License-Identifier: MIT
#include "diagnostics/scene/model_file_problems.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

namespace hapticd::diagnostics {
namespace {

/// Words after which a refusal quotes the problems of a file: a model file, or the path file of a hand.
constexpr std::string_view kRefused[] = {"cannot be set up: ", "cannot be opened: ", "cannot be started: "};

/// Reads a line such as "/models/soft.yaml:5:13: medial.stifness: unknown key". Returns nothing for any other line.
std::optional<document::Problem> problemOf(const std::string& line) {
  for (size_t colon = line.find(':'); colon != std::string::npos; colon = line.find(':', colon + 1)) {
    char* end = nullptr;
    const long row = std::strtol(line.c_str() + colon + 1, &end, 10);
    if (row <= 0 || *end != ':') continue;
    const char* second = end + 1;
    const long column = std::strtol(second, &end, 10);
    if (column <= 0 || end == second || std::string_view(end).substr(0, 2) != ": ") continue;
    if (line.rfind(": ", colon) != std::string::npos && line.rfind(": ", colon) < colon) return std::nullopt;
    document::Problem problem{{line.substr(0, colon), static_cast<int>(row), static_cast<int>(column)}, "", end + 2};
    const size_t key = problem.what.find(": ");
    if (key != std::string::npos && problem.what.find(' ') > key) {
      problem.key = problem.what.substr(0, key);
      problem.what.erase(0, key + 2);
    }
    return problem;
  }
  return std::nullopt;
}

/// Returns where the problems of a file begin in a message; npos if it quotes none.
size_t quoteIn(const std::string& what) {
  size_t first = std::string::npos;
  for (const std::string_view words : kRefused)
    if (const size_t at = what.find(words); at != std::string::npos) first = std::min(first, at + words.size());
  return first;
}

/// Returns true if the problems say that the file is of another kind, so that it may be the wrong file. The place where
/// it is named is then a problem, too.
bool isOtherKind(const document::Problems& parts) {
  return std::any_of(parts.begin(), parts.end(), [](const document::Problem& one) {
    const bool no_key = one.key.empty() && one.place.line == 1 && !one.place.file.ends_with(".csv");
    return no_key || one.key == "format" || one.key == "surfaces" || one.key == "medial";
  });
}

/// Returns the problems of a message; none if it is not a message about the contents of one file.
document::Problems partsOf(const document::Problem& whole) {
  const size_t begin = quoteIn(whole.what);
  if (begin == std::string::npos) return {};
  document::Problems parts;
  std::istringstream lines(whole.what.substr(begin));
  for (std::string line; std::getline(lines, line);) {
    auto part = problemOf(line);
    if (!part || (!parts.empty() && part->place.file != parts[0].place.file)) return {};
    parts.push_back(*std::move(part));
  }
  document::sortByPlace(parts);
  return parts;
}

bool isTold(const document::Problems& problems, const document::Problem& one) {
  return std::any_of(problems.begin(), problems.end(), [&one](const document::Problem& told) {
    return told.key == one.key && told.what == one.what && told.place.file == one.place.file &&
           told.place.line == one.place.line && told.place.column == one.place.column;
  });
}

}  // namespace

void separateModelFiles(document::Problems& problems) {
  document::Problems all;
  for (document::Problem& one : problems) {
    document::Problems parts = partsOf(one);
    const bool other = isOtherKind(parts);
    if (parts.empty() || (other && parts.size() == 1)) {
      all.push_back(std::move(one));
      continue;
    }
    if (other) {
      one.what = one.what.substr(0, quoteIn(one.what)) + std::to_string(parts.size()) + " problems in " +
                 parts[0].place.file + ", reported at their own places; is it the right file?";
      all.push_back(std::move(one));
    }
    for (document::Problem& part : parts)
      if (!isTold(all, part)) all.push_back(std::move(part));
  }
  problems = std::move(all);
}

void placeInModelFiles(document::Problems& warnings) {
  document::Problems all;
  for (document::Problem& one : warnings) {
    const bool of_model = one.key.starts_with("models[") && one.what.starts_with("/");
    auto part = of_model && one.what.find('\n') == std::string::npos ? problemOf(one.what) : std::nullopt;
    if (!part)
      all.push_back(std::move(one));
    else if (!isTold(all, *part))
      all.push_back(*std::move(part));
  }
  warnings = std::move(all);
}

}  // namespace hapticd::diagnostics
