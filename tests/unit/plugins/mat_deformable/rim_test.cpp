// SPDX-License-Identifier: MIT
/// Felt bodies whose foot comes to be held at the rim of the skeleton, or leaves it.

#include "soft_plugin.hpp"

namespace hapticd::test {
namespace {

/// A sheet of 6 cm by 8 cm, 2 cm thick, whose damping drags the dent behind a probe.
class Sheet : private TemporaryFile, public Plugin {
 public:
  Sheet() : TemporaryFile("sheet.yaml", text()), Plugin(path()) {
    set("dynamics", 3.0);
    set("damping", 1e5);  // what the file may ask for
    EXPECT_EQ(activate(), HSP_OK);
    search({0, 0, .03});
  }

 private:
  static std::string text() {
    std::string rows;
    for (int i = -4; i <= 4; ++i) {
      rows += i > -4 ? ", [" : "[";
      for (int j = -3; j <= 3; ++j)
        rows += (j > -3 ? ", [" : "[") + std::to_string(.01 * i) + ", " + std::to_string(.01 * j) + ", 0]";
      rows += "]";
    }
    return "format: hapticd-model/2\nmedial:\n  points: [" + rows +
           "]\n  radius: 0.01\n  stiffness: 200\n  damping: 5\n  mass: 0.01\n";
  }
};

/// A sheet of 6 cm by 8 cm made of slabs `side` m wide, whose radius grows by `taper` a metre along y.
class SlabSheet : private TemporaryFile, public Plugin {
 public:
  SlabSheet(double side, double taper) : TemporaryFile("sheet.ma", text(side, taper)), Plugin(path()) {
    set("dynamics", 3.0);
    set("stiffness", 200.0);
    set("damping", 5.0);
    EXPECT_EQ(activate(), HSP_OK);
    search({0, 0, .03});
  }

 private:
  static std::string text(double side, double taper) {
    const int m = static_cast<int>(std::round(.04 / side)), n = static_cast<int>(std::round(.03 / side));
    std::string vertices, slabs;
    for (int i = -m; i <= m; ++i)
      for (int j = -n; j <= n; ++j)
        vertices += "v " + std::to_string(side * i) + " " + std::to_string(side * j) + " 0 " +
                    std::to_string(.01 + taper * side * j) + "\n";
    const auto at = [n](int i, int j) { return " " + std::to_string(i * (2 * n + 1) + j); };
    for (int i = 0; i < 2 * m; ++i)
      for (int j = 0; j < 2 * n; ++j) {
        slabs += "f" + at(i, j) + at(i + 1, j) + at(i + 1, j + 1) + "\n";
        slabs += "f" + at(i, j) + at(i + 1, j + 1) + at(i, j + 1) + "\n";
      }
    return std::to_string((2 * m + 1) * (2 * n + 1)) + " 0 " + std::to_string(8 * m * n) + "\n" + vertices + slabs;
  }
};

struct Crossing {
  double step = 0;  ///< [N] the greatest change of the force along y in a tick
  double most = 0;  ///< [N] the greatest force
};

/// Down to `z`, then over the rim at y = 30 mm, 12.5 um a tick.
Crossing overTheRim(Plugin& body, double z) {
  const Vector3d start(.001, .026, z);
  for (int i = 0; i <= 200; ++i) body.touch(start + Vector3d(0, 0, (.0101 - z) * (1 - i / 200.0)));
  Vector3d before = forceOf(body.touch(start));
  Crossing found;
  for (int i = 0; i <= 800; ++i) {
    const Vector3d force = forceOf(body.touch(start + Vector3d(0, 1.25e-5 * i, 0)));
    found.step = std::max(found.step, std::fabs(force.y() - before.y()));
    found.most = std::max(found.most, force.norm());
    before = force;
  }
  return found;
}

/// The slope of the dent ended where the foot came to be held: 0.05 N of 0.8 and 0.11 N of 1.2 in a tick.
TEST(Rim, TheSlopeOfADentDoesNotEndAtOnce) {
  for (const double z : {.008, .006, .004}) {
    Sheet body;
    const Crossing found = overTheRim(body, z);
    EXPECT_GT(found.most, .3) << z;
    EXPECT_LT(found.step, .01 * found.most) << z << " m: " << found.step << " N";
  }
}

/// It was 0.4 N of 2.4 and 0.6 of 2.8.
TEST(Rim, AProbeThatWasPushedThroughTheSheetLeavesPastItWithoutAStep) {
  for (const double z : {-.002, -.004}) {
    Sheet body;
    const Crossing found = overTheRim(body, z);
    EXPECT_GT(found.most, 2) << z;
    EXPECT_LT(found.step, .02 * found.most) << z << " m: " << found.step << " N";
  }
}

/// It was up to 2 % of the force: slabs have a slope of their own, which ended with them.
TEST(Rim, TheSlopeOfADentDoesNotEndAtOnceOnSlabsEither) {
  for (const auto& [side, taper] : {std::pair{.01, 0.}, {.01, .1}, {.005, 0.}}) {
    for (const double z : {.008, .006, .004, -.002, -.004}) {
      SlabSheet body(side, taper);
      const Crossing found = overTheRim(body, z);
      EXPECT_GT(found.most, .3) << z;
      EXPECT_LT(found.step, .004 * found.most) << side << " " << taper << " " << z << " m: " << found.step << " N";
    }
  }
}

}  // namespace
}  // namespace hapticd::test
