// SPDX-License-Identifier: MIT
/// How stiff a layer of an elastic solid is under a flat round tip: from Young's modulus to N/m.
#pragma once

namespace hapticd::medial {

/// A layer that is bonded to something rigid.
struct ElasticLayer {
  double young = 0;      ///< [Pa]
  double poisson = 0;    ///< 0 to 0.5
  double thickness = 0;  ///< [m]
};

/// [main] Stiffness [N/m] of the layer under a flat, round, frictionless tip of radius `tip` [m], for small strain:
/// 2 E a kappa / (1 - nu^2). kappa is 1 for a thick layer and grows with tip over thickness (Lebedev & Ufliand 1958;
/// Hayes, Keer, Herrmann & Mockros 1972, J. Biomech. 5, 541). Right to 3e-4 for tips of up to 10 thicknesses.
double layerStiffness(const ElasticLayer& layer, double tip);

}  // namespace hapticd::medial
