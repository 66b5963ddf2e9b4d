// SPDX-License-Identifier: MIT
/// The volume of pressed bodies.
#include "../kernels/medial/meshes.hpp"
#include "soft_plugin.hpp"

namespace hapticd::test {
namespace {

double volumeOf(Plugin& body) {
  const auto& geometry = body.extension<hsp_ext_geometry>(HSP_EXT_GEOMETRY);
  hsp_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  EXPECT_EQ(geometry.tessellate(body.handle(), 5e-5, &mesh), HSP_OK);
  const auto at = [&](uint32_t i) -> Vector3d {
    return Eigen::Map<const Eigen::Vector3f>(mesh.xyz + 3 * std::size_t{mesh.indices[i]}).cast<double>();
  };
  double sum = 0;
  for (uint32_t t = 0; t < 3 * mesh.triangle_count; t += 3) sum += at(t).dot(at(t + 1).cross(at(t + 2))) / 6;
  return sum;
}

struct Pressed {
  double before, after;  ///< [m^3]
  double change() const { return std::fabs(after / before - 1); }
};

/// Presses from above by `share` of the thickness at x = y = 0, and holds.
Pressed press(const std::string& model, bool keep, double share, double split = 0.5) {
  Plugin body(model);
  body.set("volume", keep ? 1.0 : 0.0);
  body.set("split", split);
  EXPECT_EQ(body.activate(), HSP_OK);
  Pressed result{volumeOf(body), 0};
  const Vector3d above(.001, .001, .04);
  body.search(above);
  const hsp_contact rest = body.touch({.001, .001, .0201});
  const double top = rest.point[2], thickness = 2 * top;  // all of them lie about z = 0, nearly
  for (int i = 0; i < 300; ++i) body.touch({.001, .001, top - thickness * share * std::min(1.0, i / 100.0)});
  result.after = volumeOf(body);
  return result;
}

TEST(Volume, APressOfThirtyPercentKeepsItWithinOnePercent) {
  const TemporaryFile mesh("y.yaml", [] {
    std::string text = "format: hapticd-model/1\nmedial:\n  vertices:\n";
    const medial::MeshData data = medial::test::branches();
    for (const auto& s : data.vertices)
      text += "    - [" + std::to_string(s.center.x()) + ", " + std::to_string(s.center.y()) + ", 0, " +
              std::to_string(s.radius) + "]\n";
    text += "  edges:\n";
    for (const auto& e : data.edges) text += "    - [" + std::to_string(e[0]) + ", " + std::to_string(e[1]) + "]\n";
    return text + "  stiffness: 300\n  damping: 0.5\n  mass: 0.001\n";
  }());
  for (const std::string& model : {std::string("pebble.yaml"), std::string("loaf.yaml"), std::string("soft-plate.yaml"),
                                   std::string("palpation.yaml"), mesh.path()}) {
    for (const double split : {0.3, 0.5}) {
      const Pressed off = press(model, false, .3, split), on = press(model, true, .3, split);
      EXPECT_GT(off.change(), 3 * on.change()) << model;
      EXPECT_GT(off.change(), .005) << model;
      EXPECT_LE(on.change(), .01) << model << " split " << split << " without " << off.change();
    }
  }
}

TEST(Volume, IsKeptUnderSeveralContactsAtOnce) {
  double changes[2];
  for (const bool keep : {false, true}) {
    Plugin body("loaf.yaml");
    body.set("volume", keep ? 1.0 : 0.0);
    ASSERT_EQ(body.activate(3), HSP_OK);
    const double before = volumeOf(body);
    const std::vector<Vector3d> places{{.001, .001, 0}, {.02, .01, 0}, {-.02, -.01, 0}};
    std::vector<Vector3d> probes = places;
    for (uint32_t i = 0; i < 3; ++i) {
      probes[i].z() = .04;
      body.search(probes[i], i);
    }
    for (int k = 0; k < 100; ++k) {  // down by the distance to the surface, until they lie on it
      const auto apart = body.step(probes);
      for (std::size_t i = 0; i < 3; ++i) probes[i].z() += std::min(0.0, apart[i].depth_m);
    }
    const std::vector<Vector3d> top = probes;
    for (int k = 0; k < 400; ++k) {
      for (std::size_t i = 0; i < 3; ++i) probes[i].z() = top[i].z() - .005 * std::min(1.0, k / 100.0);
      for (const hsp_contact& contact : body.step(probes)) ASSERT_TRUE(k < 10 || contact.depth_m > 0);
    }
    changes[keep ? 1 : 0] = std::fabs(volumeOf(body) / before - 1);
  }
  EXPECT_GT(changes[0], 5 * changes[1]);
  EXPECT_LE(changes[1], .01);
}

TEST(Volume, NothingGrowsWithoutBoundAtTheExtremes) {
  for (const double split : {0.0, 0.5, 1.0}) {
    for (const double share : {.1, .9, 3.0}) {
      const Pressed on = press("pebble.yaml", true, share, split);
      EXPECT_TRUE(std::isfinite(on.after));
      EXPECT_LT(std::fabs(on.after), 10 * on.before) << split << " " << share;
    }
  }
}

TEST(Volume, AStruckBodyComesBackToItsShapeAndSleeps) {
  for (const double speed : {-.1, -5.0}) {
    Plugin body("pebble.yaml");
    body.set("volume", 1.0);
    ASSERT_EQ(body.activate(), HSP_OK);
    const double rest = volumeOf(body);
    body.search({0, 0, .03});
    for (int i = 0; i < 40; ++i) body.touch({0, 0, .017 - 2e-4 * i}, {0, 0, speed});
    body.touch({0, 0, .03});
    double before = body.energy();
    EXPECT_GT(before, 0);
    for (int i = 0; i < 4000; ++i) {
      body.touch({0, 0, .03});
      ASSERT_LE(body.energy(), before) << i;
      before = body.energy();
    }
    EXPECT_EQ(before, 0);
    EXPECT_NEAR(volumeOf(body) / rest, 1, 1e-6);
  }
}

}  // namespace
}  // namespace hapticd::test
