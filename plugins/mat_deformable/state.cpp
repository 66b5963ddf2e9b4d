#include "state.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace hapticd {
namespace {

constexpr uint32_t kMagic = 0x3153'4d48;  // "HMS1"
constexpr double kFarthest = 1e3;         ///< [m], [m/s] no node is farther or faster

struct Head {
  uint32_t magic, nodes;
  double bulge;
};
struct Record {
  uint64_t node;
  double x[4], v[4];
};

bool sound(const Record& record) {
  for (int k = 0; k < 4; ++k)
    if (!(std::fabs(record.x[k]) < kFarthest) || !(std::fabs(record.v[k]) < kFarthest)) return false;
  return true;
}

template <class T>
T readAt(std::span<const unsigned char> bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

template <class T>
void append(std::vector<unsigned char>& bytes, const T& value) {
  bytes.resize(bytes.size() + sizeof value);
  std::memcpy(bytes.data() + bytes.size() - sizeof value, &value, sizeof value);
}

}  // namespace

std::vector<unsigned char> stateOf(const medial::Nodes& nodes) {
  std::vector<unsigned char> bytes;
  append(bytes, Head{kMagic, static_cast<uint32_t>(nodes.count()), nodes.bulge()});
  for (std::size_t i = 0; i < nodes.count(); ++i) {
    if (nodes.displacement(i).isZero(0) && nodes.rate(i).isZero(0)) continue;
    Record record{i, {}, {}};
    for (int k = 0; k < 4; ++k) {
      record.x[k] = nodes.displacement(i)[k];
      record.v[k] = nodes.rate(i)[k];
    }
    append(bytes, record);
  }
  return bytes;
}

bool isState(std::span<const unsigned char> bytes) {
  if (bytes.size() < sizeof(Head) || (bytes.size() - sizeof(Head)) % sizeof(Record) != 0) return false;
  const Head head = readAt<Head>(bytes, 0);
  if (head.magic != kMagic || !(std::fabs(head.bulge) < kFarthest)) return false;
  for (std::size_t at = sizeof(Head); at < bytes.size(); at += sizeof(Record)) {
    const auto record = readAt<Record>(bytes, at);
    if (record.node >= head.nodes || !sound(record)) return false;
  }
  return true;
}

bool restoreState(std::span<const unsigned char> bytes, medial::Nodes& nodes) {
  if (!isState(bytes) || readAt<Head>(bytes, 0).nodes != nodes.count()) return false;
  for (std::size_t at = sizeof(Head); at < bytes.size(); at += sizeof(Record)) {
    const auto record = readAt<Record>(bytes, at);
    nodes.place(record.node, Eigen::Vector4d(record.x), Eigen::Vector4d(record.v));
  }
  nodes.setBulge(readAt<Head>(bytes, 0).bulge);
  return true;
}

}  // namespace hapticd
