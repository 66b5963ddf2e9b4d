// SPDX-License-Identifier: MIT
#include "traced_shape/model_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

namespace hapticd {
namespace {

class ModelFileTest : public testing::Test {
 protected:
  std::string write(const std::string& text) {
    const std::string path = testing::TempDir() + "model_file_test.yaml";
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  std::string complaintOf(const std::string& text) {
    try {
      readModelFile(write(text));
    } catch (const ModelFileError& e) {
      return e.what();
    }
    return "";
  }
};

const std::string kSquare =
    "format: hapticd-model/1\n"
    "surfaces:\n"
    "  - name: floor\n"
    "    degree: [1, 1]\n"
    "    knots: [[0, 0, 1, 1], [0, 0, 1, 1]]\n"
    "    points: [[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0]]\n";

std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST_F(ModelFileTest, ReadsYamlAndTheSameAsJson) {
  const ModelFile yaml = readModelFile(write(kSquare + "    outward: reversed\n"));
  const ModelFile json = readModelFile(
      write(R"({"format": "hapticd-model/1", "surfaces": [{"name": "floor", "degree": [1, 1], "outward": "reversed",
             "knots": [[0, 0, 1, 1], [0, 0, 1, 1]], "points": [[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0]]}]})"));
  ASSERT_EQ(yaml.surfaces.size(), 1u);
  ASSERT_EQ(json.surfaces.size(), 1u);
  EXPECT_EQ(yaml.surfaces[0].points, json.surfaces[0].points);
  EXPECT_EQ(yaml.surfaces[0].knots, json.surfaces[0].knots);
  EXPECT_TRUE(yaml.surfaces[0].reversed && json.surfaces[0].reversed);
}

TEST_F(ModelFileTest, NamesThePluginForTheFileOfASoftBody) {
  const std::string soft = "format: hapticd-model/1\nmedial: {points: [[[0, 0, 0]]], radius: 0.01, stiffness: 300}\n";
  EXPECT_NE(complaintOf(soft).find("use plugin: mat_deformable"), std::string::npos) << complaintOf(soft);
}

/// Its size and format are not what is wrong with it.
TEST_F(ModelFileTest, SaysOnlyWhyAFileCannotBeRead) {
  try {
    readModelFile("/proc/self/mem");  // a regular file; no process has a page at its first byte
    ADD_FAILURE() << "was read";
  } catch (const ModelFileError& e) {
    EXPECT_NE(std::string(e.what()).find("cannot be read"), std::string::npos) << e.what();
    EXPECT_EQ(std::string(e.what()).find("expected a model file"), std::string::npos) << e.what();
  }
}

/// Two million numbers of YAML would take a gigabyte: refused before anything is parsed. As JSON they are read.
TEST_F(ModelFileTest, RefusesMoreYamlThanMemoryIsGoodFor) {
  std::string knots = "0, 0";
  while (knots.size() < (2u << 20)) knots += ", 0.5";
  const std::string yaml = with(kSquare, "[0, 0, 1, 1]", "[" + knots + ", 1, 1]");
  EXPECT_NE(complaintOf(yaml).find("larger than 2 MiB, the most for YAML"), std::string::npos)
      << complaintOf(yaml).substr(0, 200);
  const std::string json = "{\"format\": \"hapticd-model/1\", \"surfaces\": [{\"knots\": [[" + knots + "], []]}]}";
  EXPECT_EQ(complaintOf(json).find("larger"), std::string::npos);
  EXPECT_NE(complaintOf(json).find("degree"), std::string::npos) << complaintOf(json).substr(0, 200);
}

TEST_F(ModelFileTest, SaysWhereAndWhatIsWrong) {
  EXPECT_NE(
      complaintOf(with(kSquare, "[1, 0, 0]", "[1, .nan, 0]")).find(":6:40: surfaces[0].points[2][1]: .nan, expected a"),
      std::string::npos)
      << complaintOf(with(kSquare, "[1, 0, 0]", "[1, .nan, 0]"));
  EXPECT_NE(complaintOf(with(kSquare, "degree: [1, 1]", "degree: [1, 99]")).find("degree[1]"), std::string::npos);
  EXPECT_NE(complaintOf(with(kSquare, "knots:", "knotz:")).find("knotz: unknown key"), std::string::npos);
  EXPECT_NE(complaintOf(with(kSquare, "model/1", "model/9")).find("format"), std::string::npos);
  EXPECT_NE(complaintOf(with(kSquare, "[0, 0, 1, 1]]", "[0, 0, 1]]")).find("surfaces[0]"), std::string::npos);
  EXPECT_NE(complaintOf("surfaces: [").find(":1:"), std::string::npos);
}

TEST_F(ModelFileTest, ReadsStatedEdges) {
  const std::string edges = "edges:\n  - sides: [[floor, u1], [0, u0]]\n    flipped: true\n";
  const ModelFile file = readModelFile(write(kSquare + edges));
  ASSERT_EQ(file.edges.size(), 1u);
  EXPECT_EQ(file.edges[0].a.side, 1);
  EXPECT_EQ(file.edges[0].b.side, 0);
  EXPECT_TRUE(file.edges[0].flipped);
  EXPECT_NE(complaintOf(kSquare + with(edges, "u1", "w1")).find("edges[0].sides[0]"), std::string::npos);
}

TEST_F(ModelFileTest, TakesNamesThatAreNumbersAndRefusesThoseThatAreLists) {
  EXPECT_EQ(parseModelFile(with(kSquare, "name: floor", "name: 3.5"), "t.yaml").surfaces[0].name, "3.5");
  EXPECT_NE(complaintOf(with(kSquare, "name: floor", "name: [\"\\xff\", b]"))
                .find("surfaces[0].name: a list of 2, expected a text"),
            std::string::npos);
  EXPECT_NE(complaintOf(with(kSquare, "name: floor", "name: \xff")).find("a byte that is not text (code 255)"),
            std::string::npos);
  const std::string deep = std::string(500'000, '[') + std::string(500'000, ']');
  EXPECT_NE(
      complaintOf(R"({"format": "hapticd-model/1", "surfaces": [{"name": )" + deep + "}]}").find("expected a text"),
      std::string::npos);
}

TEST_F(ModelFileTest, RefusesAliasesThatMakeAShortFileAHugeTree) {
  std::string text = "a: &a [x, x, x, x, x, x, x, x, x]\n";
  for (char name = 'b'; name < 'h'; ++name) {
    text += std::string(1, name) + ": &" + name + " [*" + static_cast<char>(name - 1);
    for (int i = 0; i < 8; ++i) text += std::string(", *") + static_cast<char>(name - 1);
    text += "]\n";
  }
  EXPECT_NE(complaintOf(text).find("values (with aliases expanded)"), std::string::npos) << complaintOf(text);
}

TEST_F(ModelFileTest, SurvivesDamagedFiles) {
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    std::string text = kSquare;
    for (int change = 0; change < 3; ++change) text[random() % text.size()] = static_cast<char>(random() % 256);
    text.resize(text.size() - random() % 20);
    try {
      const ModelFile file = readModelFile(write(text));
      trace::Model model(file.surfaces);
    } catch (const std::exception&) {
    }
  }
  EXPECT_FALSE(complaintOf(std::string(100000, '[')).empty());
  EXPECT_THROW(readModelFile("/nowhere/at/all.yaml"), ModelFileError);
  EXPECT_THROW(readModelFile(std::filesystem::temp_directory_path().string()), ModelFileError);
}

}  // namespace
}  // namespace hapticd
