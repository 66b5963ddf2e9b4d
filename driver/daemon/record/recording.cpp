// SPDX-License-Identifier: MIT
#include "record/recording.hpp"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "document/json_text.hpp"
#include "record/layout.hpp"

namespace hapticd::record {

namespace {

using Json = nlohmann::ordered_json;

/// [bytes] longest description that is read; that of a scene of 10,000 models has 2 MB
constexpr uint64_t kMostAbout = 64u << 20;

/// True if the bytes begin as a black box does, which keeps the newest rows in a ring.
bool isRing(const RecordedBytes& bytes) {
  const auto header = bytes.at<FileHeader>(kHeaderAt);
  return header && header->ring != 0;
}

}  // namespace

Result<std::unique_ptr<Recording>> Recording::open(const std::string& file) {
  auto bytes = RecordedBytes::open(file);
  if (!bytes) return Error{file + ": " + bytes.error()};
  if ((*bytes)->size() == 0) return Error{file + ": is not a recording, expected a file that --record wrote"};
  std::unique_ptr<Recording> recording(new Recording);
  recording->file_ = file;
  recording->bytes_ = std::move(*bytes);
  const std::optional<int> writer = recording->bytes_->writer();
  if (auto read = isRing(*recording->bytes_) ? recording->readRing() : recording->read(); !read)
    return Error{file + ": " + read.error()};
  if (!recording->closed_) recording->writer_ = writer;
  if (writer) recording->damage_.clear();  // not damaged: the writer added rows after the length was read
  return recording;
}

Result<std::unique_ptr<Recording>> Recording::parse(std::span<const std::byte> bytes, const std::string& name) {
  std::unique_ptr<Recording> recording(new Recording);
  recording->file_ = name;
  recording->bytes_ = std::make_unique<RecordedBytes>(bytes);
  if (auto read = recording->read(); !read) return Error{name + ": " + read.error()};
  return recording;
}

Result<void> Recording::unchanged() const {
  if (auto same = bytes_->unchanged(); !same) return Error{file_ + ": " + same.error()};
  return {};
}

const RecordedStream* Recording::stream(const std::string& name) const {
  const auto it = std::find_if(streams_.begin(), streams_.end(), [&](const auto& s) { return s.name_ == name; });
  return it == streams_.end() ? nullptr : &*it;
}

Result<void> Recording::read() {
  const auto header = bytes_->at<FileHeader>(kHeaderAt);
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
    stream.setChunkRows(from.chunk_rows);
    stream.bytes_ = bytes_.get();
    stream.rows_ = from.rows;
    stream.lost_ = from.lost;
  }
  const uint64_t about_bytes = header->about_bytes, size = bytes_->size();
  if (about_bytes > kMostAbout || header->about_address > size || about_bytes > size - header->about_address)
    return Error{"is damaged: it ends inside its description"};
  about_.resize(about_bytes);
  if (!bytes_->read(header->about_address, about_.data(), about_bytes)) return bytes_->unchanged();
  if (auto blocks = readBlocks(header->blocks_address); !blocks) return blocks;
  return readColumns();
}

/// Reads a black box from a copy, because a running daemon overwrites its oldest rows meanwhile. Rows that it may have
/// overwritten during the copy are left out.
Result<void> Recording::readRing() {
  const auto before = bytes_->at<FileHeader>(kHeaderAt);
  copy_.resize(bytes_->size());
  if (!bytes_->read(0, copy_.data(), copy_.size())) return bytes_->unchanged();
  // pread() copies in any order, so the number of rows in the copy may be newer than the rows in the copy.
  if (before) std::memcpy(copy_.data() + kHeaderAt, &*before, sizeof *before);
  const auto later = bytes_->at<FileHeader>(kHeaderAt);
  bytes_ = std::make_unique<RecordedBytes>(copy_);
  if (auto read = this->read(); !read) return read;
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

Result<void> Recording::readBlocks(uint64_t address) {
  while (const auto block = bytes_->at<BlockHeader>(address)) {
    const uint64_t from = address + sizeof *block;
    if (block->magic != BlockHeader::kMagic || block->bytes > bytes_->size() - from)
      break;  // the writer was killed here, or the file was cut
    address = from + block->bytes;
    if (block->stream == BlockHeader::kIndex || block->stream >= streams_.size()) continue;
    RecordedStream& stream = streams_[block->stream];
    if (block->bytes / stream.row_bytes_ < stream.chunk_rows_)
      return Error{"is damaged: it has a block that is too short"};
    stream.chunks_.push_back(from);
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
      if (stream.rows_ > space) noteDamage(stream, space, address);
      stream.rows_ = std::min(stream.rows_, space);
    }
  }
  return {};
}

/// Notes that rows are missing. A writer stores the number of rows only after it has written the rows, so missing rows
/// were lost later. @param stopped address at which no more blocks could be read
void Recording::noteDamage(const RecordedStream& stream, uint64_t space, uint64_t stopped) {
  if (!damage_.empty()) return;  // only for the first stream, which has the ticks
  const uint64_t size = bytes_->size();
  const auto block = bytes_->at<BlockHeader>(stopped);
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
