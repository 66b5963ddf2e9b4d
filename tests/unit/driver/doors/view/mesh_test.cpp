// SPDX-License-Identifier: MIT
#include "mesh.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace hapticd::view {
namespace {

template <class T>
T at(const std::string& bytes, size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

TEST(MeshMessage, KeepsEveryNumber) {
  const Json answer = {{"ok", true}, {"xyz", {0.5, 1, 2, 3, 4, 5, 6, 7, 8}}, {"triangles", {0, 1, 2}}};
  const Message message = meshMessage(answer);
  ASSERT_NE(message, nullptr);
  ASSERT_EQ(message->size(), 16u + 9 * 4 + 3 * 4);
  EXPECT_EQ(at<uint32_t>(*message, 0), kMeshMessage);
  EXPECT_EQ(at<uint32_t>(*message, 4), 3u);
  EXPECT_EQ(at<uint32_t>(*message, 8), 1u);
  EXPECT_EQ(at<uint32_t>(*message, 12), 0u);
  EXPECT_EQ(at<float>(*message, 16), 0.5f);
  EXPECT_EQ(at<float>(*message, 16 + 8 * 4), 8.0f);
  EXPECT_EQ(at<uint32_t>(*message, 16 + 9 * 4 + 2 * 4), 2u);
}

TEST(MeshMessage, BringsNormalsWhereThereAreAsManyAsVertices) {
  Json answer = {{"xyz", {0, 0, 0}}, {"normals", {0, 1, 0}}, {"triangles", Json::array()}};
  EXPECT_EQ(at<uint32_t>(*meshMessage(answer), 12), 1u);
  EXPECT_EQ(at<float>(*meshMessage(answer), 16 + 4 * 4), 1.0f);
  answer["normals"] = {0, 1};
  EXPECT_EQ(at<uint32_t>(*meshMessage(answer), 12), 0u);
}

TEST(MeshMessage, IsNoneOfWhatIsNoMesh) {
  for (const char* text :
       {R"({})", R"({"xyz":[1,2],"triangles":[]})", R"({"xyz":[1,2,"3"],"triangles":[]})",
        R"({"xyz":[1,2,3],"triangles":[0,0]})", R"({"xyz":{},"triangles":[]})", R"({"xyz":[1,2,3]})"})
    EXPECT_EQ(meshMessage(Json::parse(text)), nullptr) << text;
}

TEST(VerticesMessage, NamesModelAndFrame) {
  const Message message = verticesMessage({{"ok", true}, {"frame", 7}, {"xyz", {1, 2, 3}}}, 5);
  ASSERT_NE(message, nullptr);
  EXPECT_EQ(at<uint32_t>(*message, 0), kVerticesMessage + 5);
  EXPECT_EQ(at<uint32_t>(*message, 4), 7u);
  EXPECT_EQ(at<uint32_t>(*message, 8), 1u);
  EXPECT_EQ(at<float>(*message, 16 + 8), 3.0f);
  EXPECT_EQ(verticesMessage({{"ok", true}, {"frame", 7}}, 5), nullptr);
}

}  // namespace
}  // namespace hapticd::view
