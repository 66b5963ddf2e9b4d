// SPDX-License-Identifier: MIT
#include "layout.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "layout_rule.hpp"

extern "C" const layout_member* layout_of_c(size_t* count);

namespace hapticd::test {
namespace {

std::string textOf(const layout_member* members, size_t count) {
  std::string text;
  for (size_t i = 0; i < count; ++i) {
    const layout_member& m = members[i];
    text += m.name[0] == '\0'
                ? std::string(m.struct_name) + "\n"
                : "  " + std::string(m.name) + " " + std::to_string(m.offset) + " " + std::to_string(m.size) + "\n";
  }
  return text;
}

std::string fileText(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

const std::string kGolden = HAPTICD_SOURCE_DIR "/tests/abi/golden/abi-1.txt";

/// After a member was added at the end of a struct, on purpose: HAPTICD_UPDATE_GOLDEN=1 ctest -R abi_layout
void updateOnRequest(const std::string& now) {
  if (std::getenv("HAPTICD_UPDATE_GOLDEN") == nullptr) return;
  if (!brokenPromise(parseLayout(fileText(kGolden)), parseLayout(now)).empty()) return;
  std::ofstream(kGolden) << "# Offset and size in bytes of every member, on 64-bit machines. Lines are added at the "
                            "end of a struct, never changed.\n"
                         << now;
}

TEST(Layout, EveryByteOfEveryStructBelongsToANamedMember) {
  const layout_member* whole = nullptr;
  unsigned end = 0;
  for (size_t i = 0; i <= layout_count(); ++i) {
    const bool next_struct = i == layout_count() || kLayout[i].name[0] == '\0';
    if (next_struct && whole != nullptr) {
      EXPECT_EQ(end, whole->size) << whole->struct_name << ": a member is missing in layout.inc, or there is padding";
    }
    if (i == layout_count()) break;
    if (next_struct) {
      whole = &kLayout[i];
      end = 0;
    } else {
      EXPECT_EQ(kLayout[i].offset, end) << kLayout[i].struct_name << "." << kLayout[i].name;
      end = kLayout[i].offset + kLayout[i].size;
    }
  }
}

TEST(Layout, IsTheSameInCAndInCpp) {
  size_t count = 0;
  const layout_member* in_c = layout_of_c(&count);
  EXPECT_EQ(textOf(in_c, count), textOf(kLayout, layout_count()));
}

TEST(Layout, KeepsEveryLineOfTheGoldenFile) {
  const std::string now = textOf(kLayout, layout_count());
  updateOnRequest(now);
  const Layout golden = parseLayout(fileText(kGolden));
  ASSERT_FALSE(golden.empty()) << kGolden;
  EXPECT_EQ(brokenPromise(golden, parseLayout(now)), "");
}

TEST(Layout, HasNothingThatTheGoldenFileDoesNotGuard) {
  std::string guarded;
  for (const auto& [name, members] : parseLayout(fileText(kGolden))) {
    guarded += name + "\n";
    for (const std::string& member : members) guarded += "  " + member + "\n";
  }
  EXPECT_EQ(guarded, textOf(kLayout, layout_count()))
      << "added on purpose? HAPTICD_UPDATE_GOLDEN=1 ctest -R abi_layout";
}

TEST(LayoutRule, AllowsOnlyNewMembersAtTheEndAndNewStructs) {
  const Layout old = parseLayout("hsp_step\n  a 0 4\n  b 4 4\nhsp_pose\n  x 0 8\n");
  const auto broken = [&](const char* text) { return brokenPromise(old, parseLayout(text)); };
  EXPECT_EQ(broken("hsp_step\n  a 0 4\n  b 4 4\n  c 8 8\nhsp_pose\n  x 0 8\nhsp_new\n  y 0 1\n"), "");
  EXPECT_EQ(broken("hsp_step\n  b 0 4\n  a 4 4\nhsp_pose\n  x 0 8\n"), "hsp_step: was 'a 0 4', is 'b 0 4'");
  EXPECT_EQ(broken("hsp_step\n  a 0 4\n  c 4 4\n  b 8 4\nhsp_pose\n  x 0 8\n"), "hsp_step: was 'b 4 4', is 'c 4 4'");
  EXPECT_EQ(broken("hsp_step\n  a 0 4\nhsp_pose\n  x 0 8\n"), "hsp_step: lost 'b 4 4'");
  EXPECT_EQ(broken("hsp_step\n  a 0 8\n  b 8 4\nhsp_pose\n  x 0 8\n"), "hsp_step: was 'a 0 4', is 'a 0 8'");
  EXPECT_EQ(broken("hsp_pose\n  x 0 8\n"), "hsp_step is gone");
  EXPECT_EQ(broken("hsp_step\n  a 0 4\n  b 4 4\nhsp_pose\n  x 0 8\n  y 8 8\n"), "hsp_pose must not grow");
}

/// Numbers that stand in compiled plugins and modules.
TEST(Layout, KeepsTheValuesOfItsConstants) {
  EXPECT_EQ(HSP_ABI_MAJOR, 1u);
  EXPECT_EQ(HSP_MAGIC, 0x31505348u);
  EXPECT_EQ(HDV_MAGIC, 0x31564448u);
  EXPECT_EQ(HDV_MAX_JOINTS, 16);
  const int statuses[] = {HSP_OK,      HSP_DEGRADED, HSP_E_ARG,         HSP_E_STATE,
                          HSP_E_NOMEM, HSP_E_IO,     HSP_E_UNSUPPORTED, HSP_E_NUMERIC};
  const int expected_statuses[] = {0, 1, -1, -2, -3, -4, -5, -6};
  for (size_t i = 0; i < std::size(statuses); ++i) EXPECT_EQ(statuses[i], expected_statuses[i]);
  const int kinds[] = {HSP_REAL, HSP_INT, HSP_BOOL, HSP_ENUM, HSP_PATH, HSP_TEXT, HSP_ARRAY, HSP_DATA};
  for (int i = 0; i < 8; ++i) EXPECT_EQ(kinds[i], i + 1);
  const unsigned bits[] = {HSP_P_LIVE, HSP_P_REQUIRED, HSP_P_SAFETY, HSP_P_ACCURACY};
  for (unsigned i = 0; i < 4; ++i) EXPECT_EQ(bits[i], 1u << i);
  const unsigned outs[] = {HSP_OUT_CONTACT, HSP_OUT_EDGE,     HSP_OUT_EVENT,     HSP_OUT_TRACED,    HSP_OUT_HELD,
                           HSP_OUT_WENT_IN, HSP_OUT_CAME_OUT, HSP_OUT_AT_LOWEST, HSP_OUT_AT_HIGHEST};
  for (unsigned i = 0; i < std::size(outs); ++i) EXPECT_EQ(outs[i], 1u << i);
  const unsigned flags[] = {HSP_IN_JUMP,       HSP_IN_INVALID, HSP_R_VELOCITY, HSP_R_MOVES,
                            HSP_R_ORIENTATION, HSP_C_MOVES,    HSP_C_DEFORMS};
  const unsigned expected_flags[] = {1, 2, 1, 2, 4, 1, 2};
  for (size_t i = 0; i < std::size(flags); ++i) EXPECT_EQ(flags[i], expected_flags[i]);
  const unsigned device[] = {HDV_C_VELOCITY,  HDV_C_TORQUE,      HDV_C_POSITION,   HDV_C_PACING,       HDV_C_WATCHDOG,
                             HDV_C_SIMULATED, HDV_C_CALIBRATION, HDV_C_UNVERIFIED, HDV_C_FORCE_ASSUMED};
  for (unsigned i = 0; i < std::size(device); ++i) EXPECT_EQ(device[i], 1u << i);
  const unsigned samples[] = {HDV_S_VELOCITY, HDV_S_TORQUE, HDV_S_CALIBRATED, HDV_S_FAULT, HDV_S_LOST};
  for (unsigned i = 0; i < 5; ++i) EXPECT_EQ(samples[i], 1u << i);
  EXPECT_EQ(HDV_OFF, 0);
  EXPECT_EQ(HDV_TORQUE, 1);
  EXPECT_EQ(HDV_POSITION, 2);
}

}  // namespace
}  // namespace hapticd::test
