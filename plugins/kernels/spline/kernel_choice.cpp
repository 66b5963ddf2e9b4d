// SPDX-License-Identifier: MIT
#include "kernels/spline/kernel.hpp"

namespace hapticd::spline {

const KernelSet& portableKernels() noexcept;  // kernel_portable.cpp

#ifdef HAPTICD_SPLINE_AVX2
const KernelSet& avx2Kernels() noexcept;  // kernel_avx2.cpp

const KernelSet& kernels(Instructions instructions) noexcept {
  static const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return instructions == Instructions::kFastest && has_avx2 ? avx2Kernels() : portableKernels();
}
#else
const KernelSet& kernels(Instructions) noexcept {
  return portableKernels();
}
#endif

}  // namespace hapticd::spline
