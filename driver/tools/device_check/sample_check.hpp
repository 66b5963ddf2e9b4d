// SPDX-License-Identifier: MIT
/// Checks that the samples of a module keep the rules of the host.
#pragma once
#include <string>

#include "device_check/finding.hpp"
#include "device_check/reading.hpp"

namespace hapticd::device_check {

class SampleCheck {
 public:
  explicit SampleCheck(const hdv_info& info) : info_(info) {}
  /// Judges one sample. Returns what would be a fault in a run, or "".
  std::string look(const Reading& reading);
  /// Judges all samples together. Fails if a run would raise a fault, and warns of all other problems.
  Finding sum() const;

 private:
  std::string wrongNumbers(const hdv_sample& sample) const;
  const hdv_info& info_;
  uint64_t reads_ = 0, fresh_ = 0, last_ = 0, timeless_ = 0, ahead_ = 0, behind_ = 0, lost_ = 0;
  uint32_t flags_ = 0, buttons_ = 0;
  int beyond_ = -1;  ///< index of a joint that was far beyond its stops; -1 if none was
  double beyond_at_ = 0;
};

}  // namespace hapticd::device_check
