// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "hapticd/shape.h"

namespace {

/// The plugin through its C ABI alone, as the host uses it.
class Plugin {
 public:
  Plugin() : shape_(kind().create(&kind(), nullptr)) {}
  ~Plugin() { kind().destroy(shape_); }

  hsp_status set(const char* id, double number) { return put(id, {0, 0, number, nullptr, nullptr}); }
  /// As a running daemon does: for the next step.
  void change(const char* id, double number) {
    for (uint32_t i = 0; i < kind().param_count; ++i)
      if (std::strcmp(kind().params[i].id, id) == 0) changes_.push_back({i, 0, number});
  }
  hsp_status set(const char* id, const std::string& text) { return put(id, {0, 0, 0, text.c_str(), nullptr}); }
  hsp_status activate() {
    hsp_activation activation{};
    activation.struct_size = sizeof activation;
    activation.max_probes = 1;
    report.struct_size = sizeof report;
    return kind().activate(shape_, &activation, &report);
  }
  const hsp_ext_surfaces& surfaces() {
    return *static_cast<const hsp_ext_surfaces*>(kind().extension(shape_, HSP_EXT_SURFACES));
  }
  const hsp_ext_geometry& geometry() {
    return *static_cast<const hsp_ext_geometry*>(kind().extension(shape_, HSP_EXT_GEOMETRY));
  }
  hsp_shape* handle() { return shape_; }

  hsp_contact at(double x, double y, double z, double vx = 0, uint32_t flags = 0) {
    const double p[3] = {x, y, z};
    hsp_near near[64];
    const hsp_ext_surfaces& s = surfaces();
    const int64_t count = s.nearby(shape_, p, 0.15, near, 64);
    for (int64_t i = 0; i < count && i < 64; ++i) s.activate(shape_, &near[i]);
    return step(p, vx, flags);
  }

  /// Without a search.
  hsp_contact step(const double (&p)[3], double vx, uint32_t flags) {
    hsp_probe probe{};
    std::memcpy(probe.position, p, sizeof p);
    probe.velocity[0] = vx;
    probe.flags = flags;
    hsp_contact contact{};
    hsp_step step{};
    step.struct_size = sizeof step;
    step.count = 1;
    step.in = &probe;
    step.out = &contact;
    step.in_stride = sizeof probe;
    step.out_stride = sizeof contact;
    step.dt_s = 1e-3;
    step.changes = changes_.data();
    step.change_count = static_cast<uint32_t>(changes_.size());
    status = kind().step(shape_, &step);
    changes_.clear();
    return contact;
  }

  hsp_status status = HSP_OK;
  hsp_report report{};

