// SPDX-License-Identifier: MIT
/// Says where a parameter of a module belongs, if a device file has it at the top.
#pragma once
#include "description/class_info.hpp"
#include "document/node.hpp"
#include "document/reader.hpp"

namespace hapticd::scene::detail {

/// [main] Rewrites the problems about unknown keys at the top of a device file that are parameters of its module, such
/// as `verified` and `device: {verified: true}`: the text shows the key in its place, under `parameters`.
void placeParameters(const document::Node& root, const host::ClassInfo& info, document::Reader& in);

}  // namespace hapticd::scene::detail
