// Compiled with -mavx2 -mfma; nothing here runs before kernel_choice.cpp has asked the processor.
#include "kernels/spline/kernel.hpp"

namespace hapticd::spline {

#include "kernels/spline/kernel.inl"

const KernelSet& avx2Kernels() noexcept {
  return kKernels;
}

}  // namespace hapticd::spline