 private:
  static const hsp_class& kind() { return *hsp_plugin_entry.classes[0]; }
  hsp_status put(const char* id, hsp_value value) {
    for (uint32_t i = 0; i < kind().param_count; ++i)
      if (std::strcmp(kind().params[i].id, id) == 0) {
        value.kind = kind().params[i].kind;
        return kind().set(shape_, i, &value);
      }
    return HSP_E_ARG;
  }
  hsp_shape* shape_;
  std::vector<hsp_change> changes_;
};

const std::string kModels = HAPTICD_SOURCE_DIR "/config/models/";

TEST(NurbsRigid, PushesOutAlongTheNormalWithItsStiffness) {
  Plugin plugin;
  ASSERT_EQ(plugin.set("geometry", kModels + "sphere.yaml"), HSP_OK);
  ASSERT_EQ(plugin.set("stiffness", 1000), HSP_OK);
  ASSERT_EQ(plugin.activate(), HSP_OK);
  EXPECT_EQ(plugin.report.flags & HSP_R_VELOCITY, 0u);  // nobody reads it
  const hsp_contact inside = plugin.at(0.048, 0, 0);
  EXPECT_NEAR(inside.depth_m, 0.002, 1e-9);
  EXPECT_NEAR(inside.force[0], 2, 1e-6);
  EXPECT_NEAR(inside.force[1], 0, 1e-6);
  EXPECT_TRUE(inside.flags & HSP_OUT_CONTACT);
  const hsp_contact outside = plugin.at(0.055, 0, 0);
  EXPECT_NEAR(outside.depth_m, -0.005, 1e-9);
  EXPECT_EQ(outside.force[0], 0);
  EXPECT_FALSE(outside.flags & HSP_OUT_CONTACT);
  EXPECT_TRUE(outside.flags & HSP_OUT_TRACED);
}

TEST(NurbsRigid, DampingAsksForVelocityAndFrictionAloneDoesNot) {
  for (const auto& [id, asks] : {std::pair{"damping", true}, {"viscosity", true}, {"friction_static", false}}) {
    Plugin plugin;
    plugin.set("geometry", kModels + "box.yaml");
    ASSERT_EQ(plugin.set(id, 0.5), HSP_OK);
    ASSERT_EQ(plugin.activate(), HSP_OK);
    EXPECT_EQ((plugin.report.flags & HSP_R_VELOCITY) != 0, asks) << id;
  }
}

TEST(NurbsRigid, DampingHoldsBackAProbeThatClosesInAndLetsOneGoThatLeaves) {
  Plugin plugin;
  plugin.set("geometry", kModels + "sphere.yaml");
  plugin.set("stiffness", 1000);
  plugin.set("depth_scale", 1e-3);
  plugin.set("damping", 5);
  ASSERT_EQ(plugin.activate(), HSP_OK);
  EXPECT_NEAR(plugin.at(0.048, 0, 0).force[0], 2, 1e-6);
  EXPECT_NEAR(plugin.at(0.048, 0, 0, -0.1).force[0], 2 + 2 * 5 * 0.1, 1e-6) << "closing in, at twice the scale";
  EXPECT_NEAR(plugin.at(0.048, 0, 0, 0.1).force[0], 2 - 2 * 5 * 0.1, 1e-6) << "leaving";
  EXPECT_EQ(plugin.at(0.048, 0, 0, 10).force[0], 0) << "it never pulls";
}

TEST(NurbsRigid, FrictionDoesNotPullAProbeBackToWhereItWasBeforeAJump) {
  Plugin plugin;
  plugin.set("geometry", kModels + "box.yaml");
  plugin.set("friction_static", 0.5);
  plugin.set("friction_dynamic", 0.5);
  ASSERT_EQ(plugin.activate(), HSP_OK);
  for (int i = 0; i < 10; ++i) plugin.at(0, 0.049, 0);
  EXPECT_LT(plugin.at(1e-4, 0.049, 0).force[0], -0.05) << "it sticks";
  const hsp_contact after = plugin.at(0.02, 0.049, 0, 0, HSP_IN_JUMP);
  EXPECT_NEAR(after.force[1], 0.8, 1e-6);
  EXPECT_NEAR(after.force[0], 0, 1e-9);
}

TEST(NurbsRigid, FrictionHoldsBackAProbeThatSlides) {
  Plugin plugin;
  plugin.set("geometry", kModels + "box.yaml");
  plugin.set("friction_static", 0.5);
  plugin.set("friction_dynamic", 0.3);
  ASSERT_EQ(plugin.activate(), HSP_OK);
  hsp_contact contact{};
  for (int i = 0; i <= 100; ++i) contact = plugin.at(1e-4 * i, 0.049, 0);
  EXPECT_NEAR(contact.force[1], 0.8, 1e-6);
  EXPECT_NEAR(contact.force[0], -0.3 * 0.8, 0.02);
}

TEST(NurbsRigid, SlidingFrictionAboveStickingFrictionIsRefused) {
  Plugin plugin;
  plugin.set("geometry", kModels + "box.yaml");
  plugin.set("friction_static", 0.2);
  plugin.set("friction_dynamic", 0.4);
  EXPECT_LT(plugin.activate(), 0);
  plugin.set("friction_dynamic", 0.2);
  EXPECT_EQ(plugin.activate(), HSP_OK);
}

TEST(NurbsRigid, TextureRunsAlongTheParametersAndVanishesOnSidesAndSeams) {
  Plugin plugin;
  plugin.set("geometry", kModels + "torus.yaml");
  plugin.set("stiffness", 1000);
  plugin.set("texture.amplitude", 1e-4);
  plugin.set("texture.wavelength", 5e-3);
  ASSERT_EQ(plugin.activate(), HSP_OK);
  double lowest = 1, highest = -1, last = 0;
  constexpr int kSteps = 20000;
  for (int i = 0; i <= kSteps; ++i) {  // 1 mm deep, twice round over both seams
    const double a = 4 * M_PI * i / kSteps, b = 3 * a, r = 0.05 + 0.019 * std::cos(b);
    const hsp_contact contact = plugin.at(r * std::sin(a), 0.019 * std::sin(b), r * std::cos(a));
    const double bump = std::hypot(contact.force[0], contact.force[1], contact.force[2]) / 1000 - 0.001;
    if (i > 0) {
      EXPECT_NEAR(bump, last, 2e-5);
    }
    last = bump;
    lowest = std::min(lowest, bump);
    highest = std::max(highest, bump);
  }
  EXPECT_NEAR(highest, 1e-4, 2e-6);
  EXPECT_NEAR(lowest, -1e-4, 2e-6);
  EXPECT_NEAR(plugin.at(0, 0, 0.069).force[2], 1, 1e-9);  // where both seams meet
}

TEST(NurbsRigid, BumpsSteeperThanAHostBearsAreRefusedOrFlattened) {
  Plugin plugin;
  plugin.set("geometry", kModels + "torus.yaml");
  plugin.set("stiffness", 1000);
  plugin.set("texture.wavelength", 5e-3);
  plugin.set("texture.amplitude", 5e-3);
  EXPECT_EQ(plugin.activate(), HSP_E_ARG);
  plugin.set("texture.amplitude", 1e-3);
  ASSERT_EQ(plugin.activate(), HSP_OK);
  EXPECT_NEAR(plugin.report.max_stiffness, 1000 * (1 + 2 * M_PI / 5), 30) << "the bumps are part of the claim";
  plugin.change("texture.amplitude", 1e-2);
  double highest = 0;
  for (int i = 0; i <= 2000; ++i) {  // 9 mm deep, over many bumps
    const double a = 2 * M_PI * i / 2000, b = 7 * a, r = 0.05 + 0.011 * std::cos(b);
    const hsp_contact contact = plugin.at(r * std::sin(a), 0.011 * std::sin(b), r * std::cos(a));
    highest = std::max(highest, std::hypot(contact.force[0], contact.force[1], contact.force[2]) / 1000 - 0.009);
  }
  EXPECT_NEAR(highest, 4 * 5e-3 / (2 * M_PI), 2e-4);
}

TEST(NurbsRigid, AHeldContactKeepsItsFace) {
  for (double hold : {0.0, 0.05}) {
    Plugin plugin;
    plugin.set("geometry", kModels + "box.yaml");
    plugin.set("hold", hold);
    ASSERT_EQ(plugin.activate(), HSP_OK);
    hsp_contact contact{};
    for (int i = 0; i < 600; ++i) contact = plugin.at(0.047, 0.0505 - 1e-5 * i, 0);  // 5.5 mm deep, 3 mm off the side
    EXPECT_EQ(contact.force[1] > 0, hold > 0);
    EXPECT_EQ(contact.force[0] > 0, hold == 0);
  }
}

TEST(NurbsRigid, ControlNetsAndTablesFeelTheSame) {
  Plugin table, net;
  for (Plugin* plugin : {&table, &net}) {
    plugin->set("geometry", kModels + "torus.yaml");
    plugin->set("evaluation", plugin == &net ? 1 : 0);
    ASSERT_EQ(plugin->activate(), HSP_OK);
  }
  for (int i = 0; i < 100; ++i) {
    const double x = 1e-4 * i;
    EXPECT_NEAR(table.at(x, 0.019, 0.05).force[1], net.at(x, 0.019, 0.05).force[1], 1e-9);
  }
}

TEST(NurbsRigid, SidesSayWhereTheSolidIs) {
  for (const auto& [sides, inside, outside] : {std::tuple{0, true, false}, {1, false, true}}) {
    Plugin plugin;
    plugin.set("geometry", kModels + "sphere.yaml");
    plugin.set("sides", sides);
    ASSERT_EQ(plugin.activate(), HSP_OK);
    EXPECT_EQ((plugin.at(0.049, 0, 0).flags & HSP_OUT_CONTACT) != 0, inside);
    EXPECT_EQ((plugin.at(0.051, 0, 0).flags & HSP_OUT_CONTACT) != 0, outside);
  }
}

TEST(NurbsRigid, AShellPushesBackToTheSideItWasEnteredFromUntilItGivesWay) {
  Plugin plugin;
  plugin.set("geometry", kModels + "sphere.yaml");
  plugin.set("sides", 2);
  plugin.set("pop_through", 2);
  ASSERT_EQ(plugin.activate(), HSP_OK);
  plugin.at(0.048, 0, 0);
  EXPECT_LT(plugin.at(0.051, 0, 0).force[0], -0.79);  // from inside, outward: pushed in again
  EXPECT_LT(plugin.at(0.053, 0, 0).force[0], -2.0);   // gives way
  EXPECT_EQ(plugin.at(0.053, 0, 0).force[0], 0);
  EXPECT_GT(plugin.at(0.049, 0, 0).force[0], 0.79);
}

TEST(NurbsRigid, ANanSampleGivesNoForceAndTheNextOneIsTraced) {
  Plugin plugin;
  plugin.set("geometry", kModels + "torus.yaml");
  ASSERT_EQ(plugin.activate(), HSP_OK);
  const hsp_contact before = plugin.at(0.069, 0, 0);
  const hsp_contact bad = plugin.at(0.069, NAN, 0);
  EXPECT_EQ(plugin.status, HSP_E_NUMERIC);
  EXPECT_EQ(bad.force[0], 0);
  EXPECT_NEAR(plugin.at(0.069, 0, 0).force[0], before.force[0], 1e-9);
}

/// A foot that was on its way there would push from the wrong side, tens of millimetres deep.
TEST(NurbsRigid, AfterAJumpNothingPushesUntilASearchHasAnswered) {
  for (const char* model : {"teapot.yaml", "goblet.yaml", "torus.yaml"}) {
    Plugin plugin;
    ASSERT_EQ(plugin.set("geometry", kModels + model), HSP_OK);
    ASSERT_EQ(plugin.activate(), HSP_OK);
    uint32_t seed = 7;
    const auto coordinate = [&] { return 0.12 * ((seed = seed * 1664525u + 1013904223u) / 2147483648.0 - 1); };
    for (int i = 0; i < 20; ++i) {
      const double p[3] = {coordinate(), coordinate(), coordinate()};
      const hsp_contact jumped = plugin.step(p, 0, HSP_IN_JUMP);
      EXPECT_EQ(jumped.flags & HSP_OUT_CONTACT, 0u) << model;
      EXPECT_EQ(Eigen::Vector3d(jumped.force).norm(), 0) << model;
      Plugin other;
      ASSERT_EQ(other.set("geometry", kModels + model), HSP_OK);
      ASSERT_EQ(other.activate(), HSP_OK);
      const hsp_contact searched = plugin.at(p[0], p[1], p[2], 0, HSP_IN_JUMP), alone = other.at(p[0], p[1], p[2]);
      EXPECT_NEAR(searched.depth_m, alone.depth_m, 1e-9) << model;
    }
  }
}

TEST(NurbsRigid, RefusesAMissingModelAndOutOfRangeValues) {
  Plugin plugin;
  plugin.set("geometry", kModels + "no_such_model.yaml");
  EXPECT_LT(plugin.activate(), 0);
  EXPECT_EQ(plugin.set("stiffness", -1), HSP_E_ARG);
  EXPECT_EQ(plugin.set("stiffness", NAN), HSP_E_ARG);
}

TEST(NurbsRigid, DrawsAMeshWithinTheChordError) {
  Plugin plugin;
  plugin.set("geometry", kModels + "sphere.yaml");
  ASSERT_EQ(plugin.activate(), HSP_OK);
  hsp_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  ASSERT_EQ(plugin.geometry().tessellate(plugin.handle(), 1e-4, &mesh), HSP_OK);
  ASSERT_GT(mesh.triangle_count, 100u);
  for (uint32_t i = 0; i < mesh.triangle_count; ++i) {
    double center[3] = {0, 0, 0};
    for (uint32_t corner = 0; corner < 3; ++corner)
      for (uint32_t axis = 0; axis < 3; ++axis)
        center[axis] += static_cast<double>(mesh.xyz[3 * mesh.indices[3 * i + corner] + axis]) / 3;
    EXPECT_NEAR(std::sqrt(center[0] * center[0] + center[1] * center[1] + center[2] * center[2]), 0.05, 2e-4);
  }
}

}  // namespace
