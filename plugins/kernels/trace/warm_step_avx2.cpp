// SPDX-License-Identifier: MIT
// Compiled with -mavx2 -mfma. warm_step_choice.cpp uses this code only if the processor supports both.
#include "kernels/trace/warm_step.hpp"

namespace hapticd::trace {

using spline::kOutStride;
using spline::Quad;

#include "kernels/spline/kernel_common.inl"
// warm_step.inl comes after kernel_common.inl, because it uses the functions there.
#include "kernels/trace/warm_step.inl"

const WarmStepKernels& avx2WarmStep() noexcept {
  return kWarmStepKernels;
}

}  // namespace hapticd::trace
