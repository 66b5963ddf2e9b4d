// SPDX-License-Identifier: MIT
/// Callbacks of the program, once a tick, in a thread of the library.
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

  bool start();  ///< false: no thread can be had
  void stop();   ///< waits for the end of the current tick, unless the caller is in it
  bool running() const { return running_; }

  /// @return its handle; HD_INVALID_HANDLE: there are too many
  HDSchedulerHandle schedule(HDSchedulerCallback function, void* data, HDushort priority);
  /// Returns when the callback is done. @return false: there are too many
  bool runToEnd(HDSchedulerCallback function, void* data, HDushort priority);
  bool unschedule(HDSchedulerHandle handle);  ///< false if it has ended, or never existed
  bool isScheduled(HDSchedulerHandle handle, bool wait);

  bool setRate(double rate);                    ///< [Hz] false if it is more than the daemon's rate, or not a rate
  double rate() const;                          ///< [Hz]
  bool realTime() const { return real_time_; }  ///< the servo loop has real-time priority
  double instantaneousRate() const { return instantaneous_; }

  /// Number of the tick in which the calling thread is; UINT64_MAX: it is in none.
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
  Tasks tasks_;  ///< in the order in which they run
  std::thread thread_;
  std::atomic<bool> running_{false};
  std::atomic<uint64_t> run_{0};  ///< number of the thread that may run the callbacks
  HDSchedulerHandle next_handle_ = 1;
  std::atomic<double> wanted_rate_{0}, instantaneous_{0};
  std::atomic<uint64_t> tick_{0}, began_ns_{0};
  std::atomic<bool> real_time_{true};  ///< until it is tried
};

}  // namespace hapticd::hd
