// SPDX-License-Identifier: MIT
/// Bodies from a medial mesh, through the C ABI.

#include "../kernels/medial/meshes.hpp"
#include "soft_plugin.hpp"

namespace hapticd::test {
namespace {

std::string maOf(const medial::MeshData& mesh) {
  std::string text = std::to_string(mesh.vertices.size()) + " " + std::to_string(mesh.edges.size()) + " " +
                     std::to_string(mesh.triangles.size()) + "\n";
  char line[128];
  for (const medial::Sphere& s : mesh.vertices) {
    std::snprintf(line, sizeof line, "v %.17g %.17g %.17g %.17g\n", s.center.x(), s.center.y(), s.center.z(), s.radius);
    text += line;
  }
  for (const auto& e : mesh.edges) text += "e " + std::to_string(e[0]) + " " + std::to_string(e[1]) + "\n";
  for (const auto& f : mesh.triangles)
    text += "f " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) + "\n";
  return text;
}

const std::string kTube = "2 1 0\nv -0.05 0 0 0.01\nv 0.05 0 0 0.01\ne 0 1\n";

TEST(MedialMeshBody, PushesOutAsDeepAsItIsPressed) {
  const TemporaryFile file("tube.ma", kTube);
  Plugin tube(file.path());
  tube.set("stiffness", 200.0);
  ASSERT_EQ(tube.activate(), HSP_OK);
  tube.search({.01, 0, .03});
  EXPECT_EQ(forceOf(tube.touch({.01, 0, .0101})).norm(), 0);
  const hsp_contact contact = tube.touch({.01, 0, .006});
  EXPECT_NEAR(contact.depth_m, .004, 1e-12);
  EXPECT_NEAR(contact.force[2], .8, 1e-9);
  EXPECT_NEAR(contact.point[2], .01, 1e-12);
  EXPECT_EQ(contact.feature, 0u);
  EXPECT_NEAR(contact.param[0], .6, 1e-9);
  EXPECT_TRUE((contact.flags & HSP_OUT_CONTACT) != 0);
}

TEST(MedialMeshBody, ReadsTheSameBodyFromYaml) {
  const TemporaryFile ma("y.ma", maOf(medial::test::branches()));
  std::string text = "format: hapticd-model/1\nmedial:\n  vertices:\n";
  char line[160];
  for (const medial::Sphere& s : medial::test::branches().vertices) {
    std::snprintf(line, sizeof line, "    - [%.17g, %.17g, %.17g, %.17g]\n", s.center.x(), s.center.y(), s.center.z(),
                  s.radius);
    text += line;
  }
  text += "  edges:\n";
  for (const auto& e : medial::test::branches().edges)
    text += "    - [" + std::to_string(e[0]) + ", " + std::to_string(e[1]) + "]\n";
  const TemporaryFile yaml("y.yaml", text + "  stiffness: 300\n  damping: 0.5\n  mass: 0.01\n");
  Plugin a(ma.path()), b(yaml.path());
  for (Plugin* body : {&a, &b}) {
    ASSERT_EQ(body->activate(), HSP_OK);
    body->search({0, 0, .02});
  }
  for (int k = 0; k < 200; ++k) {
    const Vector3d p(.02 * std::sin(.05 * k), .02 * std::cos(.05 * k), .004);
    ASSERT_EQ(forceOf(a.touch(p)), forceOf(b.touch(p)));
  }
}

TEST(MedialMeshBody, ASecondRunGivesTheSameBits) {
  const TemporaryFile file("sheet.ma", maOf(medial::test::sheet(12)));
  std::vector<Vector3d> first;
  for (int run = 0; run < 2; ++run) {
    Plugin body(file.path());
    ASSERT_EQ(body.activate(), HSP_OK);
    body.search({.05, .05, .03});
    for (int k = 0; k < 500; ++k) {
      const Vector3d f = forceOf(body.touch({.05 + .03 * std::sin(.01 * k), .05 + .03 * std::cos(.013 * k), .02}));
      if (run == 0) first.push_back(f);
      ASSERT_EQ(f, first[static_cast<std::size_t>(k)]);
    }
  }
}

/// Straight through the middle of the body, from 0.1 mm below its surface to as near to the other one.
void expectPushedBack(const std::string& path, const Vector3d& from, const Vector3d& to) {
  Plugin body(path);
  body.set("crease", 0.0);
  body.set("shear_offset", 0.0);
  ASSERT_EQ(body.activate(), HSP_OK);
  body.search(from);
  const Vector3d back = (from - to).normalized();
  body.touch(from + .001 * back);
  double before = 0;
  for (int i = 0; i <= 200; ++i) {
    const double push = forceOf(body.touch(from + i / 200.0 * (to - from))).dot(back);
    ASSERT_GT(push, .98 * before) << i;
    before = push;
  }
  EXPECT_EQ(forceOf(body.touch(to - .002 * back)).norm(), 0);
  EXPECT_LT(forceOf(body.touch(to)).dot(back), 0);  // it came from the other side
}

TEST(MedialMeshBody, AProbePushedThroughTheMiddleIsStillPushedBack) {
  const TemporaryFile tube("tube.ma", kTube);
  expectPushedBack(tube.path(), {.01, .0001, .0099}, {.01, .0001, -.0099});
  const TemporaryFile sheet(
      "sheet.ma", "4 0 2\nv 0 0 0 0.01\nv 0.1 0 0 0.01\nv 0.1 0.1 0 0.01\nv 0 0.1 0 0.01\nf 0 1 2\nf 0 2 3\n");
  expectPushedBack(sheet.path(), {.051, .043, .0099}, {.051, .043, -.0099});
  expectPushedBack(HAPTICD_SOURCE_DIR "/config/models/rope.yaml", {0, .012, .0003}, {0, .012, -.0087});
}

TEST(MedialMeshBody, TheForceHasNoJumpAcrossTheCrotch) {
  const TemporaryFile file("y.ma", maOf(medial::test::branches()));
  Plugin body(file.path());
  ASSERT_EQ(body.activate(), HSP_OK);
  body.search({0, .02, 0});
  Vector3d before = forceOf(body.touch({-.004, .0102, .0005}));
  for (int k = -3999; k <= 4000; ++k) {  // 1 um a tick
    const Vector3d f = forceOf(body.touch({1e-6 * k, .0102, .0005}));
    ASSERT_GT(f.norm(), 0);
    ASSERT_LT((f - before).norm(), .02 * f.norm()) << k;
    before = f;
  }
}

TEST(MedialMeshBody, ProbesOnTwoBranchesAreAnsweredAtOnce) {
  const TemporaryFile file("y.ma", maOf(medial::test::branches()));
  Plugin body(file.path());
  ASSERT_EQ(body.activate(2), HSP_OK);
  const std::vector<Vector3d> at{{.02, .011, .006}, {-.02, .012, -.006}};
  for (uint32_t i = 0; i < 2; ++i) body.search(at[i], i);
  const std::vector<hsp_contact> contacts = body.step(at);
  EXPECT_GT(contacts[0].force[2], 0);
  EXPECT_LT(contacts[1].force[2], 0);
  EXPECT_NE(contacts[0].feature, contacts[1].feature);
}

TEST(MedialMeshBody, AStruckBodyLeftAloneLosesItsEnergyAndSleeps) {
  const TemporaryFile file("y.ma", maOf(medial::test::branches()));
  for (const char* volume : {"off", "on"}) {
    Plugin body(file.path());
    body.set("volume", std::strcmp(volume, "on") == 0 ? 1.0 : 0.0);
    body.set("mass", .002);
    ASSERT_EQ(body.activate(), HSP_OK);
    body.search({0, 0, .03});
    for (int i = 0; i < 40; ++i) body.touch({0, 0, .011 - 1e-4 * i}, {0, 0, -.1});
    body.touch({0, 0, .02});
    double before = body.energy();
    EXPECT_GT(before, 0);
    for (int i = 0; i < 3000; ++i) {
      body.touch({0, 0, .02});
      ASSERT_LE(body.energy(), before) << volume;
      before = body.energy();
    }
    EXPECT_EQ(before, 0) << volume;
  }
}

TEST(MedialMeshBody, DrawsTheDentOfAPressWithAClosedMesh) {
  const TemporaryFile file("y.ma", maOf(medial::test::branches()));
  Plugin body(file.path());
  ASSERT_EQ(body.activate(), HSP_OK);
  const auto& geometry = body.extension<hsp_ext_geometry>(HSP_EXT_GEOMETRY);
  hsp_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  body.search({.02, .011, .03});
  const auto highest = [&] {
    EXPECT_EQ(geometry.tessellate(body.handle(), 1e-4, &mesh), HSP_OK);
    float z = -1;
    for (uint32_t i = 0; i < mesh.vertex_count; ++i)
      if (std::hypot(mesh.xyz[3 * i] - .02F, mesh.xyz[3 * i + 1] - .011F) < 1e-3F) z = std::max(z, mesh.xyz[3 * i + 2]);
    return z;
  };
  const float rest = highest();
  for (int i = 0; i < 100; ++i) body.touch({.02, .011, rest - .002});
  EXPECT_NEAR(highest(), rest - .002, 2e-4);
}

TEST(MedialMeshBody, RefusesABadFileWithItsLine) {
  const TemporaryFile file("bad.ma", "2 1 0\nv 0 0 0 0.01\nv 0.1 0 0 0.01\ne 0 5\n");
  EXPECT_EQ(Plugin(file.path()).activate(), HSP_E_ARG);
}

TEST(SavedState, ABodyGoesOnFromWhereItWasSaved) {
  const TemporaryFile mesh("y.ma", maOf(medial::test::branches()));
  for (const std::string& path : {std::string("pebble.yaml"), mesh.path()}) {
    Plugin saved(path), loaded(path);
    ASSERT_EQ(saved.activate(), HSP_OK);
    saved.search({0, 0, .03});
    for (int i = 0; i < 40; ++i) saved.touch({0, 0, .018 - 3e-4 * i}, {0, 0, -.1});
    saved.touch({0, 0, .05});
    const auto& state = saved.extension<hsp_ext_state>(HSP_EXT_STATE);
    std::vector<char> bytes(static_cast<std::size_t>(state.save(saved.handle(), nullptr, 0)));
    ASSERT_EQ(state.save(saved.handle(), bytes.data(), bytes.size()), static_cast<int64_t>(bytes.size()));
    ASSERT_EQ(state.load(loaded.handle(), bytes.data(), bytes.size()), HSP_OK);
    std::vector<char> again(bytes.size());  // before it is there, it is what was loaded
    ASSERT_EQ(state.save(loaded.handle(), again.data(), again.size()), static_cast<int64_t>(bytes.size()));
    EXPECT_EQ(again, bytes) << path;
    ASSERT_EQ(loaded.activate(), HSP_OK);
    loaded.search({0, 0, .03});
    EXPECT_GT(saved.energy(), 0) << path;
    for (int i = 0; i < 100; ++i) {
      saved.touch({0, 0, .05});
      loaded.touch({0, 0, .05});
      ASSERT_NEAR(loaded.energy(), saved.energy(), 1e-9 * saved.energy()) << path << " " << i;
    }
  }
}

TEST(SavedState, OfAnotherBodyOrSpoiledIsRefused) {
  Plugin pebble("pebble.yaml"), plate("soft-plate.yaml");
  ASSERT_EQ(pebble.activate(), HSP_OK);
  const auto& state = pebble.extension<hsp_ext_state>(HSP_EXT_STATE);
  pebble.search({0, 0, .03});
  for (int i = 0; i < 40; ++i) pebble.touch({0, 0, .018 - 3e-4 * i});
  std::vector<char> bytes(static_cast<std::size_t>(state.save(pebble.handle(), nullptr, 0)));
  state.save(pebble.handle(), bytes.data(), bytes.size());
  EXPECT_EQ(state.load(pebble.handle(), bytes.data(), bytes.size()), HSP_E_STATE);  // it is active
  EXPECT_EQ(state.load(plate.handle(), bytes.data(), bytes.size() - 1), HSP_E_ARG);
  std::vector<char> spoiled = bytes;
  const double nan = NAN;
  std::memcpy(spoiled.data() + 24, &nan, sizeof nan);
  EXPECT_EQ(state.load(plate.handle(), spoiled.data(), spoiled.size()), HSP_E_ARG);
  EXPECT_EQ(state.load(plate.handle(), bytes.data(), bytes.size()), HSP_OK);
  EXPECT_EQ(plate.activate(), HSP_E_ARG);
  EXPECT_EQ(plate.activate(), HSP_OK);  // at rest
}

}  // namespace
}  // namespace hapticd::test
