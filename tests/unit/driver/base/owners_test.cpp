// SPDX-License-Identifier: MIT
/// Tests what is kept about the owners of models. A scene may have thousands of models.
#include <gtest/gtest.h>

#include <ctime>
#include <string>

#include "base/call_name.hpp"
#include "base/code_owner.hpp"
#include "base/owner_file.hpp"

namespace hapticd {
namespace {

double processorTime() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// [s] of each of so many owners that are kept with their place and file.
double keepMany(int count, const std::string& kind) {
  const double begun = processorTime();
  for (int i = 0; i < count; ++i) {
    const Owner* owner = ownerOf(kind, "m" + std::to_string(i));
    setPlaceOfOwner(owner, "scene.yaml:" + std::to_string(i));
    setFileOfOwner(owner, {kind + ".so", "8 bytes of " + kind, false});
  }
  return (processorTime() - begun) / count;
}

TEST(Owners, EachOfThousandsIsKeptInTheTimeOfOneAmongFew) {
  const double few = keepMany(2000, "few"), many = keepMany(32000, "many");
  EXPECT_LT(many, 5 * few) << "it took 15 times as long where each was looked for in a list of all";
}

TEST(Owners, ThePlaceAndTheFileThatWereKeptLastCount) {
  const Owner* owner = ownerOf("torus", "ring");
  EXPECT_EQ(ownerOf("torus", "ring"), owner);
  EXPECT_NE(ownerOf("torus", "ring", true), owner) << "a device of these names is another";
  EXPECT_NE(ownerOf("tor", "usring"), owner);
  EXPECT_STREQ(placeOf(owner), "");
  EXPECT_STREQ(fileOf(owner), "");
  EXPECT_STREQ(pathOf(owner), "");
  for (const char* place : {"a.yaml:4", "b.yaml:5", "b.yaml:5", "a.yaml:4"}) {
    setPlaceOfOwner(owner, place);
    EXPECT_STREQ(placeOf(owner), place);
    setFileOfOwner(owner, {"torus.so", place, true});
    EXPECT_STREQ(fileOf(owner), place);
    EXPECT_STREQ(pathOf(owner), "torus.so");
  }
  EXPECT_EQ(foreignOwner(0), owner);
  EXPECT_EQ(foreignOwner(1), nullptr);
}

}  // namespace
}  // namespace hapticd
