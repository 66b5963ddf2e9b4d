// SPDX-License-Identifier: MIT
#include "kernels/trace/quick.hpp"

namespace hapticd::trace {

using spline::kOutStride;
using spline::Quad;

#include "kernels/spline/kernel_common.inl"
// quick.inl comes after kernel_common.inl, because it uses the functions there.
#include "kernels/trace/quick.inl"

const QuickKernels& portableQuick() noexcept {
  return kQuickKernels;
}

}  // namespace hapticd::trace
