// SPDX-License-Identifier: MIT
/// A whole run of the daemon: threads, real-time rights, the loop, and an orderly end. Used by `hapticd run`.
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
#include "session/messages/event_log.hpp"
#include "session/telemetry/telemetry.hpp"
#include "watch/guard_process.hpp"
#include "watch/watch_target.hpp"
#include "world/world.hpp"

namespace hapticd::sim {
class ProximityThread;
}

namespace hapticd::servo {

struct RunOptions {
  double rate = 1000;              ///< [Hz] rate of the servo
  std::optional<double> duration;  ///< [s] length of the run; without it, until stop()
  bool virtual_time = false;
  std::optional<int> cpu;  ///< processor for the servo thread
  int priority = os::kServoPriority;
  uint32_t spare_models = 0;  ///< places for models that are added during the run
  std::string status;         ///< file of the status page; "" for none
  std::string record;         ///< file of the recording of every tick; "" for none
  std::string black_box;      ///< file in memory for the black box; "": memory of the process
  std::string state_dir;      ///< folder for files after a crash; "": none are written
  bool allow_non_rt = false;  ///< true: a run with real hardware may begin without real-time rights
};

/// cycles with motors off, to measure whether ticks begin in time before a force is on
inline constexpr uint64_t kDryCycles = 2000;

class Runner {
 public:
  /// [main] Sets up the models. If it fails, the error is in files or parameters that the scene names.
  static Result<std::unique_ptr<World>> buildWorld(const scene::Scene& scene, const RunOptions& options,
                                                   const host::Services::Log& log);

  /// [main] Destroys models and arms. If a plugin or module crashes meanwhile, the message names it, and it goes on the
  /// quarantine list, as in a run.
  ~Runner();
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  /// [main] Opens the devices. It fails if the hardware fails, or if a virtual run names real hardware.
  static Result<std::unique_ptr<Runner>> prepare(const scene::Scene& scene, const RunOptions& options,
                                                 std::unique_ptr<World> world, const host::Services::Log& log);

  /// [main] Runs until the end. @param every is called from this thread about five times a second @param ended is
  /// called once the motors are off. If `ended` has not returned one second after a stop, the process is ended.
  Result<void> run(const std::function<void(const Runner&)>& every, const std::function<void()>& ended = [] {});

  /// [any] Asks the run to end. Forces ramp to zero first. Async-signal-safe.
  void stop() noexcept { loop_->stop(); }

  /// [any] Ramps the forces of these arms to zero now (see Loop::hold). Async-signal-safe.
  void hold(uint64_t arms) noexcept { loop_->hold(arms); }

  /// [any] For Ctrl-Z: ramps forces to zero, then stops the process until it is continued. After that, forces stay off
  /// until they are cleared. Async-signal-safe.
  void suspend() noexcept;

  World& world() { return *world_; }
  const World& world() const { return *world_; }
  /// [any] Gives an order to the servo. Only one thread may call this.
  bool postOrder(const Order& order) { return loop_->post(order); }
  Door& door() { return loop_->door(); }
  /// [main] Called after the run, before its socket closes: shows programs that the run ended in order.
  void noteEnd() { telemetry_->flight()->ring().noteEnd(); }
  /// [main] Called after the run: removes the file of the black box.
  void endBlackBox() { telemetry_->flight()->ring().removeFile(); }
  /// [any] Called from the thread of postOrder() when a model takes a place, or has left it (`name` is "").
  void nameModel(uint32_t place, const std::string& name, const std::string& plugin, const std::string& library);
  /// [any] Names of the models that events are about.
  const PlaceNames& names() const { return event_log_->names(); }
  /// [any] Called from the thread of postOrder() when a program is about to lead.
  void nameLeader(pid_t pid, const std::string& program) { event_log_->leads(pid, program); }
  /// [any] Called from the thread of postOrder() when a program begins to push on an arm.
  void namePusher(uint32_t arm, uint32_t place, pid_t pid, const std::string& program);
  /// [any] Called from the thread of postOrder() when a program has stopped pushing.
  void forgetPusher(uint32_t arm, uint32_t place, PusherLog::End how);
  /// [any] Called from the thread of postOrder(): adds the counts of a program that pushed to the report.
  void recordClient(const record::ClientReport& client) { telemetry_->pushed(client); }

  /// Folder for the quarantine list and for files after a crash; "" if there is none.
  const std::string& stateDir() const { return options_.state_dir; }
  bool virtualTime() const { return options_.virtual_time; }
  /// Memory that the loop shares with other programs until it has ended; nullptr before the first request. Only one
  /// thread may use it.
  struct Shared {
    std::unique_ptr<SealedMemory> state, bell;
  };
  Shared& shared() { return shared_; }
  const Telemetry& telemetry() const { return *telemetry_; }
  const Loop& loop() const { return *loop_; }
  Nanoseconds wallTime() const { return wall_time_; }       ///< [main] duration of the loop
  size_t residentBytes() const { return resident_bytes_; }  ///< [main] memory of the process at the end of the run
  const Arms& arms() const { return arms_; }
  const scene::Scene& scene() const { return scene_; }
  const record::Recorder* recorder() const { return recorder_.get(); }  ///< nullptr if there is no recording
  /// [main] After run(): an error if the recording could not be written. The run itself went on without it.
  const Result<void>& recorded() const { return recorded_; }

  /// Messages for the user about real-time rights that the run did not get.
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// [main] Returns the message for the fault of an arm, or "" if there is none.
  std::string faultOf(size_t arm) const;

  /// [main] After the run: returns messages for faults that ended by themselves.
  std::vector<std::string> recovered() const;

  /// [main] After the run: returns messages for faults that ended the run early or took a force away.
  std::vector<std::string> faults() const;

 private:
  Runner(const scene::Scene& scene, const RunOptions& options) : scene_(scene), options_(options) {}
  Result<void> openBlackBox(const LoopSettings& settings);
  Result<void> openArms(const host::Services::Log& log);
  void openClock(LoopSettings& settings);
  Result<void> runReal(watch::WatchTarget& watched, const std::function<void(const Runner&)>& every,
                       const std::function<void()>& ended);
  Result<void> startServo(os::Thread& servo, bool anyhow);
  void serve(bool runs);
  void lookAfter(sim::ProximityThread& proximity, bool anyhow, const std::function<void(const Runner&)>& every);
  void dropRecording();
  void stopArms();
  void stopArmsWatched(watch::WatchTarget& watched);
  void stopProcess();
  bool mayLag() const;
  bool needsGuard() const;
  void startGuard();
  void updateGuard();
  void keepGuard();
  void openEventLog();
  void lockMemory();
  std::vector<std::string> enterRealTime() const;  ///< [servo thread] @return messages for refused rights

  scene::Scene scene_;
  RunOptions options_;
  std::unique_ptr<World> world_;
  Arms arms_;
  std::unique_ptr<Telemetry> telemetry_;
  std::unique_ptr<EventLog> event_log_;
  Shared shared_;
  std::unique_ptr<Clock> clock_;
  std::unique_ptr<Loop> loop_;
  std::unique_ptr<record::Recorder> recorder_;
  Result<void> recorded_;
  /// nullptr if no arm needs a guard, or if no arm can be switched off by one
  std::unique_ptr<watch::GuardProcess> guard_;
  uint32_t guards_ended_ = 0;
  std::atomic<bool> suspend_{false};
  std::vector<std::string> warnings_;
  Nanoseconds wall_time_ = 0;
  size_t resident_bytes_ = 0;
};

}  // namespace hapticd::servo
