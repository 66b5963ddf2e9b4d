// SPDX-License-Identifier: MIT
/// Results of `hapticd trace`: a CSV row a tick and model, numbers with 17 digits so that doubles survive the file.
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
  static constexpr const char* kFirstColumns = "t,model,feature,u,v,";  ///< by which such a file is known

  /// [main] Opens `file` ("-": standard output) and writes the header. @param models indices to print
  static Result<std::unique_ptr<TraceWriter>> open(const std::string& file, const scene::Scene& scene,
                                                   std::vector<uint32_t> models);
  ~TraceWriter();
  TraceWriter(const TraceWriter&) = delete;
  TraceWriter& operator=(const TraceWriter&) = delete;

  /// [main] The rows of one tick.
  Result<void> write(double t, const servo::Core& core, bool probe_valid);

  /// [main] Flushes; a full disk is an error, not a short file.
  Result<void> close();

 private:
  TraceWriter(std::FILE* out, std::string file, const scene::Scene& scene, std::vector<uint32_t> models);
  void number(double value);
  void numbers(const double* values, int count);
  void whole(long value);

  std::FILE* out_;
  std::string file_;
  std::vector<uint32_t> models_;
  std::vector<std::string> names_;  // as CSV fields
  std::string line_;
};

}  // namespace hapticd::cli
