// SPDX-License-Identifier: MIT
#include "session/run/runner.hpp"

#include <algorithm>
#include <iterator>

#include "base/happens_within.hpp"
#include "base/os.hpp"
#include "log/log.hpp"
#include "session/messages/silence_reason.hpp"
#include "session/run/watched_servo.hpp"
#include "sim/proximity_thread.hpp"
#include "watch/crash.hpp"
#include "watch/end_watch.hpp"
#include "watch/idle_target.hpp"
#include "watch/notify.hpp"
#include "watch/watchdog.hpp"

namespace hapticd::servo {

namespace {

constexpr Nanoseconds kStatusPeriod = 200'000'000;
constexpr Nanoseconds kReadyPoll = 1'000'000;
constexpr uint64_t kReadyTicks = 2;  ///< after this many ticks the service manager is told that the daemon is ready
constexpr uint64_t kLongestRunUs = 100'000;  ///< longest CPU time without sleep [us]; a tick takes a hundredth of it

std::string readyMessage(const Loop& loop) {
  return "READY=1\nSTATUS=the servo ticks; before, " + std::to_string(loop.lateDryCycles()) + " of " +
         std::to_string(kDryCycles) + " dry cycles woke a period late";
}

std::string noFifo(int priority, const std::error_code& code, bool hardware) {
  return "cannot run the servo thread at FIFO " + std::to_string(priority) + ": " + code.message() + "\n  " +
         os::realTimeRights() + "\n  " +
         (hardware ? "without this priority the loop misses deadlines, and the hand feels it\n"
                   : "the run goes on at normal priority; expect late ticks when the machine is busy\n") +
         "  fix: sudo usermod -aG haptic $USER, log in again (limits: rtprio 80, memlock 524288)";
}

/// Returns the module whose code keeps the run from ending, or nullptr.
const Owner* keepsTheEnd() {
  for (const Worker worker : {Worker::kServo, Worker::kMain, Worker::kSearch, Worker::kControl})
    if (const Owner* owner = ownerOfWorker(worker)) return owner;
  return nullptr;
}

/// [main] Makes the watchdog of a run, which ends a hung process and names the module that hangs. @param may_lag true
/// if late ticks are normal on this machine
std::unique_ptr<watch::Watchdog> watchdogOf(watch::WatchTarget& watched, bool may_lag) {
  using watch::Watchdog;
  const auto hung = [&watched] { watch::endByFault("a step that did not return", watched.inServo()); };
  auto watchdog =
      std::make_unique<Watchdog>(watched, hung, may_lag ? Watchdog::kMissedInVirtualMachine : Watchdog::kMissedAfter,
                                 may_lag ? Watchdog::kStuckInVirtualMachine : Watchdog::kStuckAfter);
  watchdog->onLateEnd([] { watch::forceEnd(keepsTheEnd()); });
  return watchdog;
}

/// Ends the process if a call of a module after the last tick did not return. If no module is in a call, it returns,
/// and is called again later.
void dieOfStop() {
  if (const Owner* keeps = keepsTheEnd()) watch::endByFault("a stop() that did not return", keeps);
}

/// Runs the loop in virtual time. @param after called after the last tick; it calls modules, which may hang as well
Result<void> runInVirtualTime(Loop& loop, const watch::WatchTarget& watched, const std::function<void()>& after) {
  const auto hung = [] {
    if (const Owner* keeps = keepsTheEnd()) watch::endByFault("a step that did not return", keeps);
  };
  watch::EndWatch end(watched, [] { watch::forceEnd(keepsTheEnd()); }, hung);
  if (const auto code = end.start()) return Error{"cannot start the thread that watches the end: " + code.message()};
  loop.run();
  end.lastCalls(dieOfStop);
  after();
  return {};
}

}  // namespace

Runner::~Runner() {
  const WorkerScope working(Worker::kMain);
  watch::IdleTarget ended;
  const watch::CrashGuard crash(ended, options_.state_dir);
  recorder_.reset();
  loop_.reset();
  clock_.reset();
  event_log_.reset();
  telemetry_.reset();
  arms_.clear();
  world_.reset();
}

Result<void> Runner::run(const std::function<void(const Runner&)>& every, const std::function<void()>& ended) {
  if (needsGuard()) startGuard();
  const Nanoseconds now = clock_->now();
  for (const auto& arm : arms_)
    if (auto started = arm->start(now, scene_.servo.gravity); !started) {
      dropRecording();
      return started;
    }
  Result<void> done;
  if (const auto code = recorder_ ? recorder_->start() : std::error_code()) {
    dropRecording();
    return Error{"cannot start the recording thread: " + code.message()};
  }
  const WorkerScope working(Worker::kMain);
  WatchedServo watched(*loop_, arms_, *telemetry_);
  const watch::CrashGuard crash(watched, options_.state_dir);
  os::prepareSignalStack();  // this thread may run searches, and so code of plugins
  if (options_.virtual_time) {
    const Nanoseconds begun = monotonicNow();
    done = runInVirtualTime(*loop_, watched, [this, begun] {
      wall_time_ = monotonicNow() - begun;
      stopArms();
    });
    ended();
  } else {
    done = runReal(watched, every, ended);
    stopArms();  // again, if the first attempt failed
  }
  guard_.reset();
  resident_bytes_ = os::residentBytes();
  if (recorder_) recorded_ = recorder_->finish();
  return done;
}

/// Gives up the recording of a run that did not begin: it has no tick, and would look like that of a killed run.
void Runner::dropRecording() {
  if (recorder_) recorder_->discard();
  recorder_.reset();
}

void Runner::stopArms() {
  for (const auto& arm : arms_) arm->stop();
}

/// Runs until the loop has ended: keeps the service manager's watchdog quiet, writes messages of the servo, and keeps
/// the guard process up to date.
void Runner::lookAfter(sim::ProximityThread& proximity, bool anyhow, const std::function<void(const Runner&)>& every) {
  RealClock clock(0);
  watch::Feeder feeder;
  bool told = false;
  for (Nanoseconds status_due = 0; !loop_->finished();) {
    if (clock.now() >= status_due) {
      status_due = clock.now() + kStatusPeriod;
      if (!told && loop_->ticks() > kReadyTicks) told = watch::notify(readyMessage(*loop_)) || true;
      feeder.feed(clock.now(), loop_->ticks());
      if (!warnings_.empty() && !anyhow) break;
      host::Services::passOn(log::write);
      event_log_->logNewEvents(*telemetry_->flight());
      every(*this);
    }
    clock.waitUntil(clock.now() + proximity.turn(kStatusPeriod));
    if (guard_) keepGuard();
    if (suspend_) stopProcess();
  }
}

/// The function of the servo thread. @param runs false if the rights that the arms need are missing
void Runner::serve(bool runs) {
  const WorkerScope working(Worker::kServo);
  if (guard_ && runs) guard_->arm(true);
  if (runs) loop_->run();
  if (guard_ && loop_->silent()) guard_->arm(false);  // the last command was zero: no cut is needed
}

/// Starts the servo thread and waits until it has its rights, or knows that it gets none.
/// @param anyhow true if the loop runs without rights as well
Result<void> Runner::startServo(os::Thread& servo, bool anyhow) {
  std::atomic<bool> ready{false};
  std::vector<std::string> refused;  // written by the servo thread until `ready`, then read by this thread
  const bool locked = warnings_.empty();
  if (guard_) updateGuard();
  const auto code = servo.start("hapticd-servo", [this, &ready, &refused, anyhow, locked] {
    refused = enterRealTime();
    const bool runs = anyhow || (locked && refused.empty());
    ready = true;  // from here on `ready` and `refused` may be gone
    serve(runs);
  });
  if (code) return Error{"cannot start the servo thread: " + code.message() + "\n  " + os::realTimeRights()};
  RealClock clock(0);
  while (!ready) clock.waitUntil(clock.now() + kReadyPoll);
  std::move(refused.begin(), refused.end(), std::back_inserter(warnings_));
  return {};
}

/// Stops the arms after the last tick. Ends the process if the module of an arm does not return.
void Runner::stopArmsWatched(watch::WatchTarget& watched) {
  const auto idle = [] {};
  watch::EndWatch last(watched, idle, idle);
  last.lastCalls(dieOfStop);
  [[maybe_unused]] const auto unwatched = last.start();  // if it cannot start, the arms are stopped all the same
  stopArms();
}

Result<void> Runner::runReal(watch::WatchTarget& watched, const std::function<void(const Runner&)>& every,
                             const std::function<void()>& ended) {
  const Nanoseconds begun = monotonicNow();
  sim::ProximityThread proximity(world_->proximity(), [this] { return loop_->needsSearch(); });
  if (const auto code = proximity.start()) return Error{"cannot start the proximity thread: " + code.message()};
  lockMemory();
  const os::DmaLatencyHold awake;
  const auto watchdog = watchdogOf(watched, mayLag());
  if (const auto code = watchdog->start(options_.priority + 1))
    return Error{"cannot start the watchdog thread: " + code.message()};
  const bool anyhow = onlySimulated(arms_) || options_.allow_non_rt;
  os::Thread servo;
  if (auto started = startServo(servo, anyhow); !started) return started;
  lookAfter(proximity, anyhow, every);
  watch::notify("STOPPING=1");
  servo.join();
  // keepGuard() may have armed it again after the servo thread disarmed it, because it saw the run just before its end
  if (guard_ && loop_->silent()) guard_->arm(false);
  wall_time_ = monotonicNow() - begun;
  stopArmsWatched(watched);
  if (guard_) guard_->arm(false);
  proximity.stop();
  host::Services::passOn(log::write);
  event_log_->logNewEvents(*telemetry_->flight());
  ended();
  watchdog->stop();
  if (!loop_->finished())
    return Error{warnings_.back() +
                 "\n  forces stay off\n  note: --allow-non-rt allows forces without real-time rights"};
  return {};
}

/// True if late ticks are normal: without real-time rights, or on a virtual machine whose processors are paused one by
/// one.
bool Runner::mayLag() const {
  return options_.allow_non_rt || os::inVirtualMachine();
}

void Runner::suspend() noexcept {
  loop_->hold(UINT64_MAX);
  suspend_ = true;
}

/// Stops the process until it is continued. Called once forces are zero, and the last command has been sent.
void Runner::stopProcess() {
  constexpr Nanoseconds kMostPatience = 1'000'000'000, kLastCommand = 20'000'000;
  happensWithin(kMostPatience, kReadyPoll, [this] { return loop_->finished() || loop_->silent(); });
  RealClock(0).waitUntil(monotonicNow() + kLastCommand);
  suspend_ = false;
  if (guard_) guard_->arm(false);
  log::write(HSP_LOG_WARNING, "", "the process stops; forces are off");
  os::suspendProcess();
  log::write(HSP_LOG_WARNING, "", "the process goes on; forces stay off\n  fix: hapticd ctl clear");
}

void Runner::lockMemory() {
  os::calmAllocator();
  if (const auto code = os::lockMemory())
    warnings_.push_back("cannot lock memory: " + code.message() + "\n  " + os::realTimeRights() +
                        "\n  a page fault can delay a tick by milliseconds\n  fix: raise memlock to 524288 for the "
                        "group haptic in /etc/security/limits.d");
}

std::vector<std::string> Runner::enterRealTime() const {
  host::Services::markServoThread();
  os::prepareSignalStack();
  os::prefaultStack();
  std::vector<std::string> refused;
  if (options_.cpu)
    if (const auto code = os::pinTo(*options_.cpu))
      refused.push_back("cannot pin the servo thread to processor " + std::to_string(*options_.cpu) + ": " +
                        code.message() + "\n  it runs on any, beside other programs\n  fix: one of 0 to " +
                        std::to_string(os::processors() - 1) + " in servo.cpu of the daemon file, or by --cpu");
  if (const auto code = os::setFifo(options_.priority))
    refused.push_back(noFifo(options_.priority, code, !onlySimulated(arms_)));
  [[maybe_unused]] const auto limited = os::limitRealTimeRun(kLongestRunUs);  // fails only if it is lower already
  return refused;
}

void Runner::nameModel(uint32_t place, const std::string& name, const std::string& plugin, const std::string& library) {
  telemetry_->name(place, name, plugin, library);
  const Flight* flight = telemetry_->flight();
  if (!name.empty()) event_log_->names().came(place, flight != nullptr ? flight->ticks() : 0, {name, library});
  if (telemetry_->statusWriter() != nullptr) telemetry_->statusWriter()->name(place, name, plugin);
}

void Runner::namePusher(uint32_t arm, uint32_t place, pid_t pid, const std::string& program) {
  if (telemetry_->statusWriter() != nullptr)
    telemetry_->statusWriter()->pusher(arm, place, static_cast<uint64_t>(pid), program);
  event_log_->pushes(arm, place, pid, program);
}

void Runner::forgetPusher(uint32_t arm, uint32_t place, PusherLog::End how) {
  if (telemetry_->statusWriter() != nullptr) telemetry_->statusWriter()->pusher(arm, place, 0, "");
  event_log_->pushesNoMore(arm, place, how);
}

std::string Runner::faultOf(size_t arm) const {
  const Limiter& limiter = arms_[arm]->limiter();
  const Fault fault = limiter.fault();
  if (fault == Fault::kNone || fault == Fault::kStopped) return "";
  return faultMessage(scene_.devices[arm].name, fault, limiter.measured(), arms_[arm]->troubleOf(fault),
                      scene_.devices[arm].file.string());
}

std::vector<std::string> Runner::recovered() const {
  std::vector<std::string> texts;
  for (size_t i = 0; i < arms_.size(); ++i) {
    const Fault fault = arms_[i]->limiter().recovered();
    if (fault == Fault::kNone) continue;
    const std::string words = arms_[i]->trouble() != nullptr ? arms_[i]->trouble() : describe(fault);
    texts.push_back("device " + scene_.devices[i].name + ": " + words.substr(0, words.find("; ")) +
                    "; its forces ended and came back once the device worked again");
  }
  return texts;
}

std::vector<std::string> Runner::faults() const {
  std::vector<std::string> faults;
  for (size_t i = 0; i < arms_.size(); ++i)
    if (std::string text = faultOf(i); !text.empty()) faults.push_back(std::move(text));
  for (const ModelState& model : world_->core().models())
    if (std::string text = silenceReason(model); !text.empty()) faults.push_back(std::move(text));
  return faults;
}

}  // namespace hapticd::servo
