// SPDX-License-Identifier: MIT
#include "record/layout.hpp"

#include <cstring>
#include <nlohmann/json.hpp>

#include "record/hdf5.hpp"

namespace hapticd::record {

namespace {

constexpr uint64_t kFirstObject = 1024;
constexpr uint64_t kPage = 4096;
constexpr uint64_t kTableSlot = 256;  ///< [bytes] size of a slot for a table header, so that none crosses a page

uint64_t aligned(uint64_t address, uint64_t to) {
  return (address + to - 1) / to * to;
}

/// Writes `part` at `address` of the file.
void place(std::string& file, uint64_t address, const std::string& part) {
  if (file.size() < address + part.size()) file.resize(address + part.size(), '\0');
  std::memcpy(file.data() + address, part.data(), part.size());
}

/// Appends `part` at the next multiple of eight.
uint64_t append(std::string& file, const std::string& part) {
  const uint64_t address = aligned(file.size(), 8);
  place(file, address, part);
  return address;
}

void placeHeader(std::string& file, const std::vector<StreamSpec>& streams, const std::vector<uint32_t>& chunk_rows,
                 bool ring, uint64_t about_address, uint64_t about_bytes) {
  FileHeader header;
  std::strncpy(header.magic, kRecordingFormat, sizeof header.magic - 1);
  header.stream_count = static_cast<uint32_t>(streams.size());
  header.ring = ring ? 1 : 0;
  header.about_address = about_address;
  header.about_bytes = about_bytes;
  header.blocks_address = file.size();
  for (size_t i = 0; i < streams.size(); ++i) {
    std::strncpy(header.streams[i].name, streams[i].name.c_str(), sizeof header.streams[i].name - 1);
    header.streams[i].row_bytes = streams[i].layout.rowBytes();
    header.streams[i].chunk_rows = chunk_rows[i];
  }
  std::memcpy(file.data() + kHeaderAt, &header, sizeof header);
}

}  // namespace

Skeleton makeSkeleton(const std::vector<StreamSpec>& streams, const std::vector<uint32_t>& chunk_rows,
                      const About& about, bool ring) {
  Skeleton skeleton;
  std::string& file = skeleton.bytes;
  file.assign(kFirstObject, '\0');
  for (size_t i = 0; i < streams.size(); ++i) skeleton.tables.push_back(kFirstObject + i * kTableSlot);
  file.resize(kFirstObject + streams.size() * kTableSlot, '\0');
  std::vector<hdf5::Link> links;
  for (size_t i = 0; i < streams.size(); ++i) {
    const std::string description = hdf5::tableDescription(streams[i].layout);
    skeleton.descriptions.push_back(append(file, description));
    skeleton.description_bytes.push_back(description.size());
    hdf5::TableHeader table;
    table.chunk_rows = chunk_rows[i];
    table.row_bytes = streams[i].layout.rowBytes();
    table.description_address = skeleton.descriptions[i];
    table.description_bytes = description.size();
    place(file, skeleton.tables[i], table.bytes());
    links.push_back({streams[i].name, skeleton.tables[i]});
  }
  uint64_t about_address = 0;
  for (const auto& [name, text] : {std::pair{"about", &about.json}, std::pair{"scene", &about.scene}}) {
    const std::string padded = text->empty() ? std::string(1, '\0') : *text;
    const uint64_t address = append(file, padded);
    if (std::strcmp(name, "about") == 0) about_address = address;
    links.push_back({name, append(file, hdf5::textDataset(address, padded.size()))});
  }
  skeleton.root = append(file, hdf5::group(links, {{"format", kRecordingFormat}}));
  file.resize(aligned(file.size(), kPage), '\0');
  placeHeader(file, streams, chunk_rows, ring, about_address, about.json.size());
  place(file, 0, hdf5::superblock(skeleton.root, file.size()));
  return skeleton;
}

std::string columnsJson(const std::vector<StreamSpec>& streams) {
  auto json = nlohmann::ordered_json::object();
  for (const StreamSpec& stream : streams) {
    auto& list = json[stream.name] = nlohmann::ordered_json::array();
    for (const Column& column : stream.layout.columns())
      list.push_back({{"name", column.name},
                      {"type", kTypeNames[static_cast<size_t>(column.type)]},
                      {"offset", column.offset},
                      {"unit", column.unit},
                      {"doc", column.doc}});
  }
  return json.dump();
}

}  // namespace hapticd::record
