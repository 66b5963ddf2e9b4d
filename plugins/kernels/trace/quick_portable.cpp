// SPDX-License-Identifier: MIT
#include "kernels/trace/quick.hpp"

namespace hapticd::trace {

using spline::kOutStride;
using spline::Quad;

#include "kernels/spline/kernel_common.inl"
// After what it uses.
#include "kernels/trace/quick.inl"

const QuickKernels& portableQuick() noexcept {
  return kQuickKernels;
}

}  // namespace hapticd::trace
