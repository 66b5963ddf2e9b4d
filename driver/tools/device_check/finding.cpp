// SPDX-License-Identifier: MIT
#include "device_check/finding.hpp"

namespace hapticd::device_check {
namespace {

constexpr char kVerdicts[] = {'p', 'w', 'f', 's'};  ///< one letter for each Verdict

}  // namespace

std::string toBytes(const Finding& finding) {
  return std::string{kVerdicts[static_cast<int>(finding.verdict)], finding.ends ? '!' : '.'} + finding.what;
}

std::optional<Finding> findingFrom(const std::string& bytes) {
  const std::size_t which =
      bytes.size() < 2 ? std::string::npos : std::string(kVerdicts, sizeof kVerdicts).find(bytes[0]);
  if (which == std::string::npos) return std::nullopt;
  return Finding{static_cast<Verdict>(which), bytes.substr(2), bytes[1] == '!'};
}

}  // namespace hapticd::device_check
