// SPDX-License-Identifier: MIT
#include "mesh.hpp"

#include <bit>
#include <cstring>

namespace hapticd::view {

namespace {

static_assert(std::endian::native == std::endian::little, "messages are little-endian");

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof raw);
}

/// A list of numbers, or nullptr.
const Json* numbers(const Json& answer, const char* key) {
  const auto it = answer.find(key);
  return it != answer.end() && it->is_array() ? &*it : nullptr;
}

template <class T>
bool appendAll(std::string& bytes, const Json& list) {
  for (const Json& number : list) {
    if (!number.is_number()) return false;
    append(bytes, number.get<T>());
  }
  return true;
}

}  // namespace

std::string headed(uint32_t a, uint32_t b, uint32_t c, uint32_t d, size_t reserve) {
  std::string bytes;
  bytes.reserve(16 + reserve);
  for (const uint32_t word : {a, b, c, d}) append(bytes, word);
  return bytes;
}

Message meshMessage(const Json& answer) {
  const Json *xyz = numbers(answer, "xyz"), *normals = numbers(answer, "normals"),
             *corners = numbers(answer, "triangles");
  if (xyz == nullptr || corners == nullptr || xyz->size() % 3 != 0 || corners->size() % 3 != 0) return nullptr;
  const bool has_normals = normals != nullptr && normals->size() == xyz->size();
  std::string bytes =
      headed(kMeshMessage, static_cast<uint32_t>(xyz->size() / 3), static_cast<uint32_t>(corners->size() / 3),
             has_normals ? 1 : 0, 4 * (2 * xyz->size() + corners->size()));
  if (!appendAll<float>(bytes, *xyz)) return nullptr;
  if (has_normals && !appendAll<float>(bytes, *normals)) return nullptr;
  if (!appendAll<uint32_t>(bytes, *corners)) return nullptr;
  return std::make_shared<const std::string>(std::move(bytes));
}

Message verticesMessage(const Json& answer, uint32_t model) {
  const Json* xyz = numbers(answer, "xyz");
  if (xyz == nullptr || xyz->size() % 3 != 0) return nullptr;
  std::string bytes = headed(kVerticesMessage + model, answer.value("frame", uint32_t{0}),
                             static_cast<uint32_t>(xyz->size() / 3), 0, 4 * xyz->size());
  if (!appendAll<float>(bytes, *xyz)) return nullptr;
  return std::make_shared<const std::string>(std::move(bytes));
}

}  // namespace hapticd::view
