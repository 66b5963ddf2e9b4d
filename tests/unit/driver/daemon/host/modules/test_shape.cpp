// SPDX-License-Identifier: MIT
/// A shape with one parameter of every kind, for tests of the host and of scene files.
#include <stdexcept>

#include "hapticd/shape.hpp"

namespace {

constexpr const char* kSides[] = {"front", "back", "both"};
constexpr const char* kMotions[] = {"static", "kinematic", "dynamic"};

struct TestShape : hapticd::Shape {
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.shape",       "test_shape", "1.2.3", "MIT",
                                            "One parameter of every kind.", HSP_C_MOVES};
  double radius = 0, stiffness = 0, inner_mass = 0;
  int count = 0, sides = 0, motion = 0;
  bool flag = false;
  std::string geometry, label, extra;
  std::array<double, 3> axis{};
  std::vector<double> detent;

  static constexpr auto fields() {
    using F = hapticd::Fields<TestShape>;
    return std::array{
        F::real("radius", &TestShape::radius, "m", 0.001, 1, 0.05, "Radius.", HSP_P_REQUIRED),
        F::real("stiffness", &TestShape::stiffness, "N/m", 0, 20000, 500, "Wall stiffness.", HSP_P_LIVE | HSP_P_SAFETY),
        F::integer("count", &TestShape::count, "", 1, 10, 2, "A count."),
        F::boolean("flag", &TestShape::flag, false, "A flag."),
        F::choice("sides", &TestShape::sides, kSides, 0, "Which side is solid."),
        F::choice("motion", &TestShape::motion, kMotions, 0, "What moves it."),
        F::path("geometry", &TestShape::geometry, "A file."),
        F::text("label", &TestShape::label, "none", "A text."),
        F::data("extra", &TestShape::extra, "null", "Any structure."),
        F::vector3("axis", &TestShape::axis, "", -1, 1, "[0, 1, 0]", "A direction."),
        F::array("detent", &TestShape::detent, "", 2, 0, 8, -10, 10, "[]", "Travel and force."),
        F::real("inner.mass", &TestShape::inner_mass, "kg", 0.001, 10, 1, "A mass in a group."),
    };
  }
  void activate(const hsp_activation&, hsp_report& report) {
    if (label == "refuse") throw std::runtime_error("the label is \"refuse\", expected any other");
    report.max_stiffness = label == "nonsense" ? -1 : stiffness;
    report.size_m = 2 * radius;
  }
  /// With the label "hollow" it has every extension, and none of their functions.
  const void* extension(const char*) {
    static const std::array<uint64_t, 16> kHollow{sizeof kHollow};
    return label == "hollow" ? kHollow.data() : nullptr;
  }
  hsp_status touch(const hsp_probe& probe, const hsp_step&, hsp_contact& contact) noexcept HSP_RT {
    contact.force[0] = stiffness * probe.position[0];
    return HSP_OK;
  }
};

}  // namespace

HAPTICD_SHAPES(TestShape)
