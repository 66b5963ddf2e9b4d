// SPDX-License-Identifier: MIT
/// The host as it ships, with plugins of smaller and larger minor versions, and with plugins that are broken.
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "host/describe.hpp"
#include "host/shape_instance.hpp"

namespace hapticd::test {
namespace {

using host::ShapeInstance;

const std::string kDir = ABI_PLUGIN_DIR "/";

void ignore(int, const std::string&, const std::string&) {}

Result<std::unique_ptr<ShapeInstance>> instanceOf(const std::string& file, const std::string& plugin) {
  scene::Model model;
  model.name = "m";
  model.plugin = plugin;
  model.library = kDir + file + ".so";
  return ShapeInstance::create(model, ignore);
}

hsp_activation activation() {
  hsp_activation how{};
  how.struct_size = sizeof how;
  how.max_probes = 1;
  how.rate_hz = 1000;
  how.pose.orientation[0] = 1;
  return how;
}

/// One step of one probe 1 cm inside a sphere of 5 cm, in the middle of memory that must stay as it is.
hsp_contact touch(ShapeInstance& shape, hsp_status& status) {
  hsp_probe in{};
  in.position[0] = 0.04;
  hsp_contact out[3];
  std::memset(out, 0x5a, sizeof out);
  out[1] = hsp_contact{};
  hsp_pose pose{};
  pose.orientation[0] = 1;
  hsp_step step{};
  step.struct_size = sizeof step;
  step.count = 1;
  step.in = &in;
  step.out = &out[1];
  step.in_stride = sizeof in;
  step.out_stride = sizeof out[1];
  step.dt_s = 1e-3;
  step.pose = &pose;
  status = shape.step(step);
  for (const hsp_contact* guard : {&out[0], &out[2]})
    for (size_t i = 0; i < sizeof *guard; ++i)
      EXPECT_EQ(reinterpret_cast<const unsigned char*>(guard)[i], 0x5a) << "written beside its record";
  return out[1];
}

class PluginOfEveryVersion : public testing::TestWithParam<const char*> {};

TEST_P(PluginOfEveryVersion, RunsInTheShippedHost) {
  auto shape = instanceOf(GetParam(), GetParam());
  ASSERT_TRUE(shape) << shape.error();
  auto active = (*shape)->activate(activation());
  ASSERT_TRUE(active) << active.error();
  EXPECT_EQ((*shape)->report().flags, 0u);
  hsp_status status = HSP_E_STATE;
  const hsp_contact contact = touch(**shape, status);
  EXPECT_EQ(status, HSP_OK);
  EXPECT_NEAR(contact.depth_m, 0.01, 1e-15);
  EXPECT_NEAR(contact.force[0], 5, 1e-12);
}

TEST_P(PluginOfEveryVersion, IsDescribedInAChild) {
  auto classes = host::describeInChild(kDir + GetParam() + ".so");
  ASSERT_TRUE(classes) << classes.error();
  ASSERT_EQ(classes->size(), 1u);
  const host::ClassInfo& info = classes->front();
  EXPECT_EQ(info.name, GetParam());
  EXPECT_EQ(info.paramIds(), (std::vector<std::string>{"radius", "stiffness"}));
  EXPECT_EQ(info.params[1].max, 1e5);
}

INSTANTIATE_TEST_SUITE_P(Versions, PluginOfEveryVersion,
                         testing::Values("sphere_small", "sphere_same", "sphere_large"));

struct Broken {
  const char *file, *words;
};

class BrokenPlugin : public testing::TestWithParam<Broken> {};

TEST_P(BrokenPlugin, IsRefusedWithItsOwnReason) {
  const std::string file = kDir + GetParam().file + ".so";
  const auto classes = host::describeInChild(file);
  ASSERT_FALSE(classes);
  EXPECT_NE(classes.error().find(file), std::string::npos) << classes.error();
  EXPECT_NE(classes.error().find(GetParam().words), std::string::npos) << classes.error();
}

INSTANTIATE_TEST_SUITE_P(Kinds, BrokenPlugin,
                         testing::Values(Broken{"bad_no_symbol", "hsp_plugin_entry"},
                                         Broken{"bad_magic", "does not begin with the magic number of the interface"},
                                         Broken{"bad_major", "built for version 2."},
                                         Broken{"bad_no_class", "lists 0 classes"}, Broken{"bad_null_class", "damaged"},
                                         Broken{"bad_no_step", "lacks a required function"},
                                         Broken{"bad_crash", "crashed"}, Broken{"bad_throw", "threw an exception"},
                                         Broken{"bad_exit", "ended"}, Broken{"bad_hang", "longer than"},
                                         Broken{"bad_unresolved", "undefined symbol"}),
                         [](const auto& given) { return std::string(given.param.file); });

TEST(FaultyPlugin, ThatCannotActivateSaysWhyAndCanBeTriedAgain) {
  auto shape = instanceOf("faulty_shapes", "no_activation");
  ASSERT_TRUE(shape) << shape.error();
  for (int attempt = 0; attempt < 2; ++attempt) {
    const auto active = (*shape)->activate(activation());
    ASSERT_FALSE(active);
    EXPECT_NE(active.error().find("the coffee is cold"), std::string::npos) << active.error();
    EXPECT_FALSE((*shape)->active());
  }
}

TEST(FaultyPlugin, ThatMakesNoInstanceIsNamed) {
  const auto shape = instanceOf("faulty_shapes", "no_instance");
  ASSERT_FALSE(shape);
  EXPECT_NE(shape.error().find("no_instance"), std::string::npos) << shape.error();
}

TEST(FaultyPlugin, ThatClaimsNoNumberAsStiffnessIsRefused) {
  auto shape = instanceOf("faulty_shapes", "nan_claim");
  ASSERT_TRUE(shape) << shape.error();
  EXPECT_FALSE((*shape)->activate(activation()));
}

TEST(FaultyPlugin, ThatIsNotThereIsNamedWithTheFile) {
  const auto shape = instanceOf("no_such_file", "x");
  ASSERT_FALSE(shape);
  EXPECT_NE(shape.error().find("no_such_file.so"), std::string::npos) << shape.error();
}

}  // namespace
}  // namespace hapticd::test
