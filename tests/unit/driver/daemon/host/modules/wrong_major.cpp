// SPDX-License-Identifier: MIT
/// Built for an interface that does not exist yet.
#include "hapticd/shape.h"

extern "C" const hsp_entry hsp_plugin_entry = {HSP_MAGIC, HSP_ABI_MAJOR + 1, 0, 0, nullptr};
