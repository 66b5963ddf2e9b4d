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

const char* kept(Stream& stream, const nlohmann::json& column, const char* key) {
  return stream.texts.emplace_back(column.at(key).get<std::string>()).c_str();
}

}  // namespace

Result<RowFile> RowFile::open(const std::string& file) {
  RowFile rows;
  rows.file_ = Descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat info{};
  if (!rows.file_ || fstat(rows.file_.get(), &info) != 0)
    return Error{"cannot read " + file + ": " + std::strerror(errno)};
  rows.size_ = static_cast<uint64_t>(info.st_size);
  rows.device_ = info.st_dev, rows.inode_ = info.st_ino;
  if (auto read = rows.readStreams(); !read) return Error{file + ": " + read.error()};
  try {
    if (auto read = rows.readAbout(); !read) return Error{file + ": " + read.error()};
  } catch (const std::exception& error) {
    return Error{file + ": its description cannot be read: " + error.what()};
  }
  return rows;
}

/// Returns false if not all of the bytes are there.
bool RowFile::copy(uint64_t place, void* to, size_t bytes) const {
  for (size_t got = 0; got < bytes;) {
    const ssize_t more =
        pread(file_.get(), static_cast<std::byte*>(to) + got, bytes - got, static_cast<off_t>(place + got));
    if (more < 0 && errno == EINTR) continue;
    if (more <= 0) return false;
    got += static_cast<size_t>(more);
  }
  return true;
}

Result<void> RowFile::readStreams() {
  record::FileHeader header;
  if (!copy(record::kHeaderAt, &header, sizeof header) ||
      std::strncmp(header.magic, record::kRecordingFormat, sizeof header.magic) != 0 || header.ring != 1 ||
      header.stream_count > record::kMaxStreams)
    return Error{"is not a black box of a daemon of this version"};
  if (!has(header.about_address, header.about_bytes))
    return Error{"ends inside its description: it is incomplete or damaged"};
  about_.resize(header.about_bytes);
  if (!copy(header.about_address, about_.data(), about_.size())) return Error{"was cut while it was read"};
  for (uint32_t i = 0; i < header.stream_count; ++i) {
    const record::StreamHeader& stream = header.streams[i];
    if (stream.row_bytes == 0 || stream.row_bytes % 8 != 0 || stream.row_bytes > record::kMaxRowBytes)
      return Error{"has rows of an impossible size: it is damaged"};
    Stream& known = streams_.emplace_back();
    known.name.assign(stream.name, strnlen(stream.name, sizeof stream.name));
    known.written_at = record::kHeaderAt + offsetof(record::FileHeader, streams) + i * sizeof(record::StreamHeader) +
                       offsetof(record::StreamHeader, rows);
    known.row_words = stream.row_bytes / 8;
  }
  return readBlocks(header.blocks_address);
}

Result<void> RowFile::readBlocks(uint64_t place) {
  record::BlockHeader block;
  while (has(place, sizeof block) && copy(place, &block, sizeof block)) {
    const uint64_t rows = place + sizeof block;
    if (block.magic != record::BlockHeader::kMagic || !has(rows, block.bytes) || place % 8 != 0) break;
    if (block.stream < streams_.size()) {
      streams_[block.stream].rows_at = rows;
      streams_[block.stream].capacity = block.bytes / 8 / streams_[block.stream].row_words;
    }
    place = rows + block.bytes;
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
  uint32_t closed = 0;
  return copy(record::kHeaderAt + offsetof(record::FileHeader, closed), &closed, sizeof closed) && closed != 0;
}

std::optional<uint64_t> RowFile::written(const Stream& stream) const {
  // The kernel may copy a number byte by byte while the servo stores it, so it counts only if it is read twice.
  constexpr int kTries = 1000;
  uint64_t count = 0, again = 0;
  if (!copy(stream.written_at, &count, sizeof count)) return std::nullopt;
  for (int i = 0; i < kTries; ++i) {
    if (!copy(stream.written_at, &again, sizeof again)) return std::nullopt;
    if (count == again) break;
    count = again;
  }
  // rows that are copied later are at least as new, and rows that were copied before are no newer
  std::atomic_thread_fence(std::memory_order_seq_cst);
  return count;
}

/// Copies rows that lie in the ring in one piece or in two. Returns false if the file was cut.
bool RowFile::copyRows(const Stream& stream, uint64_t first, uint64_t count, void* rows) const {
  const uint64_t row_bytes = stream.row_words * 8, at = first % stream.capacity;
  const uint64_t before_the_end = std::min(count, stream.capacity - at);
  return copy(stream.rows_at + at * row_bytes, rows, before_the_end * row_bytes) &&
         copy(stream.rows_at, static_cast<std::byte*>(rows) + before_the_end * row_bytes,
              (count - before_the_end) * row_bytes);
}

long RowFile::read(const Stream& stream, uint64_t& row, void* rows, size_t most) const {
  constexpr int kTries = 1000;  // the writer goes round its ring in seconds
  for (int i = 0; i < kTries; ++i) {
    const auto end = written(stream);
    if (!end) return -1;
    const uint64_t kept = stream.capacity - 1;  // the slot after the newest row is being written
    const uint64_t first = std::min(std::max(row, *end > kept ? *end - kept : 0), *end);
    const uint64_t count = std::min<uint64_t>(most, *end - first);
    if (!copyRows(stream, first, count, rows)) return -1;
    std::atomic_thread_fence(std::memory_order_seq_cst);
    // The rows were overwritten meanwhile: reads newer ones.
    if (const auto now = written(stream); count > 0 && now && *now - first >= stream.capacity) continue;
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
  return found != nullptr ? client->rows.written(*found).value_or(0) : 0;
}

long hapticd_read(hapticd_client* client, int stream, uint64_t* row, void* rows, size_t most) {
  auto* found = streamOf(client, stream);
  if (found == nullptr) return -1;
  const long got = client->rows.read(*found, *row, rows, most);
  if (got < 0) return -1;
  std::atomic_ref<uint64_t> handed(found->handed);
  if (*row > handed.load(std::memory_order_relaxed))
    handed.store(*row, std::memory_order_relaxed);
  else if (client->ended())
    return -1;  // rows that were read before are not new
  return got;
}
