// SPDX-License-Identifier: MIT
/// `hapticd import --calibrate`: finds stiffness and shear of a soft body from measured or computed presses.
#pragma once
#include <string>

#include "base/result.hpp"
#include "host/catalog.hpp"

namespace hapticd::importing {

struct Calibration {
  std::string body;     ///< model file with points or vertices
  std::string answers;  ///< CSV x,y,z,depth,force: place on the surface [m], depth of the press [m], force [N]
  std::string dents;  ///< CSV x,y,z,x2,y2,z2,dent: how far a second place sinks, as a share of the depth of a press at
                      ///< the first; "" if there is no such file
  std::string out;    ///< file to write (.yaml, hapticd-model/2): the same body with a stiffness for each point
};

/// [main] Fits the stiffness of each point so that the plugin gives the forces of all answers. Writes the body and
/// prints how well it fits. Presses should be small, because the fitted springs are linear. With dents, also fits the
/// shear reach of a grid to them.
Result<void> calibrate(const Calibration& options, host::Catalog& catalog);

}  // namespace hapticd::importing
