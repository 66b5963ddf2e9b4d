// SPDX-License-Identifier: MIT
#include "kernels/spline/kernel.hpp"

namespace hapticd::spline {

#include "kernels/spline/kernel_common.inl"
#include "kernels/spline/kernel_net.inl"
#include "kernels/spline/kernel_table.inl"
// kernel_set.inl comes after the others, because it lists their functions.
#include "kernels/spline/kernel_set.inl"

const KernelSet& portableKernels() noexcept {
  return kKernels;
}

}  // namespace hapticd::spline
