// SPDX-License-Identifier: MIT
/// A plugin whose static constructor throws.
#include <stdexcept>

#include "hapticd/shape.h"

namespace {
struct Thrower {
  Thrower() { throw std::runtime_error("in a constructor"); }
};
const Thrower thrower;
}  // namespace

extern "C" {
const hsp_entry hsp_plugin_entry = {HSP_MAGIC, HSP_ABI_MAJOR, HSP_ABI_MINOR, 0, nullptr};
}
