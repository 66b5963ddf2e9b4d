// SPDX-License-Identifier: MIT
/// Processes that read the status page of this one and are killed while they do.
#pragma once
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include "status/page_file.hpp"

namespace hapticd {

class DyingReaders {
 public:
  explicit DyingReaders(std::string page) : page_(std::move(page)), thread_([this] { run(); }) {}
  ~DyingReaders() { stop(); }
  DyingReaders(const DyingReaders&) = delete;
  DyingReaders& operator=(const DyingReaders&) = delete;

  /// How many had read and were killed.
  uint64_t stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    return killed_;
  }

 private:
  void run() {
    using std::chrono::microseconds;
    constexpr microseconds kBetween(20'000);  // they must not take the processor from what is tested
    for (uint64_t i = 0; !stop_; ++i) {
      int ready[2];
      if (pipe(ready) != 0) return;
      const pid_t reader = fork();
      if (reader == 0) read(ready[1]);
      close(ready[1]);
      char byte = 0;
      const bool has_read = ::read(ready[0], &byte, 1) == 1;
      std::this_thread::sleep_for(microseconds(i * 137 % 3000));
      int status = 0;
      if (reader > 0) kill(reader, SIGKILL), waitpid(reader, &status, 0);
      close(ready[0]);
      killed_ += has_read && WIFSIGNALED(status) ? 1 : 0;
      std::this_thread::sleep_for(kBetween);
    }
  }
  /// In the child: reads all that the page tells, again and again, until it is killed.
  [[noreturn]] void read(int ready) const {
    const auto file = status::PageFile::open(page_);
    if (!file) _exit(1);
    const status::Page& page = std::as_const(**file).page();
    for (bool told = false;;) {
      uint64_t sum = page.now.read().value_or(status::TickStatus{}).tick;
      for (uint32_t i = 0; i < page.arms; ++i) sum += page.arm[i].now.read().value_or(status::ArmStatus{}).sequence;
      for (uint32_t i = 0; i < page.models; ++i) sum += page.model[i].now.read().value_or(status::ModelStatus{}).tick;
      if (!told && sum > 0) told = write(ready, "r", 1) == 1;
    }
  }

  std::string page_;
  std::atomic<bool> stop_{false};
  uint64_t killed_ = 0;
  std::thread thread_;  // last: it uses the others
};

}  // namespace hapticd
