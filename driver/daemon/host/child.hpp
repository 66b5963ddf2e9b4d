// SPDX-License-Identifier: MIT
/// Work that may crash or hang, done by a child process.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace hapticd::host {

/// [main] Runs `work` in a fork of this process, which must have one thread only, and returns its bytes. The error says
/// how the child ended ("crashed: Segmentation fault", "took longer than 5 s") and is meant to follow "it ".
Result<std::string> runInChild(const std::function<std::string()>& work, int limit_ms);

/// How far a child came; its parent can read it even if the child crashes. Make it before the child.
class Trail {
 public:
  Trail();
  ~Trail();
  Trail(const Trail&) = delete;
  Trail& operator=(const Trail&) = delete;

  /// [any] The child is at piece `item` of its work. @param call in static storage
  void mark(uint32_t item, const char* call) noexcept;
  uint32_t item() const noexcept;
  const char* call() const noexcept;  ///< "": nothing was marked, or there is no memory for it

 private:
  struct Mark;
  Mark* mark_;  ///< in memory that both share; nullptr if there is none
};

/// [any] Starts a program that ends with answerParent() and returns its bytes, with the same errors. It copies nothing
/// of this process. A fork would, and then each thread's next write to a page would cause a page fault.
/// @param arguments the program's path first
Result<std::string> runProgram(std::vector<std::string> arguments, int limit_ms);

/// [main] Called in such a program: sends what `work` returns to the parent, and ends the program.
[[noreturn]] void answerParent(const std::function<std::string()>& work);

}  // namespace hapticd::host
