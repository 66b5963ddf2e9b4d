// SPDX-License-Identifier: MIT
#include "soft_plugin.hpp"

namespace hapticd::test {
namespace {

TEST(MatDeformable, PushesOutAsDeepAsItIsPressed) {
  Plugin plate;
  plate.set("shear_offset", 0.0);
  ASSERT_EQ(plate.activate(), HSP_OK);
  plate.search({.01, .02, .03});
  EXPECT_EQ(forceOf(plate.touch({.01, .02, .0101})).norm(), 0);
  const hsp_contact contact = plate.touch({.01, .02, .006});
  EXPECT_NEAR(contact.depth_m, .004, 1e-12);
  EXPECT_NEAR(contact.force[2], .004 * 200, 1e-9);
  EXPECT_NEAR(contact.point[2], .01, 1e-12);
  EXPECT_TRUE((contact.flags & HSP_OUT_CONTACT) != 0);
}

TEST(MatDeformable, ClaimsAndFeelsWhatTheFileSaysWithShearDistance) {
  Plugin body("palpation.yaml"), paper("palpation.yaml");
  body.set("shear_distance", .006);
  ASSERT_EQ(body.activate(), HSP_OK);
  ASSERT_EQ(paper.activate(), HSP_OK);
  EXPECT_NEAR(body.report.max_stiffness, 960.97, .1);  // the stiffest point of the file
  EXPECT_NEAR(paper.report.max_stiffness, 5 * 960.97, .5);
  for (Plugin* one : {&body, &paper}) one->search({.015, -.01125, .03});
  const Vector3d place(.015, -.01125, .015 + .0035156 - .004);
  const hsp_contact said = body.touch(place), stiffer = paper.touch(place);
  EXPECT_NEAR(Vector3d(said.normal).dot(forceOf(said)), said.depth_m * 961, .02 * said.depth_m * 961);
  EXPECT_GT(forceOf(stiffer).norm(), 1.2 * forceOf(said).norm());
}

/// Messages of a body when it is activated.
std::string told(const std::string& file, double distance, const char* envelope = "exact") {
  static std::string all;
  all.clear();
  hsp_host host{};
  host.struct_size = sizeof host;
  host.log = [](const hsp_host*, int32_t level, const char* text) { all += std::to_string(level) + " " + text + "\n"; };
  const hsp_class& kind = *hsp_plugin_entry.classes[0];
  hsp_shape* shape = kind.create(&kind, &host);
  const auto set = [&](const char* id, hsp_value value) {
    for (uint32_t i = 0; i < kind.param_count; ++i)
      if (std::strcmp(kind.params[i].id, id) == 0) value.kind = kind.params[i].kind, kind.set(shape, i, &value);
  };
  set("geometry", {0, 0, 0, file.c_str(), nullptr});
  set("shear_distance", {0, 0, distance, nullptr, nullptr});
  set("envelope", {0, 0, std::string_view(envelope) == "foot" ? 1.0 : 0.0, nullptr, nullptr});
  hsp_activation activation{};
  activation.struct_size = sizeof activation;
  hsp_report report{};
  report.struct_size = sizeof report;
  EXPECT_EQ(kind.activate(shape, &activation, &report), HSP_OK);
  kind.deactivate(shape);
  kind.destroy(shape);
  return all;
}

TEST(MatDeformable, SaysWhatIsFeltAndHintsWhereTheFileSaysOtherwise) {
  const std::string palpation = HAPTICD_SOURCE_DIR "/config/models/palpation.yaml";
  const std::string old = told(palpation, 0), now = told(palpation, .006);
  EXPECT_NE(old.find("use shear_distance instead"), std::string::npos) << old;
  EXPECT_EQ(now.find("use shear_distance instead"), std::string::npos) << now;
  EXPECT_NE(now.find("0 felt 961 N/m 1 mm deep, 961 N/m 5 mm deep; the file says 961 N/m: (15.47, -11.87"),
            std::string::npos)
      << now;
}

/// With `envelope: foot` a stroke over the pebble feels less than a fifth of the force.
TEST(MatDeformable, WarnsOfTheFootWhereTheRadiusChanges) {
  const std::string folder = HAPTICD_SOURCE_DIR "/config/models/";
  const char* warning = "use envelope: exact";
  EXPECT_NE(told(folder + "pebble.yaml", .006, "foot").find(warning), std::string::npos);
  EXPECT_EQ(told(folder + "pebble.yaml", .006).find(warning), std::string::npos);
  EXPECT_EQ(told(folder + "soft-plate.yaml", .006, "foot").find(warning), std::string::npos);
}

/// The numbers of a hapticd-model/2 file are those that are felt.
TEST(MatDeformable, NewFilesHaveNoSpringsThatStiffenThem) {
  const TemporaryFile file("new.yaml",
                           "format: hapticd-model/2\nmedial:\n  points: [[[0, 0, 0], [0.1, 0, 0]], [[0, 0.1, 0], "
                           "[0.1, 0.1, 0]]]\n  radius: 0.01\n  stiffness: 200\n");
  Plugin body(file.path());
  ASSERT_EQ(body.activate(), HSP_OK);
  EXPECT_EQ(body.report.max_stiffness, 200);
  body.search({.05, .05, .03});
  EXPECT_NEAR(body.touch({.05, .05, .004}).force[2], 1.2, 1e-9);
}

TEST(MatDeformable, AStaticHoldIsConstant) {
  for (const char* model : {"soft-plate.yaml", "palpation.yaml", "leaf.yaml", "rope.yaml"}) {
    Plugin body(model);
    ASSERT_EQ(body.activate(), HSP_OK) << model;
    const Vector3d p = std::strcmp(model, "rope.yaml") == 0 ? Vector3d(0, .014, -.002) : Vector3d(.012, .003, .009);
    body.search(p);
    body.touch(p);
    const Vector3d first = forceOf(body.touch(p));
    ASSERT_GT(first.norm(), 0) << model;
    for (int i = 0; i < 3000; ++i) ASSERT_LT((forceOf(body.touch(p)) - first).norm(), 1e-12) << model << " " << i;
  }
}

TEST(MatDeformable, AStruckBodyLeftAloneLosesItsEnergyAndSleeps) {
  Plugin plate;
  ASSERT_EQ(plate.activate(), HSP_OK);
  plate.search({0, 0, .03});
  for (int i = 0; i < 40; ++i) plate.touch({0, 0, .011 - 1e-4 * i}, {0, 0, -.1});
  plate.touch({0, 0, .02});
  double before = plate.energy();
  EXPECT_GT(before, 0);
  for (int i = 0; i < 3000; ++i) {
    plate.touch({0, 0, .02});
    ASSERT_LE(plate.energy(), before);
    before = plate.energy();
  }
  EXPECT_EQ(before, 0);
}

TEST(MatDeformable, CatchesUpWithTheTimeItWasNotStepped) {
  Plugin stepped, left;
  for (Plugin* plate : {&stepped, &left}) {
    ASSERT_EQ(plate->activate(), HSP_OK);
    plate->search({0, 0, .03});
    for (int i = 0; i < 40; ++i) plate->touch({0, 0, .011 - 1e-4 * i}, {0, 0, -.1});
    plate->touch({0, 0, .02});
  }
  for (int i = 0; i < 50; ++i) stepped.touch({0, 0, .02});
  left.rest(.049);
  left.touch({0, 0, .02});
  EXPECT_NEAR(left.energy(), stepped.energy(), 1e-9 * stepped.energy());
}

TEST(MatDeformable, ProbePushedThroughTheSkeletonIsStillPushedBack) {
  Plugin plate;
  ASSERT_EQ(plate.activate(), HSP_OK);
  plate.search({0, 0, .03});
  double before = 0;
  for (int i = 0; i < 180; ++i) {  // from 0.1 mm below the top to 2 mm above the bottom
    const hsp_contact contact = plate.touch({.01, .01, .0099 - 1e-4 * i});
    ASSERT_GT(contact.force[2], before) << i;
    before = contact.force[2];
  }
  EXPECT_EQ(plate.touch({.01, .01, -.0101}).force[2], 0);
  EXPECT_LT(plate.touch({.01, .01, -.0099}).force[2], 0);  // it came from below
}

TEST(MatDeformable, SeveralProbesAreAnsweredAtOnce) {
  Plugin plate;
  ASSERT_EQ(plate.activate(2), HSP_OK);
  const std::vector<Vector3d> at{{-.02, 0, .007}, {.03, .01, -.008}};
  for (uint32_t i = 0; i < 2; ++i) plate.search(at[i], i);
  const std::vector<hsp_contact> contacts = plate.step(at);
  EXPECT_NEAR(contacts[0].depth_m, .003, 1e-12);
  EXPECT_NEAR(contacts[1].depth_m, .002, 1e-12);
  EXPECT_GT(contacts[0].force[2], 0);
  EXPECT_LT(contacts[1].force[2], 0);
}

TEST(MatDeformable, FrictionHoldsAProbeBackAlongTheSurface) {
  Plugin plate;
  plate.set("friction_static", .5);
  plate.set("friction_dynamic", .4);
  ASSERT_EQ(plate.activate(), HSP_OK);
  plate.search({0, 0, .03});
  hsp_contact contact{};
  for (int i = 0; i < 100; ++i) contact = plate.touch({1e-4 * i, 0, .006}, {.1, 0, 0});
  EXPECT_LT(contact.force[0], -.4 * contact.force[2]);
  EXPECT_GT(contact.force[0], -.5 * contact.force[2]);
}

TEST(MatDeformable, FrictionForgetsWhereAFingerStuckBeforeItLifted) {
  for (const int dynamics : {0, 3}) {  // off, felt
    Plugin plate;
    plate.set("friction_static", .5);
    plate.set("friction_dynamic", .4);
    plate.set("dynamics", dynamics);
    ASSERT_EQ(plate.activate(), HSP_OK);
    plate.search({0, 0, .03});
    hsp_contact contact{};
    for (int i = 0; i < 200; ++i) contact = plate.touch({1e-5 * i, 0, .006});
    EXPECT_LT(contact.force[0], -.2 * contact.force[2]) << "it sticks " << dynamics;
    plate.touch({.01, 0, .01005});  // over the surface, which still swings
    contact = plate.touch({.01, 0, .006});
    ASSERT_GT(contact.force[2], 0);
    EXPECT_LT(std::abs(contact.force[0]), .05 * contact.force[2]) << dynamics;
  }
}

TEST(MatDeformable, WarmAndBinarySearchAgree) {
  Plugin newton("palpation.yaml"), binary("palpation.yaml");
  binary.set("search", 1.0);
  binary.set("depth", 24.0);
  for (Plugin* body : {&newton, &binary}) {
    ASSERT_EQ(body->activate(), HSP_OK);
    body->search({0, 0, .03});
  }
  for (int i = 0; i < 200; ++i) {
    const Vector3d p(1e-4 * i, -5e-5 * i, .012);
    const hsp_contact a = newton.touch(p), b = binary.touch(p);
    EXPECT_NEAR(a.depth_m, b.depth_m, 1e-9);
    EXPECT_LT((forceOf(a) - forceOf(b)).norm(), 1e-4 * forceOf(a).norm());
    if (i > 1) {
      EXPECT_LE(a.iterations, 5u);
    }
  }
}

TEST(MatDeformable, AProbeThatJumpsIsFoundAgainInTheSameStep) {
  Plugin plate;
  ASSERT_EQ(plate.activate(), HSP_OK);
  plate.search({0, 0, .03});
  plate.touch({-.04, -.03, .007});
  EXPECT_NEAR(plate.step({Vector3d(.04, .03, -.006)}, Vector3d::Zero(), 1e-3, HSP_IN_JUMP)[0].depth_m, .004, 1e-9);
}

TEST(MatDeformable, AnswersNothingToABadSampleAndGoesOn) {
  Plugin plate;
  ASSERT_EQ(plate.activate(), HSP_OK);
  plate.search({0, 0, .03});
  const Vector3d p(.01, .02, .006);
  const double good = plate.touch(p).force[2];
  EXPECT_EQ(plate.step({p}, Vector3d::Zero(), 1e-3, HSP_IN_INVALID)[0].force[2], 0);
  plate.step({Vector3d(NAN, 0, 0)});
  EXPECT_EQ(plate.status, HSP_E_NUMERIC);
  EXPECT_EQ(plate.touch(p, {NAN, NAN, NAN}).force[2], good);
  EXPECT_EQ(plate.touch(p).force[2], good);
}

TEST(MatDeformable, DrawsTheDentOfAPress) {
  Plugin plate;
  ASSERT_EQ(plate.activate(), HSP_OK);
  const auto& geometry = plate.extension<hsp_ext_geometry>(HSP_EXT_GEOMETRY);
  hsp_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  plate.search({0, 0, .03});
  const auto highest = [&] {
    EXPECT_EQ(geometry.tessellate(plate.handle(), 2e-4, &mesh), HSP_OK);
    float z = 1;  // of the top, at its middle
    for (uint32_t i = 0; i < mesh.vertex_count; ++i)
      if (std::hypot(mesh.xyz[3 * i], mesh.xyz[3 * i + 1]) < 1e-3F && mesh.normals[3 * i + 2] > 0)
        z = std::min(z, mesh.xyz[3 * i + 2]);
    return z;
  };
  EXPECT_NEAR(highest(), .01, 1e-6);
  for (int i = 0; i < 100; ++i) plate.touch({0, 0, .006});
  EXPECT_NEAR(highest(), .006, 1e-5);
  double low[3], high[3];
  EXPECT_EQ(geometry.bounds(plate.handle(), low, high), HSP_OK);
  EXPECT_NEAR(high[2], .01, 1e-9);
}

TEST(MatDeformable, WritesVerticesInTheStepOnlyWhereAsked) {
  Plugin silent, drawn;
  drawn.set("display_tolerance", 1e-3);
  ASSERT_EQ(silent.activate(), HSP_OK);
  ASSERT_EQ(drawn.activate(), HSP_OK);
  EXPECT_EQ(silent.report.viz_vertices, 0u);
  EXPECT_GT(drawn.report.viz_vertices, 100u);
}

/// Frames as a host asks for them, every 17th tick, while the body is held and has settled: the last one.
std::vector<float> heldFrame(Plugin& body, const Vector3d& p, std::size_t vertices) {
  std::vector<float> frame;
  for (int i = 0; i < 40 * 17; ++i) {
    if (i % 17 == 16) body.viz.assign(3 * vertices, NAN);
    body.touch(p);
    if (i % 17 == 16) std::swap(frame, body.viz);
    body.viz.clear();
  }
  return frame;
}

TEST(MatDeformable, FramesOfAnySizeAreTheVerticesOfTheMesh) {
  for (const double tolerance : {1e-3, 1e-5}) {  // written in one step, and in several
    Plugin plate;
    plate.set("display_tolerance", tolerance);
    ASSERT_EQ(plate.activate(), HSP_OK);
    const auto& geometry = plate.extension<hsp_ext_geometry>(HSP_EXT_GEOMETRY);
    plate.search({0, 0, .03});
    const std::vector<float> frame = heldFrame(plate, {0, 0, .006}, plate.report.viz_vertices);
    hsp_mesh mesh{};
    mesh.struct_size = sizeof mesh;
    ASSERT_EQ(geometry.tessellate(plate.handle(), 0, &mesh), HSP_OK);
    ASSERT_EQ(mesh.vertex_count, plate.report.viz_vertices);
    EXPECT_EQ(mesh.vertex_count > 1024, tolerance < 1e-4);
    float lowest = 1;
    for (uint32_t i = 0; i < 3 * mesh.vertex_count; ++i) ASSERT_NEAR(frame[i], mesh.xyz[i], 1e-6) << i;
    for (uint32_t i = 0; i < mesh.vertex_count; ++i)
      if (mesh.normals[3 * i + 2] > 0 && std::hypot(mesh.xyz[3 * i], mesh.xyz[3 * i + 1]) < 2e-3F)
        lowest = std::min(lowest, frame[3 * i + 2]);
    EXPECT_NEAR(lowest, .006, 1e-4);
  }
}

TEST(MatDeformable, WritesNoMoreVerticesThanThereIsRoomFor) {
  Plugin plate;
  plate.set("display_tolerance", 1e-3);
  ASSERT_EQ(plate.activate(), HSP_OK);
  plate.search({0, 0, .03});
  plate.viz.assign(3 * 10, NAN);
  plate.viz.reserve(3 * 20);
  plate.touch({0, 0, .006});
  for (const float x : plate.viz) EXPECT_TRUE(std::isfinite(x));
}

TEST(MatDeformable, ReportsWhatItNeeds) {
  Plugin plate;
  ASSERT_EQ(plate.activate(), HSP_OK);
  EXPECT_TRUE((plate.report.flags & HSP_R_VELOCITY) != 0);  // it damps
  EXPECT_NEAR(plate.report.size_m, Vector3d(.12, .10, .02).norm(), 1e-9);
  EXPECT_LT(plate.report.locked_bytes, 40'000u);
  EXPECT_GE(plate.report.max_stiffness, 200);
}

TEST(MatDeformable, RefusesAModelWithoutAMedialAxis) {
  Plugin body("sphere.yaml");
  EXPECT_EQ(body.activate(), HSP_E_ARG);
}

TEST(MatDeformable, WarnsOfABodyThatNobodyCanFeel) {
  const TemporaryFile file("flat.yaml",
                           "format: hapticd-model/1\nmedial:\n  points: [[[0, 0, 0], [0.1, 0, 0]], [[0, 0.1, 0], [0.1, "
                           "0.1, 0]]]\n  radius: 0\n  stiffness: 200\n");
  Plugin body(file.path());
  testing::internal::CaptureStdout();
  EXPECT_EQ(body.activate(), HSP_OK);
  EXPECT_NE(testing::internal::GetCapturedStdout().find("all radii are 0"), std::string::npos);
}

}  // namespace
}  // namespace hapticd::test
