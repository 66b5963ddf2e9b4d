// SPDX-License-Identifier: MIT
#include "scheduler.hpp"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "base/clock.hpp"
#include "errors.hpp"
#include "facts.hpp"
#include "pacer.hpp"
#include "units.hpp"

namespace hapticd::hd {

namespace {

constexpr size_t kMostTasks = 512;
constexpr int kPriority = 70;  ///< real-time priority, below that of the daemon's servo thread (80)

thread_local int ticks_of_this_thread = 0;  ///< number of callbacks in which this thread is nested

bool becomeRealTime() {
  const sched_param priority{kPriority};
  if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority) == 0) return true;
  hintOnce(
      "no real-time priority for the servo loop: forces may be felt one tick late\n"
      "  fix: join the group haptic (`hapticd doctor` says how)");
  return false;
}

/// Returns the time [us], before and after a tick is due, in which the scheduler polls for it instead of sleeping. It
/// is the value of $HAPTICD_LISTEN. Without this variable it is a tenth of the period, at most 100 us, if the
/// scheduler's thread has real-time priority, and 0 if not: polling would then only use up the time that the kernel
/// gives to the thread.
unsigned listeningTime(bool real_time, double rate) {
  constexpr double kMost = 100, kShare = 0.1, kUsPerSecond = 1e6;
  if (const char* text = std::getenv("HAPTICD_LISTEN"); text != nullptr && *text != '\0') {
    unsigned us = 0;
    const char* end = text + std::strlen(text);
    const auto [stopped, error] = std::from_chars(text, end, us);
    if (error == std::errc{} && stopped == end) return us;
    hintOnce("HAPTICD_LISTEN is ignored: it is not a number of microseconds from 0 to 200");
  }
  return real_time ? static_cast<unsigned>(std::min(kMost, kShare * kUsPerSecond / rate)) : 0;
}

/// Prints which rates are possible, because the error HD_INVALID_VALUE does not say it.
void reportRates(double wanted, double daemon) {
  constexpr int kShown = 6;
  char text[256];
  int at = std::snprintf(text, sizeof text,
                         "hdSetSchedulerRate(%.0f) is refused: callbacks run in the ticks of the daemon, of %.0f Hz\n"
                         "  fix: use one of the rates %.0f",
                         wanted, daemon, daemon);
  for (int every = 2; every <= kShown && at > 0 && static_cast<size_t>(at) < sizeof text; ++every)
    at += std::snprintf(text + at, sizeof text - static_cast<size_t>(at), ", %.0f", std::round(daemon / every));
  hintOnce(keptForever(std::string(text) +
                       ", ... (the daemon's rate divided by a whole number), or change servo.rate in the scene"));
}

}  // namespace

bool Scheduler::start() {
  const std::lock_guard guard(lock_);
  if (running_) return true;
  if (thread_.joinable()) thread_.detach();  // a callback of the thread itself called this, so the thread ends soon
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all,
                  &before);  // the library's thread gets no signals
  running_ = true;
  const uint64_t run = ++run_;
  try {
    thread_ = std::thread([this, run] { loop(run); });
  } catch (const std::exception&) {
    running_ = false;
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return running_;
}

void Scheduler::stop() {
  std::thread thread;
  {
    const std::lock_guard guard(lock_);
    running_ = false;
    thread.swap(thread_);
  }
  pacer_.listen(0);
  changed_.notify_all();
  if (!thread.joinable()) return;
  if (thread.get_id() == std::this_thread::get_id())
    thread.detach();
  else
    thread.join();
  changed_.notify_all();
}

void Scheduler::loop(uint64_t run) {
  real_time_ = becomeRealTime();
  pacer_.listen(listeningTime(real_time_, pacer_.rate()));
  Tasks batch;
  uint64_t count = 0;
  const auto goes_on = [&] { return running_ && run_ == run; };
  while (goes_on()) {
    const uint64_t ns = pacer_.wait();
    if (!goes_on()) break;
    const double wanted = wanted_rate_, daemon = pacer_.rate();
    const auto every = static_cast<uint64_t>(wanted > 0 ? std::max(1.0, std::round(daemon / wanted)) : 1);
    if (count++ % every == 0) {
      beginTick(ns);
      tick(batch);
    }
    pacer_.endTick();
  }
}

void Scheduler::beginTick(uint64_t ns) {
  const uint64_t before = began_ns_.exchange(ns);
  if (before != 0 && ns > before) instantaneous_ = kNsPerSecond / static_cast<double>(ns - before);
  ++tick_;
}

void Scheduler::tick(Tasks& batch) {
  {
    const std::lock_guard guard(lock_);
    batch = tasks_;
  }
  ++ticks_of_this_thread;
  for (const auto& task : batch) this->run(task);
  --ticks_of_this_thread;
  batch.clear();
}

