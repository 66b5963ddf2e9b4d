// SPDX-License-Identifier: MIT
/// Finds out which plugin or module is to blame if the process crashes. Each thread keeps the owner of the plugin code
/// that it runs, and a table contains the owner of each loaded library. Every call of a shape plugin or a device module
/// is marked with an `OwnerScope`.
#pragma once
#include <atomic>
#include <cstddef>
#include <string>

#include "hapticd/abi.h"

namespace hapticd {

/// A plugin or device module, and the model or device that is an instance of it.
struct Owner {
  std::string module;  ///< such as "nurbs_rigid"
  std::string name;    ///< such as "teapot"
  bool device = false;
};

/// [main] Returns the owner with that module and name. It lives until the process ends, because threads that a plugin
/// started may live that long.
const Owner* ownerOf(const std::string& module, const std::string& name, bool device = false);

namespace detail {
inline thread_local std::atomic<const Owner*> t_called{nullptr};
}

/// Marks the calling thread as one that runs the owner's code, as long as the object lives. Such objects may nest.
class OwnerScope {
 public:
  explicit OwnerScope(const Owner* owner) noexcept HSP_RT : before_(detail::t_called.load(std::memory_order_relaxed)) {
    detail::t_called.store(owner, std::memory_order_relaxed);
  }
  ~OwnerScope() HSP_RT { detail::t_called.store(before_, std::memory_order_relaxed); }
  OwnerScope(const OwnerScope&) = delete;
  OwnerScope& operator=(const OwnerScope&) = delete;

 private:
  const Owner* before_;
};

/// [any] Returns the owner of the code that the calling thread runs; nullptr for the daemon's own code.
/// Async-signal-safe.
inline const Owner* currentOwner() noexcept {
  return detail::t_called.load(std::memory_order_relaxed);
}

/// The daemon's own threads that call plugins. Other threads can find out whose code they run.
enum class Worker : int { kMain, kServo, kSearch, kControl };
constexpr int kWorkerCount = 4;

/// [any] Registers the calling thread as that worker, as long as the object lives.
class WorkerScope {
 public:
  explicit WorkerScope(Worker worker) noexcept;
  ~WorkerScope();
  WorkerScope(const WorkerScope&) = delete;
  WorkerScope& operator=(const WorkerScope&) = delete;

 private:
  Worker worker_;
};

/// [any] Returns the owner of the code that this worker runs now; nullptr if it is the daemon's own code, or if no
/// thread is this worker. Async-signal-safe.
const Owner* ownerOfWorker(Worker worker) noexcept;
/// [any] Returns whether the calling thread is one of the workers above. Async-signal-safe.
bool isWorker() noexcept;

/// [main] Notes that the code from `begin` up to `end` belongs to one library. setCodeOwner() names its owner later; if
/// it is called more than once, the last owner counts.
void registerCode(const void* begin, const void* end);
/// [main] Sets the owner of the library that contains `address`. registerCode() must have noted this library.
void setCodeOwner(const void* address, const Owner* owner);
/// [any] Returns the owner of the code at this address; nullptr if no owner was given. Async-signal-safe.
const Owner* ownerOfCode(const void* address) noexcept;

/// [any] Returns the owner of the code that a signal interrupted, or of the code that had called it. It takes the first
/// owner found at the interrupted instruction and then up the stack. @param context the third argument of a handler
/// with SA_SIGINFO. Async-signal-safe.
const Owner* interruptedOwner(const void* context) noexcept;
/// [any] Returns the first owner whose code has a return address on the stack above `from`: that code called the
/// function that runs now. Async-signal-safe.
const Owner* ownerOnStack(const void* from) noexcept;

}  // namespace hapticd
