// SPDX-License-Identifier: MIT
#include "mesh.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "base/sealed_memory.hpp"

namespace hapticd::view {
namespace {

template <class T>
T at(const std::string& bytes, size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// Memory as the daemon hands it out: f32 xyz, f32 normals, u32 corners.
Descriptor memoryOf(const std::vector<float>& places, const std::vector<uint32_t>& corners) {
  const auto shared = SealedMemory::create("test", 4 * (places.size() + corners.size()), SealedMemory::Writers::kOne);
  std::memcpy((*shared)->data(), places.data(), 4 * places.size());
  if (!corners.empty()) std::memcpy((*shared)->data() + 4 * places.size(), corners.data(), 4 * corners.size());
  auto descriptor = (*shared)->share();
  return std::move(*descriptor);
}

Json answerOf(size_t vertices, size_t triangles, bool normals) {
  return {{"ok", true}, {"bytes", 4096}, {"vertices", vertices}, {"triangles", triangles}, {"normals", normals}};
}

TEST(MeshMessage, KeepsEveryNumber) {
  const Descriptor memory = memoryOf({0.5f, 1, 2, 3, 4, 5, 6, 7, 8}, {0, 1, 2});
  const Message message = meshMessage(answerOf(3, 1, false), memory.get());
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

TEST(MeshMessage, BringsTheNormalsOfTheModel) {
  const Descriptor memory = memoryOf({0, 0, 0, 0, 1, 0}, {});
  const Message message = meshMessage(answerOf(1, 0, true), memory.get());
  ASSERT_NE(message, nullptr);
  EXPECT_EQ(at<uint32_t>(*message, 12), 1u);
  EXPECT_EQ(at<float>(*message, 16 + 4 * 4), 1.0f);
}

TEST(MeshMessage, BringsTheColoursOfTheModel) {
  const Descriptor memory = memoryOf({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2, 0xff0000ffu, 0, 0xff00ff00u});
  Json answer = answerOf(3, 1, false);
  answer["colours"] = true;
  const Message message = meshMessage(answer, memory.get());
  ASSERT_NE(message, nullptr);
  ASSERT_EQ(message->size(), 16u + 9 * 4 + 3 * 4 + 3 * 4);
  EXPECT_EQ(at<uint32_t>(*message, 12), kHasColours);
  EXPECT_EQ(at<uint32_t>(*message, 16 + 12 * 4), 0xff0000ffu);
  EXPECT_EQ(at<uint32_t>(*message, 16 + 14 * 4), 0xff00ff00u);
}

TEST(MeshMessage, IsNoneOfWhatIsNoMesh) {
  const Descriptor memory = memoryOf({0, 0, 0}, {});
  EXPECT_NE(meshMessage(answerOf(1, 0, false), memory.get()), nullptr);
  EXPECT_EQ(meshMessage(answerOf(1, 0, false), -1), nullptr);
  EXPECT_EQ(meshMessage(answerOf(100'000, 0, false), memory.get()), nullptr) << "more than the memory has";
  EXPECT_EQ(meshMessage(answerOf(size_t{1} << 62, 0, false), memory.get()), nullptr);
  EXPECT_EQ(meshMessage(answerOf(0, 0, false), memory.get()), nullptr);
  for (const char* text :
       {R"({})", R"({"vertices":1})", R"({"vertices":-1,"triangles":0})", R"({"vertices":"1","triangles":[]})"})
    EXPECT_EQ(meshMessage(Json::parse(text), memory.get()), nullptr) << text;
}

TEST(VerticesMessage, TakesThoseOfTheMemoryWithoutNormalsAndCorners) {
  const Descriptor memory = memoryOf({1, 2, 3, 0, 0, 1}, {0, 0, 0});
  const Message message = verticesMessage(answerOf(1, 1, true), memory.get(), 5, 9);
  ASSERT_NE(message, nullptr);
  ASSERT_EQ(message->size(), 16u + 3 * 4);
  EXPECT_EQ(at<uint32_t>(*message, 0), kVerticesMessage + 5);
  EXPECT_EQ(at<uint32_t>(*message, 4), 9u);
  EXPECT_EQ(at<float>(*message, 16 + 8), 3.0f);
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