void Scheduler::run(const std::shared_ptr<Task>& task) {
  {
    const std::lock_guard guard(lock_);
    if (task->gone) return;
    task->runs = true;
  }
  const HDCallbackCode code = task->function(task->data);
  const std::lock_guard guard(lock_);
  task->runs = false;
  if (code != HD_CALLBACK_CONTINUE) task->gone = true;
  if (task->gone) tasks_.erase(std::remove(tasks_.begin(), tasks_.end(), task), tasks_.end());
  changed_.notify_all();
}

/// Adds a callback. Callbacks run by priority, highest first. Callbacks of equal priority run in the order in which
/// they were added.
std::shared_ptr<Scheduler::Task> Scheduler::add(HDSchedulerCallback function, void* data, HDushort priority) {
  constexpr HDSchedulerHandle kLastHandle = 0x7fffffff;  // programs keep handles in 32 bits
  const std::lock_guard guard(lock_);
  if (tasks_.size() >= kMostTasks) return nullptr;
  auto task = std::make_shared<Task>(Task{next_handle_, function, data, priority});
  next_handle_ = next_handle_ < kLastHandle ? next_handle_ + 1 : 1;
  const auto place = std::find_if(tasks_.begin(), tasks_.end(), [&](const auto& t) { return t->priority < priority; });
  tasks_.insert(place, task);
  return task;
}

HDSchedulerHandle Scheduler::schedule(HDSchedulerCallback function, void* data, HDushort priority) {
  const auto task = add(function, data, priority);
  if (!task) return HD_INVALID_HANDLE;
  const HDSchedulerHandle handle = task->handle;
  if (tickOfCaller() != UINT64_MAX) run(task);
  return handle;
}

/// Runs a callback in ticks of the calling thread, because the scheduler does not run, or because the caller is a
/// callback itself.
void Scheduler::runHere(HDSchedulerCallback function, void* data) {
  const bool nested = ticks_of_this_thread > 0;
  HDCallbackCode code = HD_CALLBACK_CONTINUE;
  while (code == HD_CALLBACK_CONTINUE) {
    if (!nested) beginTick(pacer_.wait());
    ++ticks_of_this_thread;
    code = function(data);
    --ticks_of_this_thread;
    if (nested) break;  // inside a tick no other tick can begin
  }
}

bool Scheduler::runToEnd(HDSchedulerCallback function, void* data, HDushort priority) {
  if (tickOfCaller() != UINT64_MAX || !running_) return runHere(function, data), true;
  const auto task = add(function, data, priority);
  if (!task) return false;
  {
    std::unique_lock guard(lock_);
    changed_.wait(guard, [&] { return task->gone || (!running_ && !task->runs); });
    if (task->gone) return true;
    task->gone = true;
    tasks_.erase(std::remove(tasks_.begin(), tasks_.end(), task), tasks_.end());
  }
  runHere(function, data);  // the scheduler has been stopped meanwhile
  return true;
}

std::shared_ptr<Scheduler::Task> Scheduler::find(HDSchedulerHandle handle) const {
  const auto found =
      std::find_if(tasks_.begin(), tasks_.end(), [&](const auto& task) { return task->handle == handle; });
  return found != tasks_.end() && !(*found)->gone ? *found : nullptr;
}

bool Scheduler::unschedule(HDSchedulerHandle handle) {
  constexpr std::chrono::milliseconds kPatience(100);
  std::unique_lock guard(lock_);
  const auto task = find(handle);
  if (!task) return false;
  task->gone = true;
  tasks_.erase(std::remove(tasks_.begin(), tasks_.end(), task), tasks_.end());
  if (ticks_of_this_thread == 0) changed_.wait_for(guard, kPatience, [&] { return !task->runs; });
  changed_.notify_all();
  return true;
}

bool Scheduler::isScheduled(HDSchedulerHandle handle, bool wait) {
  std::unique_lock guard(lock_);
  auto task = find(handle);
  if (task && wait && ticks_of_this_thread == 0) changed_.wait(guard, [&] { return task->gone || !running_; });
  return find(handle) != nullptr;
}

bool Scheduler::setRate(double rate) {
  const double daemon = pacer_.rate(), every = std::round(daemon / rate);
  // Rates are whole numbers: 333 and 334 both mean every third tick of 1000.
  if (!(rate > 0) || rate > daemon || std::abs(daemon / every - rate) >= 1) return reportRates(rate, daemon), false;
  wanted_rate_ = rate;
  return true;
}

double Scheduler::rate() const {
  const double daemon = pacer_.rate(), wanted = wanted_rate_;
  return wanted > 0 ? daemon / std::max(1.0, std::round(daemon / wanted)) : daemon;
}

uint64_t Scheduler::tickOfCaller() const {
  return ticks_of_this_thread > 0 ? tick_.load() : UINT64_MAX;
}

double Scheduler::secondsInTick() const {
  const uint64_t began = began_ns_;
  return began != 0 ? static_cast<double>(monotonicNow() - began) / kNsPerSecond : 0;
}

}  // namespace hapticd::hd
