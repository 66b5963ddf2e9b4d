// SPDX-License-Identifier: MIT
#include "watch/crash.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "base/call_name.hpp"
#include "base/fatal_signals_posix.hpp"
#include "base/os.hpp"
#include "base/owner_file.hpp"
#include "watch/crash_steps.hpp"
#include "watch/culprit.hpp"
#include "watch/idle_target.hpp"
#include "watch/process_end.hpp"
#include "watch/signal_names.hpp"

namespace hapticd::watch {

namespace {

/// Everything that the signal handler needs, prepared before, because a handler cannot allocate memory.
struct Prepared {
  std::atomic<WatchTarget*> servo{nullptr};
  std::atomic<int> process{0};       ///< the watched process; in a fork of it the handler does nothing
  std::atomic<bool> leaving{false};  ///< the process ends normally, so a call of exit() is not a fault
  char dir[kLongestPath] = "";       // folder for the black box and the quarantine file; "": neither is written
};
Prepared prepared;

/// Returns the watched servo; nullptr if there is none, or if this process is a fork of the watched one.
WatchTarget* watchedHere() noexcept {
  return prepared.process.load() == getpid() ? prepared.servo.load() : nullptr;
}

/// Ends the process as if no handler were installed.
void dieBySystem(int signal) noexcept {
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void onFatal(int signal, siginfo_t* info, void* context) {
  WatchTarget* servo = watchedHere();
  const bool other = crashName(signal) == nullptr && sentByOther(*info);
  if ((servo == nullptr && prepared.servo.load() != nullptr) || (other && servo != nullptr && !servo->drives()))
    return dieBySystem(signal);
  if (servo != nullptr && other) {
    servo->stop();
    Line()
        .add("\nwarning: the run ends because of ")
        .add(signalName(signal).text())
        .add(", which another process sent\n")
        .write(STDERR_FILENO);
    return;
  }
  const Blame blame = blameFor(signal, *info, context);
  endInSteps(servo, prepared.dir, {signalName(signal).text(), blame.culprit, blame.suspicion});
}

/// Handles Ctrl-C, SIGTERM and similar signals. If this process sent the signal itself, a module did it and no person
/// wished it, so it counts as a fault.
void onStop(int signal, siginfo_t* info, void* context) {
  const bool own = info->si_code <= 0 && info->si_code != SI_TIMER && info->si_pid == getpid();
  if (own && watchedHere() != nullptr) endByFault(signalName(signal).text(), culpritOf(signal, *info, context));
  if (void (*former)(int) = os::formerStop(signal)) return former(signal);
  const Owner* keeps = watchedHere() != nullptr ? currentOwner() : nullptr;
  if (keeps != nullptr) {
    Line line;
    line.add("\nended as asked (SIG").add(sigabbrev_np(signal)).add("), while ");  // nobody is to blame
    addOwner(line, *keeps).add(" was");
    addCall(line, *keeps, callNameHere()).add("\n");
    line.write(STDERR_FILENO);
  }
  dieBySystem(signal);
}

/// Handles a plugin or library that called exit(). At this time static objects still exist, and other threads still
/// run.
void dieOfExit(const char* what) noexcept {
  if (prepared.leaving.load() || watchedHere() == nullptr) return;
  const Owner* culprit = currentOwner();
  if (culprit == nullptr && !isWorker()) culprit = ownerOnStack(__builtin_frame_address(0));
  endByFault(what, culprit);
}

void onExit() {
  dieOfExit("a call of exit()");
}

}  // namespace

void guardAgainstCrash(WatchTarget& servo, const std::filesystem::path& dir) {
  static const bool at_exit = std::atexit(&onExit) == 0 && std::at_quick_exit(&onExit) == 0;
  (void)at_exit;  // atexit() fails only if there is no memory; the next allocation reports that
  const std::string text = dir.string();
  prepared.dir[0] = '\0';
  if (text.size() < kLongestPath) std::memcpy(prepared.dir, text.c_str(), text.size() + 1);
  prepareBlame();
  prepared.process.store(getpid());
  prepared.servo.store(&servo);
  onPlainExit([] { dieOfExit("a call of _exit()"); });
  os::onFatalSignals(&onFatal);
  os::onStopSignals(&onStop);
}

void forgetCrash() {
  os::onStopSignals(nullptr);
  os::onFatalSignals(nullptr);
  onPlainExit(nullptr);
  prepared.servo.store(nullptr);
}

void guardTheEnd(const std::filesystem::path& dir) {
#ifndef HAPTICD_SANITIZED
  static IdleTarget& nothing = *new IdleTarget;  // the handlers outlive every static object
  prepared.leaving.store(true);
  guardAgainstCrash(nothing, dir);
  os::onStopSignals(nullptr);
  onPlainExit(nullptr);
#else
  (void)dir;
#endif
}

CrashGuard::CrashGuard(WatchTarget& servo, const std::filesystem::path& dir)
    : before_(prepared.servo.load()), dir_before_(prepared.dir) {
#ifndef HAPTICD_SANITIZED
  guardAgainstCrash(servo, dir);
#else
  (void)servo, (void)dir;
#endif
}

CrashGuard::~CrashGuard() {
#ifndef HAPTICD_SANITIZED
  forgetCrash();
  if (before_ != nullptr) guardAgainstCrash(*before_, dir_before_);
#endif
}

void forceEnd(const Owner* keeps) noexcept {
  WatchTarget* servo = prepared.servo.load();
  if (servo == nullptr) endProcess(1);
  cutAndAwait(*servo);
  Line line;
  line.add("\nwarning: the run was told to end, and ");
  if (keeps != nullptr)
    addOwner(line, *keeps).add(" did not return");
  else
    line.add("its last work took too long");
  line.add("\n  ").add(servo->drives() ? "the motors are off; " : "").add("the process ends without its report\n");
  line.write(STDERR_FILENO);
  endProcess(1);
}

void endByFault(const char* reason, const Owner* culprit) noexcept {
  endInSteps(prepared.servo.load(), prepared.dir, {reason, culprit, Suspicion::kNone});
}

}  // namespace hapticd::watch
