// SPDX-License-Identifier: MIT
/// Reads nodes into values and checks them. Everything that is wrong becomes a problem, and reading goes on.
#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "document/node.hpp"

namespace hapticd::document {

struct Key;
struct Table;

/// Bounds of a number. An infinite bound means that there is none.
struct Range {
  double min, max;
  const char* unit = "";
};

/// Returns the range for messages, such as "0 to 20000 N/m" or "0 N/m or more".
std::string expectedOf(const Range& range);

/// Returns the shortest text that reads back as the same number.
std::string numberText(double value);

class Reader {
 public:
  Reader(std::filesystem::path file, Problems& problems) : file_(std::move(file)), problems_(problems) {}

  void problem(const Node& at, const std::string& key, const std::string& what,
               ProblemKind kind = ProblemKind::kValue) {
    report(problems_, place(at), key, what, kind);
  }
  Place place(const Node& at) const { return {file_.string(), at.line, at.column}; }
  const std::filesystem::path& file() const { return file_; }
  Problems& problems() { return problems_; }

  /// Reads a finite number in a range.
  std::optional<double> number(const Node& node, const std::string& key, const Range& range);
  std::optional<double> whole(const Node& node, const std::string& key, const Range& range);
  std::optional<bool> boolean(const Node& node, const std::string& key);
  /// Reads one of the choices, and returns its index.
  std::optional<size_t> choice(const Node& node, const std::string& key, std::span<const std::string> choices);
  std::optional<std::string> text(const Node& node, const std::string& key);
  /// Reads a name without commas, quotes and control characters, so that it may stand in a column of a CSV file.
  std::optional<std::string> name(const Node& node, const std::string& key);
  /// Reads the path of a file that exists, and returns it as an absolute path. A relative path begins at the folder of
  /// the file that names it.
  std::optional<std::filesystem::path> existingFile(const Node& node, const std::string& key);
  std::optional<Eigen::Vector3d> vector3(const Node& node, const std::string& key, const Range& range);
  /// Reads a quaternion w, x, y, z. Its length must be 1 within 1e-3; the result is normalised.
  std::optional<Eigen::Quaterniond> quaternion(const Node& node, const std::string& key);

  /// Reads a mapping by its table: reports unknown keys, wrong values and missing keys, and stores values in `object`.
  void object(const Node& node, const std::string& key, const Table& table, void* object);

 private:
  /// Reports a wrong value that stands outside of the mapping to which its key belongs; nullptr reports nothing.
  void judge(const Node& node, const std::string& path, const Key* key);

  std::filesystem::path file_;
  Problems& problems_;
};

/// Joins two parts of a key: "models[2]" and "pose" give "models[2].pose".
std::string joined(const std::string& parent, const std::string& key);

/// Normalises a quaternion (w, x, y, z) in place. Returns false if its length is not 1 within 1e-3.
bool normalise(Eigen::Quaterniond& q);

}  // namespace hapticd::document
