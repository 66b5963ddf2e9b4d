// SPDX-License-Identifier: MIT
#include "state.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace hapticd {
namespace {

constexpr uint32_t kMagic = 0x3153'4d48;          // "HMS1"
constexpr uint32_t kRelaxingMagic = 0x3253'4d48;  // "HMS2": each record ends with the relaxed displacement
constexpr double kFarthest = 1e3;                 ///< [m], [m/s] greatest displacement and rate in a valid state

struct Head {
  uint32_t magic, nodes;
  double bulge;
};
struct Record {
  uint64_t node;
  double x[4], v[4];
};
struct Relaxed {
  double y[4];
};

bool sound(const double (&values)[4]) {
  for (const double value : values)
    if (!(std::fabs(value) < kFarthest)) return false;
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

std::size_t recordSize(const Head& head) {
  return sizeof(Record) + (head.magic == kRelaxingMagic ? sizeof(Relaxed) : 0);
}

}  // namespace

std::vector<unsigned char> stateOf(const medial::Nodes& nodes, const medial::FeltSurface* surface) {
  const bool relaxing = surface != nullptr && surface->branches();
  std::vector<unsigned char> bytes;
  append(bytes, Head{relaxing ? kRelaxingMagic : kMagic, static_cast<uint32_t>(nodes.count()), nodes.bulge()});
  for (std::size_t i = 0; i < nodes.count(); ++i) {
    const bool relaxed = !relaxing || surface->relaxed(i).isZero(0);
    if (nodes.displacement(i).isZero(0) && nodes.rate(i).isZero(0) && relaxed) continue;
    Record record{i, {}, {}};
    Relaxed branch{};
    for (int k = 0; k < 4; ++k) {
      record.x[k] = nodes.displacement(i)[k];
      record.v[k] = nodes.rate(i)[k];
      if (relaxing) branch.y[k] = surface->relaxed(i)[k];
    }
    append(bytes, record);
    if (relaxing) append(bytes, branch);
  }
  return bytes;
}

bool isState(std::span<const unsigned char> bytes) {
  if (bytes.size() < sizeof(Head)) return false;
  const Head head = readAt<Head>(bytes, 0);
  const bool relaxing = head.magic == kRelaxingMagic;
  if ((head.magic != kMagic && !relaxing) || !(std::fabs(head.bulge) < kFarthest)) return false;
  if ((bytes.size() - sizeof(Head)) % recordSize(head) != 0) return false;
  for (std::size_t at = sizeof(Head); at < bytes.size(); at += recordSize(head)) {
    const auto record = readAt<Record>(bytes, at);
    if (record.node >= head.nodes || !sound(record.x) || !sound(record.v)) return false;
    if (relaxing && !sound(readAt<Relaxed>(bytes, at + sizeof(Record)).y)) return false;
  }
  return true;
}

bool restoreState(std::span<const unsigned char> bytes, medial::Nodes& nodes, medial::FeltSurface* surface) {
  if (!isState(bytes) || readAt<Head>(bytes, 0).nodes != nodes.count()) return false;
  const Head head = readAt<Head>(bytes, 0);
  for (std::size_t at = sizeof(Head); at < bytes.size(); at += recordSize(head)) {
    const auto record = readAt<Record>(bytes, at);
    nodes.place(record.node, Eigen::Vector4d(record.x), Eigen::Vector4d(record.v));
    if (surface == nullptr || !surface->branches()) continue;
    const bool said = head.magic == kRelaxingMagic;  // otherwise it counts as fully relaxed
    surface->setRelaxed(record.node, Eigen::Vector4d(said ? readAt<Relaxed>(bytes, at + sizeof(Record)).y : record.x));
  }
  nodes.setBulge(head.bulge);
  return true;
}

}  // namespace hapticd
