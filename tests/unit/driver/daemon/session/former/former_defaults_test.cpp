// SPDX-License-Identifier: MIT
#include "session/replay/former_defaults.hpp"

#include <gtest/gtest.h>

#include "hapticd/abi.h"

namespace hapticd::servo {
namespace {

constexpr const char* kRigid = "org.hapticd.shape.nurbs_rigid";

scene::Model modelOf(const std::string& geometry) {
  scene::Model model;
  scene::Value& value = model.parameters.emplace_back();
  value.id = "geometry";
  value.kind = HSP_PATH;
  value.text = geometry;
  return model;
}

TEST(FormerDefaults, ContactsOfOldRecordingsAreNotHeld) {
  for (const char* plugin : {kRigid, "org.hapticd.shape.pendulum", "org.hapticd.shape.push_button"}) {
    scene::Model model = modelOf("/models/teapot.yaml");
    useFormerDefaults(model, plugin, "1.0");
    ASSERT_EQ(model.parameters.size(), 2u) << plugin;
    EXPECT_EQ(model.parameters[1].id, "contact_hysteresis");
    EXPECT_EQ(model.parameters[1].index, 6u);  // as in the table of the plugin
    EXPECT_EQ(model.parameters[1].number, 0);
  }
}

TEST(FormerDefaults, NewRecordingsPartsAndGivenValuesAreLeftAlone) {
  scene::Model model = modelOf("/models/teapot.yaml"), part = modelOf("/models/bracket.hpart"), given = model;
  useFormerDefaults(model, kRigid, "1.1");
  EXPECT_EQ(model.parameters.size(), 1u);
  useFormerDefaults(model, "org.example.other", "1.0");
  EXPECT_EQ(model.parameters.size(), 1u);
  useFormerDefaults(part, kRigid, "1.0");
  EXPECT_EQ(part.parameters.size(), 1u);
  scene::Value& hold = given.parameters.emplace_back();
  hold.id = "hold";  // its name then
  hold.index = 6;
  hold.kind = HSP_REAL;
  hold.number = 0.005;
  useFormerDefaults(given, kRigid, "1.0");
  ASSERT_EQ(given.parameters.size(), 2u);
  EXPECT_EQ(given.parameters[1].number, 0.005);
}

}  // namespace
}  // namespace hapticd::servo
