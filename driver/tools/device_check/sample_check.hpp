// SPDX-License-Identifier: MIT
/// What samples owe the host.
#pragma once
#include <string>

#include "device_check/finding.hpp"
#include "device_check/reading.hpp"

namespace hapticd::device_check {

class SampleCheck {
 public:
  explicit SampleCheck(const hdv_info& info) : info_(info) {}
  /// @return what is wrong with one sample; "" if nothing is
  std::string look(const Reading& reading);
  /// Of all of them: fails by what a run faults on, and warns of the rest.
  Finding sum() const;

 private:
  std::string wrongNumbers(const hdv_sample& sample) const;
  const hdv_info& info_;
  uint64_t reads_ = 0, fresh_ = 0, last_ = 0, timeless_ = 0, ahead_ = 0, lost_ = 0;
  uint32_t flags_ = 0, buttons_ = 0;
  int beyond_ = -1;  ///< joint that was far beyond its stops
  double beyond_at_ = 0;
};

}  // namespace hapticd::device_check
