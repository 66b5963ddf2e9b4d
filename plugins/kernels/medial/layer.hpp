// SPDX-License-Identifier: MIT
/// The stiffness [N/m] of a layer of an elastic solid under a flat round tip, from Young's modulus.
#pragma once

namespace hapticd::medial {

/// A layer that is bonded to a rigid base.
struct ElasticLayer {
  double young = 0;      ///< [Pa] Young's modulus E
  double poisson = 0;    ///< Poisson's ratio nu, 0 to 0.5
  double thickness = 0;  ///< [m]
};

/// [main] Returns the stiffness [N/m] of the layer under a flat, round, frictionless tip of radius a = `tip` [m], for
/// small strain: 2 E a kappa / (1 - nu^2). kappa is 1 for a thick layer and grows with a / thickness (Lebedev & Ufliand
/// 1958; Hayes, Keer, Herrmann & Mockros 1972, J. Biomech. 5, 541). The relative error is at most 3e-4 for a radius of
/// up to 10 thicknesses.
double layerStiffness(const ElasticLayer& layer, double tip);

}  // namespace hapticd::medial
