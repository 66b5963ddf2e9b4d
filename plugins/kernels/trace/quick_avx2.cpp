// SPDX-License-Identifier: MIT
// Compiled with -mavx2 -mfma. quick_choice.cpp uses this code only if the processor supports both.
#include "kernels/trace/quick.hpp"

namespace hapticd::trace {

using spline::kOutStride;
using spline::Quad;

#include "kernels/spline/kernel_common.inl"
// quick.inl comes after kernel_common.inl, because it uses the functions there.
#include "kernels/trace/quick.inl"

const QuickKernels& avx2Quick() noexcept {
  return kQuickKernels;
}

}  // namespace hapticd::trace
