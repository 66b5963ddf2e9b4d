// SPDX-License-Identifier: MIT
/// What the bench of the door prints.
#pragma once

namespace hapticd::bench {

void costs();    ///< nanoseconds a tick of leads, pushes, states and bells
void network();  ///< the force that a model led through a bad network puts on a hand

}  // namespace hapticd::bench
