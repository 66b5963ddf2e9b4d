// SPDX-License-Identifier: MIT
#include "control/request_worker.hpp"

#include <utility>

#include "base/code_owner.hpp"

namespace hapticd::control {

std::error_code RequestWorker::start(std::function<bool(Job&, JobResult&)> work, std::function<void()> ring) {
  work_ = std::move(work);
  ring_ = std::move(ring);
  return thread_.start("hapticd-desk", [this] { run(); });
}

void RequestWorker::stop() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  more_.notify_all();
  thread_.join();
}

void RequestWorker::post(Job job) {
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
  }
  more_.notify_one();
}

std::vector<JobResult> RequestWorker::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(done_, {});
}

void RequestWorker::run() {
  const WorkerScope working(Worker::kControl);
  std::unique_lock lock(mutex_);
  for (;;) {
    more_.wait(lock, [this] { return stop_ || !jobs_.empty(); });
    if (stop_) return;
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    JobResult done;
    const bool comes_back = work_(job, done);
    lock.lock();
    if (!comes_back) continue;
    done_.push_back(std::move(done));
    ring_();
  }
}

}  // namespace hapticd::control
