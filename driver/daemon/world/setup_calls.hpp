// SPDX-License-Identifier: MIT
/// Shows an observer which call of a plugin a World waits for while it sets up a model, because a call may take
/// minutes.
#pragma once
#include <functional>

#include "description/scene.hpp"

namespace hapticd::servo {

/// @param model the model that is set up; nullptr if none is any more  @param call name of the function, such as
/// "activate", in static storage
using SetupObserver = std::function<void(const scene::Model* model, const char* call)>;

/// [main] From now on this observer hears of every call; nullptr ends that.
void observeSetup(SetupObserver observer);

/// [main] A plugin is about to be called, or has returned.
void noteSetup(const scene::Model* model, const char* call);

/// [main] Notes at the end of its life that no model is set up any more.
struct SetupScope {
  SetupScope() = default;
  ~SetupScope() { noteSetup(nullptr, ""); }
  SetupScope(const SetupScope&) = delete;
  SetupScope& operator=(const SetupScope&) = delete;
};

}  // namespace hapticd::servo
