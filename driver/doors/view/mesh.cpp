// SPDX-License-Identifier: MIT
#include "mesh.hpp"

#include <sys/stat.h>
#include <unistd.h>

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

/// Returns the value of `key` in the answer if it is a list of numbers, or nullptr if it is not.
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

constexpr size_t kMost = size_t{1} << 24;  ///< largest number of vertices, and of triangles, that a page draws

struct Counts {
  size_t vertices = 0, triangles = 0;
  bool normals = false, colours = false;
};

/// Returns what an answer says about its memory, or nothing if the numbers are impossible.
Counts countsOf(const Json& answer) {
  const auto count = [&](const char* key) {
    const auto it = answer.find(key);
    return it != answer.end() && it->is_number_unsigned() ? it->get<size_t>() : kMost + 1;
  };
  const auto has = [&](const char* key) {
    const auto it = answer.find(key);
    return it != answer.end() && *it == true;
  };
  const Counts counts{count("vertices"), count("triangles"), has("normals"), has("colours")};
  return counts.vertices <= kMost && counts.triangles <= kMost ? counts : Counts{};
}

/// Appends `count` bytes of the memory to `bytes`. Returns false if it has too few bytes. The memory is read and not
/// mapped, because this process would be killed if another process shortened it.
bool appendFrom(int memory, size_t count, std::string& bytes) {
  struct stat info{};
  if (memory < 0 || fstat(memory, &info) != 0 || info.st_size < static_cast<off_t>(count)) return false;
  const size_t head = bytes.size();
  bytes.resize(head + count);
  for (size_t got = 0; got < count;) {
    const ssize_t more = pread(memory, bytes.data() + head + got, count - got, static_cast<off_t>(got));
    if (more <= 0) return false;
    got += static_cast<size_t>(more);
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

Message meshMessage(const Json& answer, int memory) {
  const Counts counts = countsOf(answer);
  const size_t per_vertex = (counts.normals ? 6 : 3) + (counts.colours ? 1 : 0);
  const size_t numbers = per_vertex * counts.vertices + 3 * counts.triangles;
  const uint32_t flags = (counts.normals ? kHasNormals : 0) | (counts.colours ? kHasColours : 0);
  std::string bytes =
      headed(kMeshMessage, static_cast<uint32_t>(counts.vertices), static_cast<uint32_t>(counts.triangles), flags);
  if (counts.vertices == 0 || !appendFrom(memory, 4 * numbers, bytes)) return nullptr;
  return std::make_shared<const std::string>(std::move(bytes));
}

Message verticesMessage(const Json& answer, int memory, uint32_t model, uint32_t frame) {
  const Counts counts = countsOf(answer);
  std::string bytes = headed(kVerticesMessage + model, frame, static_cast<uint32_t>(counts.vertices), 0);
  if (counts.vertices == 0 || !appendFrom(memory, 12 * counts.vertices, bytes)) return nullptr;
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
