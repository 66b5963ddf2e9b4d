// SPDX-License-Identifier: MIT
#include "world/setup_calls.hpp"

#include <utility>

namespace hapticd::servo {

static SetupObserver& observerOfSetup() {
  static SetupObserver observer;
  return observer;
}

void observeSetup(SetupObserver observer) {
  observerOfSetup() = std::move(observer);
}

void noteSetup(const scene::Model* model, const char* call) {
  if (observerOfSetup()) observerOfSetup()(model, call);
}

}  // namespace hapticd::servo
