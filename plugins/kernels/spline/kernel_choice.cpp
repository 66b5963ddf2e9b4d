#include "kernels/spline/kernel.hpp"

namespace hapticd::spline {

#ifdef HAPTICD_SPLINE_AVX2
const KernelSet& avx2Kernels() noexcept;  // kernel_avx2.cpp

const KernelSet& fastestKernels() noexcept {
  static const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return has_avx2 ? avx2Kernels() : portableKernels();
}
#else
const KernelSet& fastestKernels() noexcept {
  return portableKernels();
}
#endif

}  // namespace hapticd::spline
