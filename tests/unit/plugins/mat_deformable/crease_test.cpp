// SPDX-License-Identifier: MIT
/// Felt bodies with a valley, where the foot of a probe hops from one flank to the other.
#include <array>

#include "soft_plugin.hpp"

namespace hapticd::test {
namespace {

constexpr double kStiffness = 300;

/// A sheet 24 mm thick, bent along y over a short way, whose flanks rise by `rise` m a metre.
std::string grid(double rise) {
  std::string rows;
  for (const double y : {-.04, -.013, .013, .04}) {
    rows += rows.empty() ? "[" : ", [";
    for (int i = -6; i <= 6; ++i)
      rows += (i > -6 ? ", [" : "[") + std::to_string(.008 * i) + ", " + std::to_string(y) + ", " +
              std::to_string(rise * .008 * std::abs(i)) + "]";
    rows += "]";
  }
  return "format: hapticd-model/2\nmedial:\n  points: [" + rows +
         "]\n  radius: 0.012\n  stiffness: 300\n  damping: 0.5\n  mass: 0.005\n";
}

/// The same of four slabs.
std::string mesh(double rise) {
  const std::string z = std::to_string(rise * .048);
  return "6 0 4\nv 0 -.04 0 .012\nv 0 .04 0 .012\nv -.048 -.04 " + z + " .012\nv -.048 .04 " + z +
         " .012\nv .048 -.04 " + z + " .012\nv .048 .04 " + z + " .012\nf 0 1 2\nf 1 2 3\nf 0 1 4\nf 1 4 5\n";
}

/// A felt body of either kind with a valley.
class Valley : private TemporaryFile, public Plugin {
 public:
  Valley(bool of_slabs, double rise, double dynamics = 3)
      : TemporaryFile(of_slabs ? "valley.ma" : "valley.yaml", of_slabs ? mesh(rise) : grid(rise)), Plugin(path()) {
    set("dynamics", dynamics);
    set("stiffness", kStiffness);
    EXPECT_EQ(activate(), HSP_OK);
  }
};

/// The greatest change of the force in a tick across the valley, 50 um a tick, and the force in its middle.
std::array<double, 2> across(Plugin& body, double z) {
  body.search({-.01, 0, .05});
  for (int i = 0; i <= 1000; ++i) body.touch({-.01, 0, z + .04 - .04 * i / 1000});
  for (int i = 0; i < 1000; ++i) body.touch({-.01, 0, z});
  Vector3d before = forceOf(body.touch({-.01, 0, z}));
  double jump = 0, most = 0;
  for (int i = 0; i <= 400; ++i) {
    const Vector3d force = forceOf(body.touch({-.01 + 5e-5 * i, 0, z}));
    jump = std::max(jump, (force - before).norm());
    most = std::max(most, force.norm());
    before = force;
  }
  return {jump, most};
}

/// Before, the foot stayed on the flank that it came from, and where it was lost the force jumped by up to 38 N.
TEST(Crease, TheFootDoesNotHopWithAKick) {
  for (const bool slabs : {false, true}) {
    for (const double rise : {.5, 1.0, 1.7}) {
      for (const double z : {.012, .009, .006}) {
        Valley body(slabs, rise);
        const auto [jump, most] = across(body, z);
        EXPECT_GT(most, 1);
        EXPECT_LT(most, 6);
        EXPECT_LT(jump, .6 * most) << (slabs ? "slabs" : "grid") << " " << rise << " " << z;
      }
    }
  }
}

}  // namespace
}  // namespace hapticd::test
