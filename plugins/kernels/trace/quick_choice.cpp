// SPDX-License-Identifier: MIT
#include "kernels/trace/quick.hpp"

namespace hapticd::trace {

const QuickKernels& portableQuick() noexcept;  // quick_portable.cpp

#ifdef HAPTICD_TRACE_AVX2
const QuickKernels& avx2Quick() noexcept;  // quick_avx2.cpp

const QuickKernels& quickKernels(spline::Instructions instructions) noexcept {
  static const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return instructions == spline::Instructions::kFastest && has_avx2 ? avx2Quick() : portableQuick();
}
#else
const QuickKernels& quickKernels(spline::Instructions) noexcept {
  return portableQuick();
}
#endif

}  // namespace hapticd::trace
