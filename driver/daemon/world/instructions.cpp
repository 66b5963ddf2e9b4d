// SPDX-License-Identifier: MIT
#include "world/instructions.hpp"

#include <cstdlib>

namespace hapticd::servo {

namespace {

// Name of the environment variable by which plugins/kernels get the choice, because they do not depend on the daemon.
constexpr const char* kVariable = "HAPTICD_INSTRUCTIONS";

bool portableByEnvironment() {
  const char* value = std::getenv(kVariable);
  return value != nullptr && std::string(value) == "portable";
}

bool hasAvx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

}  // namespace

void chooseInstructions(const scene::Servo& servo) {
  if (servo.instructions == scene::Instructions::kPortable) setenv(kVariable, "portable", 1);
}

std::string takenInstructions(const scene::Servo& servo) {
  const bool portable = servo.instructions == scene::Instructions::kPortable || portableByEnvironment();
  return !portable && hasAvx2() ? "avx2+fma" : "portable";
}

}  // namespace hapticd::servo
