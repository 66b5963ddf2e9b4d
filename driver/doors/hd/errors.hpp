// SPDX-License-Identifier: MIT
/// The errors of the HDAPI: one stack for all devices and threads, and their texts.
#pragma once
#include <array>
#include <cstddef>
#include <mutex>

#include "HD/hdDefines.h"

namespace hapticd::hd {

/// [any] The newest error comes first; if there are more than 64, the oldest are dropped.
class ErrorStack {
 public:
  void push(HDerror code, HHD device, int internal = 0);
  HDErrorInfo pop();  ///< HD_SUCCESS: it is empty

 private:
  static constexpr size_t kDepth = 64;
  std::mutex lock_;
  std::array<HDErrorInfo, kDepth> errors_{};
  size_t next_ = 0, count_ = 0;
};

/// [any] Never NULL.
const char* errorText(HDerror code);

/// [any] Prints one line on stderr, once for each `text`, which must stay in memory: what is wrong and how to fix it.
void hintOnce(const char* text);
void hint(const char* what, const char* text);

}  // namespace hapticd::hd
