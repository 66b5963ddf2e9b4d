// SPDX-License-Identifier: MIT
/// What a soft body remembers beyond its parameters, as bytes: the nodes that are not at rest.
#pragma once
#include <span>
#include <vector>

#include "kernels/medial/felt_surface.hpp"
#include "kernels/medial/nodes.hpp"

namespace hapticd {

/// [main] Nodes in motion, what of them has relaxed (if `surface` relaxes), and the bulge. The bytes serve on machines
/// of the same byte order.
std::vector<unsigned char> stateOf(const medial::Nodes& nodes, const medial::FeltSurface* surface);
/// [main] Whether bytes are a state at all; of which body, only restoreState() can tell.
bool isState(std::span<const unsigned char> bytes);
/// [main] Puts the nodes where the state says. @returns false, and changes nothing, for the state of another body.
bool restoreState(std::span<const unsigned char> bytes, medial::Nodes& nodes, medial::FeltSurface* surface);

}  // namespace hapticd
