// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "host/device_instance.hpp"
#include "host/shape_instance.hpp"

namespace hapticd::host {
namespace {

const std::filesystem::path kGoodModules = TEST_MODULES "/good", kBadModules = TEST_MODULES "/bad";

scene::Value real(const std::string& id, uint32_t index, double number) {
  scene::Value value;
  value.id = id;
  value.index = index;
  value.kind = HSP_REAL;
  value.number = number;
  return value;
}

scene::Value text(const std::string& id, uint32_t index, const std::string& given) {
  scene::Value value;
  value.id = id;
  value.index = index;
  value.kind = HSP_TEXT;
  value.text = given;
  value.place = {"scene.yaml", 7, 3};
  return value;
}

scene::Model model(const std::string& plugin = "test_shape") {
  scene::Model described;
  described.name = "ball";
  described.plugin = plugin;
  described.library = kGoodModules / (plugin + ".so");
  return described;
}

scene::Device device() {
  scene::Device described;
  described.name = "arm";
  described.module = "test_device";
  described.library = kGoodModules / "test_device.so";
  return described;
}

bool contains(const std::string& whole, const std::string& part) {
  return whole.find(part) != std::string::npos;
}

hsp_contact touch(ShapeInstance& shape, double x) {
  hsp_probe probe{};
  probe.position[0] = x;
  hsp_contact contact{};
  hsp_step step{};
  step.struct_size = sizeof step;
  step.count = 1;
  step.in = &probe;
  step.out = &contact;
  step.in_stride = sizeof probe;
  step.out_stride = sizeof contact;
  EXPECT_EQ(shape.step(step), HSP_OK);
  return contact;
}

TEST(ShapeInstance, SetsParametersActivatesAndSteps) {
  scene::Model described = model();
  described.parameters = {real("stiffness", 1, 100)};
  auto shape = ShapeInstance::create(described, nullptr);
  ASSERT_TRUE(shape) << shape.error();
  hsp_activation activation{};
  activation.struct_size = sizeof activation;
  ASSERT_TRUE((*shape)->activate(activation));
  EXPECT_EQ((*shape)->report().max_stiffness, 100);
  EXPECT_EQ((*shape)->surfaces(), nullptr);
  EXPECT_EQ(touch(**shape, 0.5).force[0], 50);
  EXPECT_FALSE((*shape)->activate(activation));
  (*shape)->deactivate();
  EXPECT_FALSE((*shape)->active());
}

TEST(ShapeInstance, SaysWhereAParameterThatThePluginRefusesStands) {
  scene::Model described = model();
  described.parameters = {text("stiffness", 1, "soft")};
  const auto shape = ShapeInstance::create(described, nullptr);
  ASSERT_FALSE(shape);
  EXPECT_TRUE(contains(shape.error(), "model 'ball': scene.yaml:7:3: stiffness: refused: ")) << shape.error();
  described.parameters = {real("unheard_of", 99, 1)};
  EXPECT_FALSE(ShapeInstance::create(described, nullptr));
}

TEST(ShapeInstance, PassesOnWhyActivationFailed) {
  scene::Model described = model();
  described.parameters = {text("label", 7, "refuse")};
  auto shape = ShapeInstance::create(described, nullptr);
  ASSERT_TRUE(shape) << shape.error();
  const auto activated = (*shape)->activate(hsp_activation{});
  ASSERT_FALSE(activated);
  EXPECT_TRUE(contains(activated.error(), "the label is \"refuse\"")) << activated.error();
  EXPECT_FALSE((*shape)->active());
}

TEST(ShapeInstance, RefusesClaimsThatAreNoBounds) {
  scene::Model described = model();
  described.parameters = {text("label", 7, "nonsense")};
  auto shape = ShapeInstance::create(described, nullptr);
  ASSERT_TRUE(shape);
  EXPECT_FALSE((*shape)->activate(hsp_activation{}));
  EXPECT_FALSE((*shape)->active());
}

TEST(ShapeInstance, RefusesAnExtensionWithoutItsFunctions) {
  scene::Model described = model();
  described.parameters = {text("label", 7, "hollow")};
  auto shape = ShapeInstance::create(described, nullptr);
  ASSERT_TRUE(shape) << shape.error();
  const auto active = (*shape)->activate(hsp_activation{});
  ASSERT_FALSE(active);
  EXPECT_TRUE(contains(active.error(), "its extension hsp.surfaces/1 lacks a function")) << active.error();
}

TEST(ShapeInstance, RunsAPluginOfASmallerMinorVersion) {
  scene::Model described = model("small_minor");
  described.parameters = {real("depth", 0, 0.25)};
  auto shape = ShapeInstance::create(described, nullptr);
  ASSERT_TRUE(shape) << shape.error();
  ASSERT_TRUE((*shape)->activate(hsp_activation{}));
  EXPECT_EQ((*shape)->surfaces(), nullptr);
  EXPECT_EQ(touch(**shape, 0).depth_m, 0.25);
}

TEST(ShapeInstance, ExplainsAMissingOrWrongLibrary) {
  scene::Model described = model();
  described.library = kGoodModules / "not_there.so";
  auto missing = ShapeInstance::create(described, nullptr);
  ASSERT_FALSE(missing);
  EXPECT_TRUE(contains(missing.error(), "No such file or directory")) << missing.error();
  described.library = kGoodModules / "test_device.so";
  EXPECT_FALSE(ShapeInstance::create(described, nullptr));
  described = model();
  described.plugin = "something_else";
  const auto other = ShapeInstance::create(described, nullptr);
  ASSERT_FALSE(other);
  EXPECT_TRUE(contains(other.error(), "has no plugin named 'something_else'")) << other.error();
}

TEST(Library, IsTheSameForEveryUserAndEverySpelling) {
  auto a = Library::open(kGoodModules / "test_shape.so"),
       b = Library::open(kGoodModules / ".." / "good" / "test_shape.so");
  ASSERT_TRUE(a);
  ASSERT_TRUE(b);
  EXPECT_EQ(a->get(), b->get());
}

TEST(DeviceInstance, OpensStartsReadsAndStops) {
  auto arm = DeviceInstance::create(device(), nullptr);
  ASSERT_TRUE(arm) << arm.error();
  EXPECT_EQ((*arm)->kinematics().joint_count, 2u);
  EXPECT_FALSE((*arm)->start(hdv_start{}));
  ASSERT_TRUE((*arm)->open());
  EXPECT_STREQ((*arm)->info().product, "test arm");
  ASSERT_TRUE((*arm)->start(hdv_start{}));
  hdv_sample sample{};
  EXPECT_EQ((*arm)->read(5, sample), HSP_OK);
  EXPECT_EQ(sample.time_ns, 5u);
  EXPECT_EQ((*arm)->write(5, hdv_command{}), HSP_OK);
  (*arm)->stop();
  EXPECT_LT((*arm)->read(6, sample), 0);
}

TEST(DeviceInstance, PassesOnWhyTheHardwareCannotBeOpened) {
  scene::Device described = device();
  described.parameters = {real("gain", 0, 0)};
  auto arm = DeviceInstance::create(described, nullptr);
  ASSERT_TRUE(arm) << arm.error();
  const auto opened = (*arm)->open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error(), "device 'arm': cannot be opened: no arm on the bus");
}

}  // namespace
}  // namespace hapticd::host
