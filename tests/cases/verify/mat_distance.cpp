// SPDX-License-Identifier: MIT
#include "kernels/medial/primitives.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

void matDistance(const Case& c, Check& check) {
  const Json& in = c.input;
  const Eigen::Vector3d q = vector(in["Q"]);
  const double tolerance = number(c.tol["abs"]);
  const auto primitive = in["prim"].get<std::string>();
  if (primitive == "cone") {
    const medial::Cone cone({vector(in["c0"]), number(in["r0"])}, {vector(in["c1"]), number(in["r1"])});
    const medial::HullFoot foot = cone.foot(q);
    check.near("signed_distance", foot.distance, c.expect["signed_distance"], tolerance);
    if (c.expect.contains("t")) check.near("t", foot.parameter[0], c.expect["t"], tolerance * 1e2);
  } else if (primitive == "slab") {
    const medial::Slab slab({medial::Sphere{vector(in["c"][0]), number(in["r"][0])},
                             medial::Sphere{vector(in["c"][1]), number(in["r"][1])},
                             medial::Sphere{vector(in["c"][2]), number(in["r"][2])}});
    check.near("signed_distance", slab.foot(q).distance, c.expect["signed_distance"], tolerance);
  } else {
    check.fail("unknown primitive " + primitive);
  }
}

}  // namespace
HAPTICD_VERIFY(mat_distance, matDistance)
}  // namespace hapticd::verify
