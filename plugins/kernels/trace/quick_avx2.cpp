// SPDX-License-Identifier: MIT
// Compiled with -mavx2 -mfma; nothing here runs before quick_choice.cpp has asked the processor.
#include "kernels/trace/quick.hpp"

namespace hapticd::trace {

using spline::kOutStride;
using spline::Quad;

#include "kernels/spline/kernel_common.inl"
// After what it uses.
#include "kernels/trace/quick.inl"

const QuickKernels& avx2Quick() noexcept {
  return kQuickKernels;
}

}  // namespace hapticd::trace
