// SPDX-License-Identifier: MIT
#include "control/desk.hpp"

#include <utility>

#include "base/blame.hpp"

namespace hapticd::control {

std::error_code Desk::start(std::function<bool(Job&, Done&)> work, std::function<void()> ring) {
  work_ = std::move(work);
  ring_ = std::move(ring);
  return thread_.start("hapticd-desk", [this] { run(); });
}

void Desk::stop() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  more_.notify_all();
  thread_.join();
}

void Desk::give(Job job) {
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
  }
  more_.notify_one();
}

std::vector<Done> Desk::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(done_, {});
}

void Desk::run() {
  const Working working(Worker::kControl);
  std::unique_lock lock(mutex_);
  for (;;) {
    more_.wait(lock, [this] { return stop_ || !jobs_.empty(); });
    if (stop_) return;
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    Done done;
    const bool comes_back = work_(job, done);
    lock.lock();
    if (!comes_back) continue;
    done_.push_back(std::move(done));
    ring_();
  }
}

}  // namespace hapticd::control
