// SPDX-License-Identifier: MIT
#include "record/recording.hpp"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/regular_file.hpp"
#include "document/json_text.hpp"
#include "record/layout.hpp"
#include "record/live_writer.hpp"

namespace hapticd::record {

namespace {

using Json = nlohmann::ordered_json;

/// [bytes] longest description that is read; that of a scene of 10,000 models has 2 MB
constexpr uint64_t kMostAbout = 64u << 20;

template <class T>
std::optional<T> at(std::span<const std::byte> bytes, uint64_t address) {
  if (address > bytes.size() || bytes.size() - address < sizeof(T)) return std::nullopt;
  T value;
  std::memcpy(&value, bytes.data() + address, sizeof value);
  return value;
}

template <class T>
double as(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return static_cast<double>(value);
}

/// True if the bytes begin as a black box does, which keeps the newest rows in a ring.
bool isRing(std::span<const std::byte> bytes) {
  const auto header = at<FileHeader>(bytes, kHeaderAt);
  return header && header->ring != 0;
}

}  // namespace

const Column* RecordedStream::find(const std::string& name) const {
  const auto it = std::find_if(columns_.begin(), columns_.end(), [&](const Column& c) { return c.name == name; });
  return it == columns_.end() ? nullptr : &*it;
}

double numberOf(const std::byte* row, const Column& column) {
  const std::byte* from = row + column.offset;
  switch (column.type) {
    case ColumnType::kReal:
      return as<double>(from);
    case ColumnType::kReal32:
      return as<float>(from);
    case ColumnType::kCount:
      return as<uint64_t>(from);
    case ColumnType::kWord:
      return as<uint32_t>(from);
    case ColumnType::kInt:
      return as<int32_t>(from);
    case ColumnType::kText:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::string RecordedStream::text(uint64_t index, const Column& column) const {
  if (column.type != ColumnType::kText) return "";
  const auto* from = reinterpret_cast<const char*>(row(index) + column.offset);
  return {from, strnlen(from, kTextBytes)};
}

Result<std::unique_ptr<Recording>> Recording::open(const std::string& file) {
  const auto fd = openRegular(file);
  if (!fd) return Error{file + ": " + fd.error()};
  const std::optional<int> writer = writerOf(*fd);  // before reading: the writer may end at any time
  struct stat info{};
  const auto size = fstat(*fd, &info) == 0 ? static_cast<size_t>(info.st_size) : 0;
  void* memory = size == 0 ? MAP_FAILED : mmap(nullptr, size, PROT_READ, MAP_SHARED, *fd, 0);
  const int error = errno;
  ::close(*fd);
  if (size == 0) return Error{file + ": is not a recording, expected a file that --record wrote"};
  if (memory == MAP_FAILED) return Error{file + ": cannot be mapped: " + std::strerror(error)};
  std::unique_ptr<Recording> recording(new Recording);
  recording->mapped_ = memory;
  recording->mapped_bytes_ = size;
  const std::span<const std::byte> bytes{static_cast<const std::byte*>(memory), size};
  if (auto read = isRing(bytes) ? recording->readRing(bytes) : recording->read(bytes); !read)
    return Error{file + ": " + read.error()};
  if (!recording->closed_) recording->writer_ = writer;
  if (writer) recording->damage_.clear();  // not damaged: the writer added rows after the length was read
  return recording;
}

Result<std::unique_ptr<Recording>> Recording::parse(std::span<const std::byte> bytes, const std::string& name) {
  std::unique_ptr<Recording> recording(new Recording);
  if (auto read = recording->read(bytes); !read) return Error{name + ": " + read.error()};
  return recording;
}

Recording::~Recording() {
  if (mapped_ != nullptr) munmap(mapped_, mapped_bytes_);
}

const RecordedStream* Recording::stream(const std::string& name) const {
  const auto it = std::find_if(streams_.begin(), streams_.end(), [&](const auto& s) { return s.name_ == name; });
  return it == streams_.end() ? nullptr : &*it;
}

Result<void> Recording::read(std::span<const std::byte> bytes) {
  const auto header = at<FileHeader>(bytes, kHeaderAt);
  const std::string magic = header ? std::string(header->magic, strnlen(header->magic, sizeof header->magic)) : "";
  if (magic != kRecordingFormat) {
    const bool other = magic.rfind("hapticd-recording/", 0) == 0;
    return Error{other ? "has the format " + magic + ", expected " + kRecordingFormat
                       : std::string("is not a recording, expected a file that --record wrote")};
  }
  if (header->stream_count > kMaxStreams) return Error{"is damaged: it names more streams than possible"};
  closed_ = header->closed != 0;
  black_box_ = header->ring != 0;
  for (uint32_t i = 0; i < header->stream_count; ++i) {
    const StreamHeader& from = header->streams[i];
    if (from.row_bytes == 0 || from.row_bytes > kMaxRowBytes || from.row_bytes % 8 != 0 || from.chunk_rows == 0)
      return Error{"is damaged: it has a stream with rows of an impossible size"};
    RecordedStream& stream = streams_.emplace_back();
    stream.name_.assign(from.name, strnlen(from.name, sizeof from.name));
    stream.row_bytes_ = from.row_bytes;
    stream.chunk_rows_ = from.chunk_rows;
    stream.rows_ = from.rows;
    stream.lost_ = from.lost;
  }
  const uint64_t about_bytes = header->about_bytes;
  if (about_bytes > kMostAbout || header->about_address > bytes.size() ||
      about_bytes > bytes.size() - header->about_address)
    return Error{"is damaged: it ends inside its description"};
  about_.assign(reinterpret_cast<const char*>(bytes.data() + header->about_address), about_bytes);
  if (auto blocks = readBlocks(bytes, header->blocks_address); !blocks) return blocks;
  return readColumns();
}

/// Reads a black box from a copy, because a running daemon overwrites its oldest rows meanwhile. Rows that it may have
/// overwritten during the copy are left out.
Result<void> Recording::readRing(std::span<const std::byte> bytes) {
  const auto before = at<FileHeader>(bytes, kHeaderAt);
  std::atomic_thread_fence(std::memory_order_acquire);  // the rows are read after their number
  copy_.assign(bytes.begin(), bytes.end());
  std::atomic_thread_fence(std::memory_order_acquire);  // the number of rows is read after the rows
  // memmove() copies in any order, so the number in the copy may be newer than the rows in the copy.
  if (before) std::memcpy(copy_.data() + kHeaderAt, &*before, sizeof *before);
  const auto later = at<FileHeader>(bytes, kHeaderAt);
  if (auto read = this->read(copy_); !read) return read;
  for (size_t i = 0; later && i < streams_.size(); ++i) {
    RecordedStream& stream = streams_[i];
    const uint64_t written = later->streams[i].rows, end = stream.first_ + stream.rows_;
    const uint64_t kept = std::min(stream.ring_rows_ > 0 ? stream.ring_rows_ - 1 : 0, written);
    const uint64_t first = std::min(std::max(stream.first_, written - kept), end);
    stream.rows_ = end - first;
    stream.first_ = first;
  }
  return {};
}

Result<void> Recording::readBlocks(std::span<const std::byte> bytes, uint64_t address) {
  while (const auto block = at<BlockHeader>(bytes, address)) {
    const uint64_t from = address + sizeof *block;
    if (block->magic != BlockHeader::kMagic || block->bytes > bytes.size() - from)
      break;  // the writer was killed here, or the file was cut
    address = from + block->bytes;
    if (block->stream == BlockHeader::kIndex || block->stream >= streams_.size()) continue;
    RecordedStream& stream = streams_[block->stream];
    if (block->bytes / stream.row_bytes_ < stream.chunk_rows_)
      return Error{"is damaged: it has a block that is too short"};
    stream.chunks_.push_back(bytes.data() + from);
  }
  for (RecordedStream& stream : streams_) {
    const uint64_t space = uint64_t{stream.chunks_.size()} * stream.chunk_rows_;
    if (black_box_) {
      stream.ring_rows_ = space;
      // the slot after the newest row may have been half written when the process ended
      const uint64_t kept = space > 0 ? std::min(stream.rows_, space - 1) : 0;
      stream.first_ = stream.rows_ - kept;
      stream.rows_ = kept;
    } else {
      if (stream.rows_ > space) noteDamage(stream, space, address, bytes);
      stream.rows_ = std::min(stream.rows_, space);
    }
  }
  return {};
}

/// Notes that rows are missing. A writer stores the number of rows only after it has written the rows, so missing rows
/// were lost later. @param stopped address at which no more blocks could be read
void Recording::noteDamage(const RecordedStream& stream, uint64_t space, uint64_t stopped,
                           std::span<const std::byte> bytes) {
  if (!damage_.empty()) return;  // only for the first stream, which has the ticks
  const uint64_t size = bytes.size();
  const auto block = at<BlockHeader>(bytes, stopped);
  const bool cut = !block || block->magic == BlockHeader::kMagic;
  damage_ = (cut ? "it ends at byte " + std::to_string(size) + ", in the middle of its rows"
                 : "it is damaged at byte " + std::to_string(stopped)) +
            ": " + std::to_string(stream.rows_ - space) + " of " + std::to_string(stream.rows_) + " rows of " +
            stream.name_ + " are lost; copy the file again from where it was recorded";
}

Result<void> Recording::readColumns() {
  const Json about = document::parseJson(about_);
  if (!about.is_object() || !about.contains("columns") || !about["columns"].is_object())
    return Error{"is damaged: it does not describe its columns"};
  for (RecordedStream& stream : streams_) {
    const Json list = about["columns"].value(stream.name_, Json::array());
    if (!list.is_array()) return Error{"is damaged: the columns of its stream " + stream.name_ + " are not described"};
    for (const Json& entry : list) {
      const auto text = [&](const char* key) {
        return entry.is_object() && entry.contains(key) && entry[key].is_string() ? entry[key].get<std::string>() : "";
      };
      const auto type = typeOf(text("type"));
      const bool has_offset = entry.is_object() && entry.contains("offset") && entry["offset"].is_number_unsigned();
      const uint64_t offset = has_offset ? entry["offset"].get<uint64_t>() : UINT64_MAX;
      if (!type || offset > stream.row_bytes_ || bytesOf(*type) > stream.row_bytes_ - offset)
        return Error{"is damaged: a column of its stream " + stream.name_ + " lies outside of the rows"};
      stream.columns_.push_back({text("name"), text("unit"), text("doc"), *type, static_cast<uint32_t>(offset)});
    }
  }
  return {};
}

}  // namespace hapticd::record
