// SPDX-License-Identifier: MIT
/// A whole run of the daemon: threads, real-time rights, the loop, and an orderly end. Called by `hapticd run`.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/os.hpp"
#include "base/result.hpp"
#include "base/sealed_memory.hpp"
#include "description/scene.hpp"
#include "record/recorder.hpp"
#include "servo/loop/loop.hpp"
#include "session/event_log.hpp"
#include "session/telemetry.hpp"
#include "watch/guard_process.hpp"
#include "watch/watched.hpp"
#include "world/world.hpp"

namespace hapticd::sim {
class ProximityThread;
}

namespace hapticd::servo {

struct RunOptions {
  double rate = 1000;              ///< [Hz]
  std::optional<double> duration;  ///< [s] none: until stopped
  bool virtual_time = false;
  std::optional<int> cpu;  ///< pins the servo thread
  int priority = os::kServoPriority;
  uint32_t spare_models = 0;  ///< places for models that are added during the run
  std::string status;         ///< file of the status page; empty: none
  std::string record;         ///< file that takes every tick; empty: none
  std::string black_box;      ///< file in memory with the last seconds; empty: memory of the process
  std::string state_dir;      ///< folder for what a crash leaves; empty: nothing is written
  bool allow_non_rt = false;  ///< runs real hardware even without real-time rights
};

class Runner {
 public:
  /// [main] Sets up the models. If it fails, the fault is in what the scene names: its files and parameters.
  static Result<std::unique_ptr<World>> buildWorld(const scene::Scene& scene, const RunOptions& options,
                                                   const host::Services::Log& log);

  /// [main] Takes models and arms down; if a module crashes in it, it is named and remembered as in a run.
  ~Runner();
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  /// [main] Opens the devices. If it fails, the fault is in the hardware, or a virtual run names some hardware.
  static Result<std::unique_ptr<Runner>> prepare(const scene::Scene& scene, const RunOptions& options,
                                                 std::unique_ptr<World> world, const host::Services::Log& log);

  /// [main] Runs to the end; `every` is called about five times a second from this thread, and `ended` once the motors
  /// are off. If anything delays `ended` for more than a second after a stop, the process ends.
  Result<void> run(const std::function<void(const Runner&)>& every, const std::function<void()>& ended = [] {});

  /// [any] Asks for an end: forces ramp to zero first. Async-signal-safe.
  void stop() noexcept { loop_->stop(); }

  /// [any] Ramps the forces of these arms to zero now (see Loop::hold). Async-signal-safe.
  void hold(uint64_t arms) noexcept { loop_->hold(arms); }

  /// [any] Ramps forces to zero, then stops the process until it is continued (Ctrl-Z). Forces stay off after it until
  /// they are cleared. Async-signal-safe.
  void suspend() noexcept;

  World& world() { return *world_; }
  const World& world() const { return *world_; }
  /// [any] Only one thread: an order for the servo.
  bool giveOrder(const Order& order) { return loop_->give(order); }
  Door& door() { return loop_->door(); }
  /// [main] After the run: nothing is left behind.
  void endBlackBox() { telemetry_->flight()->ring().removeFile(); }
  /// [any] The same thread: a model takes a place; "": it has left.
  void nameModel(uint32_t place, const std::string& name, const std::string& plugin);
  /// [any] The same thread: a program is about to lead.
  void nameLeader(pid_t pid, const std::string& program) { event_log_->leads(pid, program); }
  /// [any] The same thread: a program pushes on an arm.
  void namePusher(uint32_t arm, uint32_t place, pid_t pid, const std::string& program);
  /// [any] The same thread: it has stopped pushing.
  void forgetPusher(uint32_t arm, uint32_t place, PusherLog::End how);
  /// [any] The same thread: counts of a program that pushed, for the report.
  void book(const record::ClientReport& client) { telemetry_->pushed(client); }

  /// Folder for the quarantine and for what a crash leaves; "": none.
  const std::string& stateDir() const { return options_.state_dir; }
  bool virtualTime() const { return options_.virtual_time; }
  /// [any] One thread: memory that the loop shares with others until it has ended; nullptr until somebody asks.
  struct Shared {
    std::unique_ptr<SealedMemory> state, bell;
  };
  Shared& shared() { return shared_; }
  const Telemetry& telemetry() const { return *telemetry_; }
  const Loop& loop() const { return *loop_; }
  Nanoseconds wallTime() const { return wall_time_; }       ///< [main] how many the loop took
  size_t residentBytes() const { return resident_bytes_; }  ///< [main] time at the end of the loop
  const std::vector<std::unique_ptr<Arm>>& arms() const { return arms_; }
  const scene::Scene& scene() const { return scene_; }
  const record::Recorder* recorder() const { return recorder_.get(); }  ///< nullptr: nothing is recorded

  /// Real-time rights could not be had in full: four-part messages for the user.
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// [main] What took the force of an arm away, in words; "": nothing did.
  std::string faultOf(size_t arm) const;

  /// [main] After the run: what took a force away for a while, in words.
  std::vector<std::string> recovered() const;

  /// [main] After the run: what ended it early or took the force away, in words.
  std::vector<std::string> faults() const;

 private:
  Runner(const scene::Scene& scene, const RunOptions& options) : scene_(scene), options_(options) {}
  Result<void> openBlackBox(const LoopSettings& settings);
  Result<void> openArms(const host::Services::Log& log);
  Result<void> runReal(watch::Watched& watched, const std::function<void(const Runner&)>& every,
                       const std::function<void()>& ended);
  void serve(bool runs);
  void lookAfter(sim::ProximityThread& proximity, bool anyhow, const std::function<void(const Runner&)>& every);
  void stopArms();
  void stopProcess();
  bool mayLag() const;
  bool needsGuard() const;
  void startGuard();
  void tellGuard();
  void keepGuard();
  void openEventLog();
  void lockMemory();
  std::vector<std::string> enterRealTime() const;  ///< servo thread. @return what was refused
  bool onlySimulated() const;

  scene::Scene scene_;
  RunOptions options_;
  std::unique_ptr<World> world_;
  std::vector<std::unique_ptr<Arm>> arms_;
  std::unique_ptr<Telemetry> telemetry_;
  std::unique_ptr<EventLog> event_log_;
  Shared shared_;
  std::unique_ptr<Clock> clock_;
  std::unique_ptr<Loop> loop_;
  std::unique_ptr<record::Recorder> recorder_;
  std::unique_ptr<watch::GuardProcess> guard_;  ///< nullptr: no arm needs one, or none can be switched off from outside
  uint32_t guards_ended_ = 0;
  std::atomic<bool> suspend_{false};
  std::vector<std::string> warnings_;
  Nanoseconds wall_time_ = 0;
  size_t resident_bytes_ = 0;
};

}  // namespace hapticd::servo
