// SPDX-License-Identifier: MIT
/// The state of a soft body as bytes: the nodes that are not at rest.
#pragma once
#include <span>
#include <vector>

#include "kernels/medial/felt_surface.hpp"
#include "kernels/medial/nodes.hpp"

namespace hapticd {

/// [main] Returns the state as bytes: the nodes in motion, the displacement to which each has relaxed (if `surface`
/// relaxes), and the bulge. Only machines of the same byte order can read these bytes.
std::vector<unsigned char> stateOf(const medial::Nodes& nodes, const medial::FeltSurface* surface);
/// [main] True if the bytes are the state of some soft body. restoreState() tells whether they fit this body.
bool isState(std::span<const unsigned char> bytes);
/// [main] Moves the nodes to the given state.
/// @return false, and changes nothing, if it is the state of another body
bool restoreState(std::span<const unsigned char> bytes, medial::Nodes& nodes, medial::FeltSurface* surface);

}  // namespace hapticd
