#include "kernels/spline/kernel.hpp"

namespace hapticd::spline {

#include "kernels/spline/kernel.inl"

const KernelSet& portableKernels() noexcept {
  return kKernels;
}

}  // namespace hapticd::spline
