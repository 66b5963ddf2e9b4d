// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <cstring>

#include "kernels/trace/quick.hpp"

namespace hapticd::trace {

const QuickKernels& portableQuick() noexcept;  // quick_portable.cpp

#ifdef HAPTICD_TRACE_AVX2
const QuickKernels& avx2Quick() noexcept;  // quick_avx2.cpp

const QuickKernels& quickKernels(spline::Instructions instructions) noexcept {
  // The host can choose portable code for the whole process, whose results are the same bit for bit on every machine.
  static const char* const wanted = std::getenv("HAPTICD_INSTRUCTIONS");
  static const bool may_avx2 = (wanted == nullptr || std::strcmp(wanted, "portable") != 0) &&
                               __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return instructions == spline::Instructions::kFastest && may_avx2 ? avx2Quick() : portableQuick();
}
#else
const QuickKernels& quickKernels(spline::Instructions) noexcept {
  return portableQuick();
}
#endif

}  // namespace hapticd::trace
