// SPDX-License-Identifier: MIT
/// Who is to blame when the process is ended: each thread knows whose code it has called, and each library that was
/// loaded knows whose it is. Every call into a shape plugin or a device module is marked with a `Calling`.
#pragma once
#include <atomic>
#include <cstddef>
#include <string>

#include "hapticd/abi.h"

namespace hapticd {

/// A plugin or device module, and the model or device that is an instance of it.
struct Owner {
  std::string module;  ///< "nurbs_rigid"
  std::string name;    ///< "teapot"
  bool device = false;
};

/// [main] The owner of that name; it lives until the process ends, because threads of a plugin may do so too.
const Owner* ownerOf(const std::string& module, const std::string& name, bool device = false);

namespace detail {
inline thread_local std::atomic<const Owner*> t_called{nullptr};
}

/// Marks the calling thread as one that runs the owner's code while the object lives; such objects may nest.
class Calling {
 public:
  explicit Calling(const Owner* owner) noexcept HSP_RT : before_(detail::t_called.load(std::memory_order_relaxed)) {
    detail::t_called.store(owner, std::memory_order_relaxed);
  }
  ~Calling() HSP_RT { detail::t_called.store(before_, std::memory_order_relaxed); }
  Calling(const Calling&) = delete;
  Calling& operator=(const Calling&) = delete;

 private:
  const Owner* before_;
};

/// [any] Whose code the calling thread runs; nullptr: the daemon's own. Async-signal-safe.
inline const Owner* calledHere() noexcept {
  return detail::t_called.load(std::memory_order_relaxed);
}

/// The daemon's own threads that call plugins; others can ask what these threads are doing.
enum class Worker : int { kMain, kServo, kSearch, kControl };
constexpr int kWorkerCount = 4;

/// [any] The calling thread is that worker while the object lives.
class Working {
 public:
  explicit Working(Worker worker) noexcept;
  ~Working();
  Working(const Working&) = delete;
  Working& operator=(const Working&) = delete;

 private:
  Worker worker_;
};

/// [any] Whose code that worker runs now; nullptr: the daemon's own, or nobody is that worker. Async-signal-safe.
const Owner* calledBy(Worker worker) noexcept;
/// [any] The calling thread is one of the daemon's own. Async-signal-safe.
bool isWorker() noexcept;

/// [main] The code from `begin` up to `end` belongs to a library. Its owner is given later; the last one given counts.
void keepCode(const void* begin, const void* end);
/// [main] `address` lies in code that was kept; that code belongs to this owner.
void ownCode(const void* address, const Owner* owner);
/// [any] Whose code lies at this address; nullptr: no owner was given. Async-signal-safe.
const Owner* ownerOfCode(const void* address) noexcept;

/// [any] The owner of the code that a signal interrupted, or of code that called it: the first owner found at the
/// context's instruction and then on its stack. @param context as a handler with SA_SIGINFO gets it. Async-signal-safe.
const Owner* ownerInterrupted(const void* context) noexcept;
/// [any] The first owner of code whose address stands on the stack above `from`, so that it called what runs now.
/// Async-signal-safe.
const Owner* ownerOnStack(const void* from) noexcept;

}  // namespace hapticd
