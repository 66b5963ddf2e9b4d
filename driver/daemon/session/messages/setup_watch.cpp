// SPDX-License-Identifier: MIT
#include "session/messages/setup_watch.hpp"

#include <chrono>
#include <cstdio>
#include <utility>

#include "hapticd/abi.h"
#include "world/setup_calls.hpp"

namespace hapticd::servo {

SetupWatch::SetupWatch(host::Services::Log log, double first_s, std::string advice)
    : log_(std::move(log)), first_s_(first_s), advice_(std::move(advice)) {
  // Without the thread the models are set up all the same, only silently.
  if (thread_.start("hapticd-setup", [this] { loop(); })) return;
  observeSetup([this](const scene::Model* model, const char* call) { enters(model, call); });
}

SetupWatch::~SetupWatch() {
  observeSetup(nullptr);
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void SetupWatch::enters(const scene::Model* model, const char* call) {
  {
    const std::lock_guard lock(mutex_);
    model_ = model != nullptr ? model->name : "";
    plugin_ = model != nullptr ? model->plugin : "";
    call_ = call;
    ++calls_;
  }
  changed_.notify_one();
}

void SetupWatch::loop() {
  std::unique_lock lock(mutex_);
  double seconds = first_s_, before = 0;
  for (uint64_t call = calls_; !ended_;) {
    const auto rest = std::chrono::duration<double>(seconds - before);
    if (changed_.wait_for(lock, rest, [&] { return ended_ || calls_ != call; })) {
      call = calls_;
      seconds = first_s_, before = 0;
      continue;
    }
    if (plugin_.empty()) continue;  // no plugin is called
    char text[80];
    std::snprintf(text, sizeof text, "has been in its %s() for %.0f s; ", call_, seconds);
    log_(HSP_LOG_WARNING, model_, "plugin '" + plugin_ + "' " + text + advice_);
    before = seconds;
    seconds *= 2;
  }
}

}  // namespace hapticd::servo
