// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <cstring>

#include "kernels/trace/warm_step.hpp"

namespace hapticd::trace {

const WarmStepKernels& portableWarmStep() noexcept;  // warm_step_portable.cpp

#ifdef HAPTICD_TRACE_AVX2
const WarmStepKernels& avx2WarmStep() noexcept;  // warm_step_avx2.cpp

const WarmStepKernels& warmStepKernels(spline::Instructions instructions) noexcept {
  // The host can choose portable code for the whole process, whose results are the same bit for bit on every machine.
  static const char* const wanted = std::getenv("HAPTICD_INSTRUCTIONS");
  static const bool may_avx2 = (wanted == nullptr || std::strcmp(wanted, "portable") != 0) &&
                               __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return instructions == spline::Instructions::kFastest && may_avx2 ? avx2WarmStep() : portableWarmStep();
}
#else
const WarmStepKernels& warmStepKernels(spline::Instructions) noexcept {
  return portableWarmStep();
}
#endif

}  // namespace hapticd::trace
