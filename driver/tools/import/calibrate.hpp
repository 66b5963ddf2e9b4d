// SPDX-License-Identifier: MIT
/// `hapticd import --calibrate`: stiffness and shear of a soft body from measured or computed presses.
#pragma once
#include <string>

#include "base/result.hpp"
#include "host/catalog.hpp"

namespace hapticd::importing {

struct Calibration {
  std::string body;     ///< model file with points or vertices
  std::string answers;  ///< CSV x,y,z,depth,force: a place of the surface [m], how deep it was pressed [m], force [N]
  std::string dents;  ///< CSV x,y,z,x2,y2,z2,dent: share of a press's depth by which a second place goes down; "": none
  std::string out;    ///< the same body with a stiffness at each point (.yaml), hapticd-model/2: what it says is felt
};

/// [main] Fits the stiffness of each point so that the plugin gives the forces of all answers, writes the body and
/// prints how well it does. Presses should be small: the spring of a place is linear. With dents, fits the shear reach
/// of a grid to them as well.
Result<void> calibrate(const Calibration& options, host::Catalog& catalog);

}  // namespace hapticd::importing
