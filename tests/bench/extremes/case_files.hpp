// SPDX-License-Identifier: MIT
/// Writes a case as the files that a user would write, and reads the tables that the program writes.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "extreme_case.hpp"

namespace hapticd::extremes {

/// A folder with model.json, scene.yaml and probe.csv of a case. The destructor deletes the folder.
class CaseFiles {
 public:
  /// @param device device file in the same folder, which the scene names; "" if the scene has no arm @throws
  /// std::exception
  explicit CaseFiles(const Case& c, const std::string& device = "");
  ~CaseFiles();
  CaseFiles(const CaseFiles&) = delete;
  CaseFiles& operator=(const CaseFiles&) = delete;
  std::filesystem::path operator/(const char* name) const { return path_ / name; }

  /// Runs a shell command in the folder. @throws std::exception with the output of the command if it fails
  void run(const std::string& command) const;

 private:
  std::filesystem::path path_;
};

/// A CSV file of numbers.
class Table {
 public:
  explicit Table(const std::filesystem::path& file);
  std::size_t rows() const { return rows_.size(); }
  /// Returns the number in a cell, or NaN if the cell is empty. @throws std::out_of_range if there is no such column
  double at(std::size_t row, const char* column) const { return rows_[row].at(columns_.at(column)); }
  /// Returns foot, normal and evaluations in a row that `hapticd trace` wrote, or in a row of the table of contacts.
  Answer answer(std::size_t row) const;

 private:
  std::map<std::string, std::size_t> columns_;
  std::vector<std::vector<double>> rows_;
};

}  // namespace hapticd::extremes
