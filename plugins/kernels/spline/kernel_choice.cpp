// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <cstring>

#include "kernels/spline/kernel.hpp"

namespace hapticd::spline {

const KernelSet& portableKernels() noexcept;  // kernel_portable.cpp

#ifdef HAPTICD_SPLINE_AVX2
const KernelSet& avx2Kernels() noexcept;  // kernel_avx2.cpp

const KernelSet& kernels(Instructions instructions) noexcept {
  // The host can choose portable code for the whole process, whose results are the same bit for bit on every machine.
  static const char* const wanted = std::getenv("HAPTICD_INSTRUCTIONS");
  static const bool may_avx2 = (wanted == nullptr || std::strcmp(wanted, "portable") != 0) &&
                               __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return instructions == Instructions::kFastest && may_avx2 ? avx2Kernels() : portableKernels();
}
#else
const KernelSet& kernels(Instructions) noexcept {
  return portableKernels();
}
#endif

}  // namespace hapticd::spline
