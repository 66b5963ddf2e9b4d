// SPDX-License-Identifier: MIT
/// Writes the results of `hapticd trace`: one CSV row per tick and model. Numbers have 17 digits, so that a reader gets
/// the same doubles.
#pragma once
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "description/scene.hpp"
#include "servo/core/core.hpp"

namespace hapticd::cli {

class TraceWriter {
 public:
  /// A file of this kind is recognised by these columns.
  static constexpr const char* kFirstColumns = "t,model,feature,u,v,";

  /// [main] Opens `file` ("-" is standard output) and writes the header. @param models indices of the models to print
  static Result<std::unique_ptr<TraceWriter>> open(const std::string& file, const scene::Scene& scene,
                                                   std::vector<uint32_t> models);
  ~TraceWriter();
  TraceWriter(const TraceWriter&) = delete;
  TraceWriter& operator=(const TraceWriter&) = delete;

  /// [main] Writes the rows of one tick.
  Result<void> write(double t, const servo::Core& core, bool probe_valid);

  /// [main] Writes what is still in memory, and returns an error if the disk is full.
  Result<void> close();

 private:
  TraceWriter(std::FILE* out, std::string file, const scene::Scene& scene, std::vector<uint32_t> models);
  void number(double value);
  void numbers(const double* values, int count);
  void whole(long value);

  std::FILE* out_;
  std::string file_;
  std::vector<uint32_t> models_;
  std::vector<std::string> names_;  // names of the models, as CSV fields
  std::string line_;
};

}  // namespace hapticd::cli
