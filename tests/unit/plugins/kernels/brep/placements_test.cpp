// SPDX-License-Identifier: MIT
/// Which instances of a part are traced.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "kernels/brep/search/search.hpp"
#include "kernels/part/file.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;

/// The assembly as1: a plate, two brackets with bolts, a rod with nuts.
Model as1(const std::string& instance, const std::vector<std::string>& without) {
  std::ifstream in(HAPTICD_SOURCE_DIR "/config/models/as1.hpart", std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  ModelOptions options;
  options.instance = instance;
  options.without = without;
  return Model(readPart(std::as_bytes(std::span(bytes)), "as1"), options);
}

/// An instance and what is left without it are the whole, each at its place: of any point the nearer foot of the two is
/// that of the whole, and it is of the same face.
TEST(Placements, AnInstanceAndTheRestAreTheWhole) {
  const std::vector<std::string> moving = {"rod-assembly_1", "as1/l-bracket-assembly_2/l-bracket_1"};
  const Model whole = as1("", {}), rod = as1(moving[0], {}), bracket = as1(moving[1], {}), rest = as1("", moving);
  EXPECT_EQ(rod.placements().size() + bracket.placements().size() + rest.placements().size(),
            whole.placements().size());
  Search of_whole(whole), of_rod(rod), of_bracket(bracket), of_rest(rest);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(-0.2, 1.2);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d p = whole.bounds().min() +
                       Vector3d(share(random), share(random), share(random)).cwiseProduct(whole.bounds().sizes());
    const double nearest =
        std::min({of_rod.nearest(p).hit.d2, of_bracket.nearest(p).hit.d2, of_rest.nearest(p).hit.d2});
    EXPECT_DOUBLE_EQ(of_whole.nearest(p).hit.d2, nearest);
  }
}

TEST(Placements, AnAssemblyCanBeTakenWithoutOneOfItsParts) {
  const Model rod = as1("rod-assembly_1", {"rod_1"});
  EXPECT_EQ(rod.placements().size() + 1, as1("rod-assembly_1", {}).placements().size());
}

TEST(Placements, SaysWhichNameCannotBeLeftOut) {
  const auto refusal = [](const std::string& instance, const std::vector<std::string>& without) -> std::string {
    try {
      as1(instance, without);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_TRUE(refusal("", {"engine"}).starts_with("without: there is no 'engine', expected one of as1"))
      << refusal("", {"engine"});
  EXPECT_TRUE(refusal("", {"nut_3"}).starts_with("without: several are named 'nut_3', expected one of their paths "));
  EXPECT_EQ(refusal("", {"as1"}), "without: leaves out everything, expected some of the instances");
  EXPECT_EQ(refusal("plate_1", {"rod_1"}), "without: 'rod_1' is not in 'plate_1', from which it is to be left out");
}

}  // namespace
}  // namespace hapticd::brep
