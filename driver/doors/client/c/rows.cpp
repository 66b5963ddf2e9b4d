// SPDX-License-Identifier: MIT
/// Rows of the black box. The writer stores the words of a row with release order, and then the count of rows. A row
/// that was copied is valid if the writer did not overwrite its place in the ring meanwhile.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "internal.hpp"
#include "record/layout.hpp"

namespace hapticd::client {

namespace {

uint64_t load(uint64_t& word, std::memory_order order) {
  return std::atomic_ref<uint64_t>(word).load(order);
}

const char* kept(Stream& stream, const nlohmann::json& column, const char* key) {
  return stream.texts.emplace_back(column.at(key).get<std::string>()).c_str();
}

}  // namespace

Result<RowFile> RowFile::open(const std::string& file) {
  const int fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return Error{"cannot read " + file + ": " + std::strerror(errno)};
  RowFile rows;
  rows.memory_ = Mapping(fd, 0, PROT_READ);
  struct stat info{};
  if (fstat(fd, &info) == 0) rows.device_ = info.st_dev, rows.inode_ = info.st_ino;
  close(fd);
  if (rows.memory_.data() == nullptr) return Error{"cannot map " + file};
  if (auto read = rows.readStreams(); !read) return Error{file + ": " + read.error()};
  try {
    if (auto read = rows.readAbout(); !read) return Error{file + ": " + read.error()};
  } catch (const std::exception& error) {
    return Error{file + ": its description cannot be read: " + error.what()};
  }
  return rows;
}

Result<void> RowFile::readStreams() {
  auto* shared = reinterpret_cast<record::FileHeader*>(memory_.at(record::kHeaderAt, sizeof(record::FileHeader)));
  if (shared == nullptr) return Error{"is not a black box of a daemon of this version"};
  record::FileHeader header;  // checked and used as it is now: another process may change the memory meanwhile
  std::memcpy(&header, shared, sizeof header);
  if (std::strncmp(header.magic, record::kRecordingFormat, sizeof header.magic) != 0 || header.ring != 1 ||
      header.stream_count > record::kMaxStreams)
    return Error{"is not a black box of a daemon of this version"};
  const auto* about = reinterpret_cast<const char*>(memory_.at(header.about_address, header.about_bytes));
  if (about == nullptr) return Error{"ends inside its description: it is incomplete or damaged"};
  about_.assign(about, header.about_bytes);
  for (uint32_t i = 0; i < header.stream_count; ++i) {
    const record::StreamHeader& stream = header.streams[i];
    if (stream.row_bytes == 0 || stream.row_bytes % 8 != 0 || stream.row_bytes > record::kMaxRowBytes)
      return Error{"has rows of an impossible size: it is damaged"};
    Stream& known = streams_.emplace_back();
    known.name.assign(stream.name, strnlen(stream.name, sizeof stream.name));
    known.written = &shared->streams[i].rows;
    known.row_words = stream.row_bytes / 8;
  }
  return readBlocks(header.blocks_address);
}

Result<void> RowFile::readBlocks(uint64_t place) {
  while (const std::byte* at = memory_.at(place, sizeof(record::BlockHeader))) {
    record::BlockHeader block;
    std::memcpy(&block, at, sizeof block);
    std::byte* rows = memory_.at(place + sizeof block, block.bytes);
    if (block.magic != record::BlockHeader::kMagic || rows == nullptr || place % 8 != 0) break;
    if (block.stream < streams_.size()) {
      streams_[block.stream].rows = reinterpret_cast<uint64_t*>(rows);
      streams_[block.stream].capacity = block.bytes / 8 / streams_[block.stream].row_words;
    }
    place += sizeof block + block.bytes;
  }
  const bool whole = std::all_of(streams_.begin(), streams_.end(), [](const Stream& s) { return s.capacity >= 2; });
  return whole ? Result<void>() : Result<void>(Error{"has no room for rows: it is damaged"});
}

Result<void> RowFile::readAbout() {
  const auto json = nlohmann::json::parse(about_);
  for (const auto& device : json.at("devices")) devices_.push_back(device.at("name"));
  period_ = static_cast<int64_t>(1e9 / json.at("rate_hz").get<double>());
  for (Stream& stream : streams_) {
    for (const auto& column : json.at("columns").at(stream.name)) {
      hapticd_column known{};
      known.name = kept(stream, column, "name");
      known.unit = kept(stream, column, "unit");
      known.doc = kept(stream, column, "doc");
      std::strncpy(known.type, column.at("type").get<std::string>().c_str(), sizeof known.type - 1);
      known.offset = column.at("offset");
      const auto type = record::typeOf(known.type);
      if (known.offset > stream.row_words * 8 ||
          (type ? record::bytesOf(*type) : 0) > stream.row_words * 8 - known.offset)
        return Error{"has a column outside its row: it is damaged"};
      stream.columns.push_back(known);
    }
  }
  return {};
}

bool RowFile::ended() const {
  auto* header = reinterpret_cast<record::FileHeader*>(memory_.at(record::kHeaderAt, sizeof(record::FileHeader)));
  return std::atomic_ref<uint32_t>(header->closed).load(std::memory_order_acquire) != 0;
}

uint64_t RowFile::written(const Stream& stream) {
  return load(*stream.written, std::memory_order_acquire);
}

long RowFile::read(const Stream& stream, uint64_t& row, void* rows, size_t most) {
  constexpr int kTries = 1000;  // the writer goes round its ring in seconds
  for (int i = 0; i < kTries; ++i) {
    const uint64_t end = written(stream), kept = stream.capacity - 1;  // the slot after the newest row is being written
    const uint64_t first = std::min(std::max(row, end > kept ? end - kept : 0), end);
    const uint64_t count = std::min<uint64_t>(most, end - first);
    auto* to = static_cast<std::byte*>(rows);
    for (uint64_t n = 0; n < count; ++n) {
      uint64_t* from = stream.rows + (first + n) % stream.capacity * stream.row_words;
      for (size_t word = 0; word < stream.row_words; ++word, to += 8) {
        const uint64_t value = load(from[word], std::memory_order_acquire);
        std::memcpy(to, &value, 8);
      }
    }
    // The rows were overwritten meanwhile: reads newer ones.
    if (count > 0 && written(stream) - first >= stream.capacity) continue;
    row = first + count;
    return static_cast<long>(count);
  }
  return 0;
}

}  // namespace hapticd::client

