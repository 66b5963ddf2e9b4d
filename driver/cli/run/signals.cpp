// SPDX-License-Identifier: MIT
#include "cli/run/signals.hpp"

#include <atomic>

#include "base/os.hpp"

namespace hapticd::cli {

namespace {

std::atomic<servo::Runner*> running{nullptr};  ///< the present run, for the signal handlers
std::atomic<bool> told_to_stop{false};

void stopRun(int) {
  told_to_stop = true;
  if (servo::Runner* runner = running.load()) runner->stop();
}

void suspendRun(int) {
  if (servo::Runner* runner = running.load()) runner->suspend();
}

}  // namespace

void heedStopSignals() {
  os::onStopSignal(stopRun);
}

void heedSuspendSignal() {
  os::onSuspendSignal(suspendRun);
}

StopBySignal::StopBySignal(servo::Runner& runner) {
  running = &runner;
  if (told_to_stop) runner.stop();
}

StopBySignal::~StopBySignal() {
  running = nullptr;
}

}  // namespace hapticd::cli
