// SPDX-License-Identifier: MIT
/// Calls the program's callbacks once per tick, in a thread of the library.
#pragma once
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "HD/hdDefines.h"

namespace hapticd::hd {

class Pacer;

class Scheduler {
 public:
  explicit Scheduler(Pacer& pacer) : pacer_(pacer) {}

  bool start();  ///< starts the thread; returns false if none can be started
  void stop();   ///< stops the thread; waits for the end of the current tick, unless a callback calls this function
  bool running() const { return running_; }

  /// Adds a callback. @return its handle, or HD_INVALID_HANDLE if there are too many callbacks
  HDSchedulerHandle schedule(HDSchedulerCallback function, void* data, HDushort priority);
  /// Adds a callback and returns when the callback has returned HD_CALLBACK_DONE. @return false if there are too many
  /// callbacks
  bool runToEnd(HDSchedulerCallback function, void* data, HDushort priority);
  bool unschedule(HDSchedulerHandle handle);  ///< removes a callback; returns false if it has ended or never existed
  /// Returns true while a callback has not ended. @param wait true: first waits until it has ended or the scheduler
  /// stops, unless a callback calls this function
  bool isScheduled(HDSchedulerHandle handle, bool wait);

  /// Sets the rate [Hz] of the callbacks. Returns false if it is not the daemon's rate divided by a whole number.
  bool setRate(double rate);
  double rate() const;                          ///< [Hz]
  bool realTime() const { return real_time_; }  ///< true if the thread has real-time priority
  double instantaneousRate() const { return instantaneous_; }

  /// Returns the number of the tick whose callbacks the calling thread runs, or UINT64_MAX if it runs none.
  uint64_t tickOfCaller() const;
  double secondsInTick() const;

 private:
  struct Task {
    HDSchedulerHandle handle;
    HDSchedulerCallback function;
    void* data;
    HDushort priority;
    bool gone = false, runs = false;
  };
  using Tasks = std::vector<std::shared_ptr<Task>>;

  std::shared_ptr<Task> add(HDSchedulerCallback function, void* data, HDushort priority);
  void loop(uint64_t run);
  void tick(Tasks& batch);
  void run(const std::shared_ptr<Task>& task);
  void runHere(HDSchedulerCallback function, void* data);
  std::shared_ptr<Task> find(HDSchedulerHandle handle) const;
  void beginTick(uint64_t ns);

  Pacer& pacer_;
  mutable std::mutex lock_;
  std::condition_variable changed_;
  Tasks tasks_;  ///< callbacks in the order in which they run
  std::thread thread_;
  std::atomic<bool> running_{false};
  std::atomic<uint64_t> run_{0};  ///< number of the present thread; a thread with an older number ends
  HDSchedulerHandle next_handle_ = 1;
  std::atomic<double> wanted_rate_{0}, instantaneous_{0};
  std::atomic<uint64_t> tick_{0}, began_ns_{0};
  /// true if the thread has real-time priority, and until the library has tried to get it
  std::atomic<bool> real_time_{true};
};

}  // namespace hapticd::hd
