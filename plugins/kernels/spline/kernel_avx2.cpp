// SPDX-License-Identifier: MIT
// Compiled with -mavx2 -mfma. kernel_choice.cpp uses this code only if the processor supports both.
#include "kernels/spline/kernel.hpp"

namespace hapticd::spline {

#include "kernels/spline/kernel_common.inl"
#include "kernels/spline/kernel_net.inl"
#include "kernels/spline/kernel_table.inl"
// kernel_set.inl comes after the others, because it lists their functions.
#include "kernels/spline/kernel_set.inl"

const KernelSet& avx2Kernels() noexcept {
  return kKernels;
}

}  // namespace hapticd::spline
