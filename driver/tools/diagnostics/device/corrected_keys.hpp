// SPDX-License-Identifier: MIT
/// The tree of a device file, with its blocks under the keys that are meant, so that checks find what stands below a
/// misspelt key. Values keep their places in the file.
#pragma once
#include "description/scene.hpp"
#include "document/node.hpp"

namespace hapticd::diagnostics {

/// [main] Gives `parameters` and the parameters themselves the keys as which the draft was read.
document::Node withCorrectedParameters(document::Node root, const scene::Device& draft);

/// [main] Moves the blocks of the wire format, too. @param root as withCorrectedParameters() returns it
document::Node withCorrectedWire(document::Node root, const scene::Device& draft);

}  // namespace hapticd::diagnostics
