#include "mat_deformable/medial_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

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

std::string complaintOf(const std::string& text) {
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
  EXPECT_NE(complaintOf(good + "  radius: [[0.01, 0.02], [0.03]]\n  stiffness: 1\n").find("medial.radius[1]"),
            std::string::npos);
  EXPECT_NE(complaintOf(good + "  radius: 0.01\n  stiffness: -4\n").find(":5:"), std::string::npos);
  EXPECT_NE(complaintOf(good + "  radius: 0.01\n  stiffness: .nan\n").find("at least 0"), std::string::npos);
  EXPECT_NE(complaintOf(good + "  radius: 0.01\n").find("stiffness"), std::string::npos);
  EXPECT_NE(complaintOf(good + "  radius: 0.01\n  stiffness: 1\n  stifness: 2\n").find("unknown key"),
            std::string::npos);
  EXPECT_NE(complaintOf("format: hapticd-model/1\n").find("medial"), std::string::npos);
  EXPECT_NE(complaintOf(std::string(kHead) + "  points: [[[0, 0], [1, 1, 1]]]\n").find("[x, y, z]"), std::string::npos);
  EXPECT_NE(complaintOf(std::string(kHead) + "  points: 7\n").find("points"), std::string::npos);
  EXPECT_NE(complaintOf("[").find("not YAML"), std::string::npos);
}

}  // namespace
}  // namespace hapticd
