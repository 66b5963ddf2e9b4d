// SPDX-License-Identifier: MIT
/// The two parts of the door's bench. Each prints its results.
#pragma once

namespace hapticd::bench {

void costs();    ///< time per tick [ns] that leads, pushes, states and bells take
void network();  ///< steps of the force on a hand if the lead of a model comes through a bad network

}  // namespace hapticd::bench
