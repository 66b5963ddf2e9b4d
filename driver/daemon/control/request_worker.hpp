// SPDX-License-Identifier: MIT
/// The request worker: the thread that carries out requests. Another thread reads the sockets, so that lines are read
/// even while a request takes long or never ends.
#pragma once
#include <condition_variable>
#include <functional>
#include <list>
#include <mutex>
#include <string>
#include <vector>

#include "base/os.hpp"
#include "control/peer.hpp"

namespace hapticd::control {

/// A piece of work that the sockets' thread gives to the worker. JobResult is its result.
struct Job {
  enum class Kind { kAnswer, kNews, kLeft };
  Kind kind = Kind::kAnswer;
  Peer peer;
  std::string line;
  std::vector<Descriptor> files = {};  ///< descriptors that came with the line
};
struct JobResult {
  uint64_t peer = 0;
  bool answers = false;  ///< true for the answer to a request, false for news
  Reply reply;
  KeepAlive keep_alive;
};

class RequestWorker {
 public:
  ~RequestWorker() { stop(); }

  /// [main] Starts the worker's thread. @param work does a job, and returns false if the job has no result
  /// @param ring called after each job with a result. Both are called from the worker's thread
  std::error_code start(std::function<bool(Job&, JobResult&)> work, std::function<void()> ring);
  void stop();  ///< [main] ends the thread after the present job; jobs that have not begun are dropped

  void post(Job job);             ///< [any]
  std::vector<JobResult> take();  ///< [any] returns the results since the last call

 private:
  void run();

  std::function<bool(Job&, JobResult&)> work_;
  std::function<void()> ring_;
  std::mutex mutex_;
  std::condition_variable more_;
  std::list<Job> jobs_;
  std::vector<JobResult> done_;
  bool stop_ = false;
  os::Thread thread_;
};

}  // namespace hapticd::control