namespace {

hapticd::client::Stream* streamOf(hapticd_client* client, int stream) {
  auto& all = client->rows.streams();
  return stream >= 0 && static_cast<size_t>(stream) < all.size() ? &all[static_cast<size_t>(stream)] : nullptr;
}

}  // namespace

int hapticd_stream(hapticd_client* client, const char* name) {
  const auto& all = client->rows.streams();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& stream) { return stream.name == name; });
  return found != all.end() ? static_cast<int>(found - all.begin()) : -1;
}

long hapticd_columns(hapticd_client* client, int stream, const hapticd_column** columns, size_t* row_bytes) {
  const auto* found = streamOf(client, stream);
  if (found == nullptr) return -1;
  if (columns != nullptr) *columns = found->columns.data();
  if (row_bytes != nullptr) *row_bytes = found->row_words * 8;
  return static_cast<long>(found->columns.size());
}

uint64_t hapticd_written(hapticd_client* client, int stream) {
  const auto* found = streamOf(client, stream);
  return found != nullptr ? hapticd::client::RowFile::written(*found) : 0;
}

long hapticd_read(hapticd_client* client, int stream, uint64_t* row, void* rows, size_t most) {
  auto* found = streamOf(client, stream);
  if (found == nullptr) return -1;
  const long got = hapticd::client::RowFile::read(*found, *row, rows, most);
  std::atomic_ref<uint64_t> handed(found->handed);
  if (*row > handed.load(std::memory_order_relaxed))
    handed.store(*row, std::memory_order_relaxed);
  else if (client->ended())
    return -1;  // rows that were read before are not new
  return got;
}
