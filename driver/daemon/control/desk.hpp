// SPDX-License-Identifier: MIT
/// Where requests are worked on: one thread beside that of the sockets, so that a request that takes long, or never
/// ends, keeps no other line from being read.
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

/// What the sockets' thread hands to the desk, and what comes back.
struct Job {
  enum class Kind { kAnswer, kNews, kLeft };
  Kind kind = Kind::kAnswer;
  Peer peer;
  std::string line;
  std::vector<Descriptor> files = {};  ///< that came with the line
};
struct Done {
  uint64_t peer = 0;
  bool answers = false;  ///< a request; otherwise news
  Reply reply;
  Standing standing;
};

class Desk {
 public:
  ~Desk() { stop(); }

  /// [main] @param work does a job; false: it has no answer @param ring called after each, from the desk's thread
  std::error_code start(std::function<bool(Job&, Done&)> work, std::function<void()> ring);
  void stop();  ///< [main] ends after the present job; the rest is dropped

  void give(Job job);        ///< [any]
  std::vector<Done> take();  ///< [any] what was done since the last call

 private:
  void run();

  std::function<bool(Job&, Done&)> work_;
  std::function<void()> ring_;
  std::mutex mutex_;
  std::condition_variable more_;
  std::list<Job> jobs_;
  std::vector<Done> done_;
  bool stop_ = false;
  os::Thread thread_;
};

}  // namespace hapticd::control
