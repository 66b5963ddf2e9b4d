// SPDX-License-Identifier: MIT
/// Problems: what is wrong with a file, in words for the person who wrote the file.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace hapticd::document {

/// A place in a file. Lines and columns count from 1; 0 means that the line is unknown.
struct Place {
  std::string file;
  int line = 0, column = 0;
};

/// What a problem says about its key, for those who rely on the value.
enum class ProblemKind : uint8_t {
  kValue,        ///< the value is wrong, is missing, or cannot be read
  kUnknownKey,   ///< no such key; it may stand for any other
  kMisspeltKey,  ///< the key of a parameter is misspelt; the value was read as that of the parameter that is meant
  kUnusedValue   ///< the value was read, but another key says that it is not used
};

struct Problem {
  Place place;
  std::string key;   ///< such as "models[2].parameters.stiffness"; "" for the file as a whole
  std::string what;  ///< what is wrong, and what was expected
  /// Of a syntax error: the text that was not read because of it, or that may stand in another place than the writer
  /// meant. Problems that may follow from it are not reported (see dropFollowUps()).
  std::string left_out{};
  ProblemKind kind = ProblemKind::kValue;

  /// Returns a message such as "scene.yaml:12:18: models[2].parameters.stiffness: -5 N/m is out of range, expected 0 to
  /// 20000 N/m".
  std::string text() const;
};

using Problems = std::vector<Problem>;

/// Adds a problem.
void report(Problems& problems, const Place& place, const std::string& key, const std::string& what,
            ProblemKind kind = ProblemKind::kValue);
void report(Problems& problems, const std::string& file, int line, int column, const std::string& key,
            const std::string& what);

/// Adds the problems of another list.
void append(Problems& problems, Problems more);

/// Returns all problems as text, one in a line.
std::string textOf(const Problems& problems);

/// Sorts problems by line within each file, as editors list them, and keeps the order of the files.
void sortByPlace(Problems& problems);

/// [any] Removes problems that may only follow from text that was left out after a syntax error: a key is said to be
/// missing that is in this text, or a message names such a key.
void dropFollowUps(Problems& problems);

/// [any] Returns true if a part of a file was left out after a syntax error.
bool leavesOut(const Problems& problems, const std::string& file);

}  // namespace hapticd::document
