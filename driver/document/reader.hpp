// SPDX-License-Identifier: MIT
/// Reads nodes into values with checks; everything that is wrong becomes a problem and reading goes on.
#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "document/node.hpp"

namespace hapticd::document {

struct Table;

/// Bounds of a number; infinite: none.
struct Range {
  double min, max;
  const char* unit = "";
};

/// "0 to 20000 N/m", "0 N/m or more".
std::string expectedOf(const Range& range);

/// The shortest text that reads back as the same number.
std::string numberText(double value);

class Reader {
 public:
  Reader(std::filesystem::path file, Problems& problems) : file_(std::move(file)), problems_(problems) {}

  void problem(const Node& at, const std::string& key, const std::string& what) {
    report(problems_, place(at), key, what);
  }
  Place place(const Node& at) const { return {file_.string(), at.line, at.column}; }
  const std::filesystem::path& file() const { return file_; }
  Problems& problems() { return problems_; }

  /// A finite number in a range.
  std::optional<double> number(const Node& node, const std::string& key, const Range& range);
  std::optional<double> whole(const Node& node, const std::string& key, const Range& range);
  std::optional<bool> boolean(const Node& node, const std::string& key);
  /// Index into the choices.
  std::optional<size_t> choice(const Node& node, const std::string& key, std::span<const std::string> choices);
  std::optional<std::string> text(const Node& node, const std::string& key);
  /// A name that may stand in a table's column: no comma, quote or control character.
  std::optional<std::string> name(const Node& node, const std::string& key);
  /// The absolute path of a file that exists; relative paths start from the folder of the file being read.
  std::optional<std::filesystem::path> existingFile(const Node& node, const std::string& key);
  std::optional<Eigen::Vector3d> vector3(const Node& node, const std::string& key, const Range& range);
  /// w, x, y, z; normalised if its length is 1 within 1e-3.
  std::optional<Eigen::Quaterniond> quaternion(const Node& node, const std::string& key);

  /// Reads a mapping by its table: checks unknown keys, values and required keys, and stores values in `object`.
  void object(const Node& node, const std::string& key, const Table& table, void* object);

 private:
  std::filesystem::path file_;
  Problems& problems_;
};

/// "models[2]" + "pose" = "models[2].pose".
std::string joined(const std::string& parent, const std::string& key);

/// Normalises a quaternion (w, x, y, z) in place. False: its length is not 1 within 1e-3.
bool normalise(Eigen::Quaterniond& q);

}  // namespace hapticd::document
