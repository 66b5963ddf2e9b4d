// SPDX-License-Identifier: MIT
/// The errors of the HDAPI: one stack for all devices and threads, and their texts.
#pragma once
#include <array>
#include <cstddef>
#include <mutex>

#include "HD/hdDefines.h"

namespace hapticd::hd {

/// [any] The stack of errors. The newest error is taken first. If there are more than 64 errors, the oldest are
/// dropped.
class ErrorStack {
 public:
  void push(HDerror code, HHD device, int internal = 0);
  HDErrorInfo pop();  ///< takes the newest error; its code is HD_SUCCESS if the stack is empty

 private:
  static constexpr size_t kDepth = 64;
  std::mutex lock_;
  std::array<HDErrorInfo, kDepth> errors_{};
  size_t next_ = 0, count_ = 0;
};

/// [any] Returns the text of an error code, never NULL.
const char* errorText(HDerror code);

/// [any] hintOnce() prints what is wrong and how to fix it on stderr, only once for each `text`, which must have static
/// storage. hint() prints each time.
void hintOnce(const char* text);
void hint(const char* what, const char* text);

}  // namespace hapticd::hd
