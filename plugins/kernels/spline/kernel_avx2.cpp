// SPDX-License-Identifier: MIT
// Compiled with -mavx2 -mfma; nothing here runs before kernel_choice.cpp has asked the processor.
#include "kernels/spline/kernel.hpp"

namespace hapticd::spline {

#include "kernels/spline/kernel_common.inl"
#include "kernels/spline/kernel_net.inl"
#include "kernels/spline/kernel_table.inl"
// After what it collects.
#include "kernels/spline/kernel_set.inl"

const KernelSet& avx2Kernels() noexcept {
  return kKernels;
}

}  // namespace hapticd::spline
