// SPDX-License-Identifier: MIT
/// Runs work that may crash or hang in a child process.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace hapticd::host {

class ChildProgress;

/// How a parent watches the pieces of a child's work. Time in which the child waits for a processor does not count.
struct ChildWatch {
  ChildProgress* progress = nullptr;  ///< must be given if another member is
  int piece_ms = 0;                   ///< [ms] most time of one piece; 0: only the whole work has a limit
  /// Called about once per second, with the time that the present piece has taken [s].
  std::function<void(double)> waits;
  /// The child ends as a program does, so that the destructors of the code that it loaded run, too. If they crash, the
  /// answer is valid all the same.
  bool whole_end = false;
};

/// [main] Runs `work` in a fork of this process and returns the bytes that `work` returns. This process must have only
/// one thread. The error says how the child ended, such as "crashed: Segmentation fault" or "took longer than 5 s", and
/// is worded so that it can follow the word "it" in a message. A child that takes too long gets SIGPROF, so that it can
/// note where it is, and is killed after a second. If this process is killed, the child ends, too.
Result<std::string> runInChild(const std::function<std::string()>& work, int limit_ms, const ChildWatch& watch = {});

/// Shows how far a child process has come with its work. The parent can read this even after a crash of the child. The
/// object must be made before the child is started.
class ChildProgress {
 public:
  ChildProgress();
  ~ChildProgress();
  ChildProgress(const ChildProgress&) = delete;
  ChildProgress& operator=(const ChildProgress&) = delete;

  /// [any] Notes that the child has reached piece `item` of its work. @param call name of a function, in static storage
  void mark(uint32_t item, const char* call) noexcept;
  uint32_t item() const noexcept;
  const char* call() const noexcept;  ///< "" if nothing was marked, or if there was no memory

  void beginPiece() noexcept;        ///< [any] a piece of the work begins, and the one before has ended
  void rest() noexcept;              ///< [any] what follows belongs to no piece
  uint64_t pieces() const noexcept;  ///< number of pieces so far; 0 while none is under way
  void answer() noexcept;            ///< [main] the answer is complete, and only destructors are left
  bool answered() const noexcept;

 private:
  struct Mark;
  Mark* mark_;  ///< in memory that parent and child share; nullptr if there was no memory
};

/// [any] Starts a program that calls answerParent(), and returns the bytes that it sends. Errors are those of
/// runInChild(). It does not copy the memory of this process, as a fork would: after a fork, each thread's next write
/// to a page causes a page fault. @param arguments the program's path, then its arguments
Result<std::string> runProgram(std::vector<std::string> arguments, int limit_ms);

/// [main] Called in a program started by runProgram(): sends what `work` returns to the parent, and ends the program.
[[noreturn]] void answerParent(const std::function<std::string()>& work);

}  // namespace hapticd::host
