// SPDX-License-Identifier: MIT
#include "cli/recording/replayed_forces.hpp"

#include <cerrno>
#include <cstring>

#include "base/regular_file.hpp"
#include "base/short_number.hpp"

namespace hapticd::cli {

Result<std::unique_ptr<ReplayedForces>> ReplayedForces::open(const std::string& file,
                                                             const record::RecordedStream& ticks) {
  std::FILE* out = std::fopen(file.c_str(), "w");
  if (out == nullptr) return Error{file + ": cannot be written: " + std::strerror(errno)};
  return std::unique_ptr<ReplayedForces>(new ReplayedForces(out, file, ticks));
}

ReplayedForces::ReplayedForces(std::FILE* out, std::string file, const record::RecordedStream& ticks)
    : out_(out), file_(std::move(file)), tick_(ticks.find("tick")), t_(ticks.find("t")) {
  compared_.push_back(ticks.find("depth"));
  for (int arm = 0; ticks.find("arm" + std::to_string(arm) + "_sent_fx") != nullptr; ++arm)
    for (const char* axis : {"x", "y", "z"})
      compared_.push_back(ticks.find("arm" + std::to_string(arm) + "_sent_f" + axis));
  std::string header = "tick,t";
  for (const record::Column* column : compared_)
    header += "," + column->name + "_recorded," + column->name + "_replayed";
  std::fprintf(out_, "%s\n", header.c_str());
}

ReplayedForces::~ReplayedForces() {
  if (out_ == nullptr) return;
  std::fclose(out_);
  removeIncomplete(file_);
}

void ReplayedForces::write(const std::byte* recorded, const std::byte* replayed) {
  constexpr int kDigits = 17;  // a reader gets the same doubles
  std::string line = withDigits(record::numberOf(recorded, *tick_), kDigits);
  line += "," + withDigits(record::numberOf(recorded, *t_), kDigits);
  for (const record::Column* column : compared_)
    for (const std::byte* row : {recorded, replayed}) line += "," + withDigits(record::numberOf(row, *column), kDigits);
  line += '\n';
  std::fwrite(line.data(), 1, line.size(), out_);  // close() looks for errors
}

Result<void> ReplayedForces::close() {
  std::FILE* out = out_;
  out_ = nullptr;
  const bool failed = std::ferror(out) != 0;
  if (std::fclose(out) == 0 && !failed) return {};
  const int code = failed ? EIO : errno;
  removeIncomplete(file_);
  return Error{file_ + ": cannot be written: " + std::strerror(code)};
}

}  // namespace hapticd::cli
