/// What a soft body remembers beyond its parameters, as bytes: the nodes that are not at rest.
#pragma once
#include <span>
#include <vector>

#include "kernels/medial/nodes.hpp"

namespace hapticd {

/// [main] Nodes in motion and the bulge. The bytes serve on machines of the same byte order.
std::vector<unsigned char> stateOf(const medial::Nodes& nodes);
/// [main] Whether bytes are a state at all; of which body, only restoreState() can tell.
bool isState(std::span<const unsigned char> bytes);
/// [main] Puts the nodes where the state says. @returns false, and changes nothing, for the state of another body.
bool restoreState(std::span<const unsigned char> bytes, medial::Nodes& nodes);

}  // namespace hapticd
