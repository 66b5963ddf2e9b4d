// SPDX-License-Identifier: MIT
/// A case as files that a user would write, and tables that the program wrote.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "extreme_case.hpp"

namespace hapticd::extremes {

/// A folder with model.json, scene.yaml and probe.csv of a case, which goes with the object.
class CaseFiles {
 public:
  /// @param device file of an arm in the same folder that the scene names; "": none  @throws std::exception
  explicit CaseFiles(const Case& c, const std::string& device = "");
  ~CaseFiles();
  CaseFiles(const CaseFiles&) = delete;
  CaseFiles& operator=(const CaseFiles&) = delete;
  std::filesystem::path operator/(const char* name) const { return path_ / name; }

  /// Runs a command of the shell in the folder. @throws std::exception with what it said where it fails
  void run(const std::string& command) const;

 private:
  std::filesystem::path path_;
};

/// A CSV file of numbers.
class Table {
 public:
  explicit Table(const std::filesystem::path& file);
  std::size_t rows() const { return rows_.size(); }
  /// Not-a-number where a cell holds none. @throws std::out_of_range: there is no such column
  double at(std::size_t row, const char* column) const { return rows_[row].at(columns_.at(column)); }
  /// The foot, its normal and the evaluations of a row of `hapticd trace` or of the table of contacts.
  Answer answer(std::size_t row) const;

 private:
  std::map<std::string, std::size_t> columns_;
  std::vector<std::vector<double>> rows_;
};

}  // namespace hapticd::extremes
