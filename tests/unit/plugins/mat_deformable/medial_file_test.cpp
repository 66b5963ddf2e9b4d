// SPDX-License-Identifier: MIT
#include "mat_deformable/medial_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "kernels/medial/layer.hpp"
#include "traced_shape/model_file.hpp"

namespace hapticd {
namespace {

class File {
 public:
  explicit File(const std::string& text)
      : path_(std::filesystem::temp_directory_path() / ("medial-" + std::to_string(::getpid()) + ".yaml")) {
    std::ofstream(path_) << text;
  }
  ~File() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

std::string complaintOfText(const std::string& text) {
  const File file(text);
  try {
    readMedialFile(file.path(), {});
  } catch (const ModelFileError& e) {
    return e.what();
  }
  return "";
}

constexpr const char* kHead = "format: hapticd-model/1\nmedial:\n";
constexpr const char* kPoints = "  points: [[[0, 0, 0], [0.1, 0, 0]], [[0, 0.1, 0], [0.1, 0.1, 0]]]\n";

TEST(MedialFile, ReadsGridsAndSingleNumbers) {
  const File file(std::string(kHead) + kPoints +
                  "  radius: [[0.01, 0.02], [0.03, 0.04]]\n  stiffness: 200\n  mass: 0.1\n");
  const medial::BodyData data = *readMedialFile(file.path(), {}).grid;
  EXPECT_EQ(data.grid.count, (std::array<int, 2>{2, 2}));
  EXPECT_EQ(data.grid.points[2], Eigen::Vector3d(0, .1, 0));
  EXPECT_EQ(data.grid.radius, (std::vector<double>{.01, .02, .03, .04}));
  EXPECT_EQ(data.stiffness, std::vector<double>(4, 200));
  EXPECT_EQ(data.mass, std::vector<double>(4, .1));
  EXPECT_TRUE(data.damping.empty());
}

TEST(MedialFile, ReadsTheSameFromJson) {
  const File file(R"({"format": "hapticd-model/1", "medial": {"points": [[[0, 0, 0], [0.1, 0, 0]]],
                      "radius": [[0.01, 0.02]], "stiffness": [[1, 2]]}})");
  EXPECT_EQ(readMedialFile(file.path(), {}).grid->grid.count, (std::array<int, 2>{1, 2}));
}

TEST(MedialFile, SaysWhereAndWhatIsWrong) {
  const std::string good = std::string(kHead) + kPoints;
  EXPECT_NE(complaintOfText(good + "  radius: [[0.01, 0.02], [0.03]]\n  stiffness: 1\n").find("medial.radius[1]"),
            std::string::npos);
  EXPECT_NE(complaintOfText(good + "  radius: 0.01\n  stiffness: -4\n").find(":5:"), std::string::npos);
  EXPECT_NE(complaintOfText(good + "  radius: 0.01\n  stiffness: .nan\n").find("at least 0"), std::string::npos);
  EXPECT_NE(complaintOfText(good + "  radius: 0.01\n").find("stiffness"), std::string::npos);
  EXPECT_NE(complaintOfText(good + "  radius: 0.01\n  stiffness: 1\n  stifness: 2\n").find("unknown key"),
            std::string::npos);
  EXPECT_NE(complaintOfText("format: hapticd-model/1\n").find("medial"), std::string::npos);
  EXPECT_NE(complaintOfText(std::string(kHead) + "  points: [[[0, 0], [1, 1, 1]]]\n").find("[x, y, z]"),
            std::string::npos);
  EXPECT_NE(complaintOfText(std::string(kHead) + "  points: 7\n").find("points"), std::string::npos);
  EXPECT_NE(complaintOfText("[").find("not YAML"), std::string::npos);
}

TEST(MedialFile, MaterialHasTheBoundsOfTheParameters) {
  const std::string good = std::string(kHead) + kPoints + "  radius: 0.01\n";
  EXPECT_NE(complaintOfText(good + "  stiffness: 1e9\n").find(":5:14: medial.stiffness: 1e9, expected at most 1e6 N/m"),
            std::string::npos);
  EXPECT_NE(
      complaintOfText(good + "  stiffness: 1\n  mass: 1e-300\n").find(":6:9: medial.mass: 1e-300, expected 0, or 1e-9"),
      std::string::npos);
  EXPECT_NE(complaintOfText(good + "  stiffness: 1\n  mass: [[0, 0], [0, 1e7]]\n").find("medial.mass[1][1]"),
            std::string::npos);
  EXPECT_EQ(complaintOfText(good + "  stiffness: 1e6\n  mass: 1e-9\n"), "");
}

TEST(MedialFile, DampsNoMoreThanTheHostIsTold) {
  const File file(std::string(kHead) + kPoints + "  radius: 0.01\n  stiffness: 200\n  damping: 1000\n");
  try {
    readMedialFile(file.path(), {300, .5, .01});
    FAIL() << "accepted";
  } catch (const ModelFileError& e) {
    EXPECT_NE(std::string(e.what()).find(":6:12: medial.damping: 1000, expected at most 5 N s/m"), std::string::npos)
        << e.what();
    EXPECT_NE(std::string(e.what()).find("set `damping` to 1000"), std::string::npos) << e.what();
  }
  EXPECT_TRUE(readMedialFile(file.path(), {300, 100, .01}).damps);
}

TEST(MedialFile, ElasticConstantsStandForTheStiffnessOfALayer) {
  Material tip;
  tip.tip = 4e-3;
  const std::string good = std::string(kHead) + kPoints + "  radius: 0.01\n";
  const File file(good + "  young: [[1e4, 2e4], [1e4, 1e4]]\n  poisson: 0.45\n  thickness: 0.02\n");
  const medial::BodyData data = *readMedialFile(file.path(), tip).grid;
  const double one = medial::layerStiffness({1e4, .45, .02}, 4e-3);
  ASSERT_EQ(data.stiffness.size(), 4u);
  EXPECT_NEAR(data.stiffness[0], one, 1e-9 * one);
  EXPECT_NEAR(data.stiffness[1], 2 * one, 1e-9 * one);
  EXPECT_NE(complaintOfText(good + "  young: 1e4\n").find("medial.poisson: this key is missing"), std::string::npos);
  EXPECT_NE(complaintOfText(good + "  young: 1e4\n  poisson: 0.6\n  thickness: 0.02\n")
                .find(":6:12: medial.poisson: 0.6, expected 0 to 0.5"),
            std::string::npos);
  EXPECT_NE(complaintOfText(good + "  young: 1e4\n  poisson: 0.4\n  thickness: 1e-5\n").find("a tenth of probe_radius"),
            std::string::npos);
  EXPECT_NE(complaintOfText(good + "  young: 1e4\n  poisson: 0.4\n  thickness: 0.02\n  stiffness: 3\n").find("either"),
            std::string::npos);
  EXPECT_NE(complaintOfText(good + "  stiffness: 3\n  poisson: 0.4\n").find("only together with young"),
            std::string::npos);
  EXPECT_NE(complaintOfText(good + "  young: 1e9\n  poisson: 0.5\n  thickness: 0.001\n").find("more than 1e6"),
            std::string::npos);
}

TEST(MedialFile, APipeIsRefusedAtOnce) {
  const std::filesystem::path pipe =
      std::filesystem::temp_directory_path() / ("pipe-" + std::to_string(::getpid()) + ".yaml");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(readMedialFile(pipe, {}), ModelFileError);
  std::filesystem::remove(pipe);
}

}  // namespace
}  // namespace hapticd
