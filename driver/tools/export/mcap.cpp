// SPDX-License-Identifier: MIT
#include "export/mcap.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>

#include "base/regular_file.hpp"

namespace hapticd::record {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are stored as they lie in memory");

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
constexpr size_t kChunkBytes = 1u << 20;  ///< size of a chunk before compression; to seek, a reader unpacks one chunk
constexpr int kLevel = 3;                 ///< compression level of zstd, which is its default

/// Op codes of records.
enum Record : uint8_t {
  kHeader = 1,
  kFooter,
  kSchema,
  kChannel,
  kMessage,
  kChunk,
  kMessageIndex,
  kChunkIndex,
  kAttachment,
  kAttachmentIndex,
  kStatistics,
  kMetadata,
  kMetadataIndex,
  kSummaryOffset,
  kDataEnd
};

/// Builds the content of a record from numbers and texts.
class Body {
 public:
  template <class T>
  Body& n(T value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    text_.append(raw, sizeof raw);
    return *this;
  }
  Body& text(std::string_view value) {  ///< writes the length before the text
    n(static_cast<uint32_t>(value.size()));
    text_ += value;
    return *this;
  }
  Body& raw(std::string_view value) {
    text_ += value;
    return *this;
  }
  std::string record(Record op) const {
    return Body().n(static_cast<uint8_t>(op)).n(static_cast<uint64_t>(text_.size())).raw(text_).text_;
  }
  const std::string& bytes() const { return text_; }

 private:
  std::string text_;
};

/// Encodes a map as in the specification: the length of its entries in bytes, then keys and values.
std::string counts(const std::map<uint16_t, uint64_t>& map) {
  Body entries;
  for (const auto& [key, value] : map) entries.n(key).n(value);
  return Body().n(static_cast<uint32_t>(entries.bytes().size())).raw(entries.bytes()).bytes();
}

}  // namespace

uint32_t crc32(std::string_view bytes, uint32_t before) {
  static const auto table = [] {
    std::array<uint32_t, 256> made{};
    for (uint32_t i = 0; i < made.size(); ++i) {
      uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1) != 0 ? 0xEDB88320u : 0u);
      made[i] = value;
    }
    return made;
  }();
  uint32_t crc = ~before;
  for (const char byte : bytes) crc = (crc >> 8) ^ table[(crc ^ static_cast<unsigned char>(byte)) & 0xFF];
  return ~crc;
}

Result<std::unique_ptr<McapWriter>> McapWriter::create(const std::string& file) {
  std::FILE* out = std::fopen(file.c_str(), "wbe");
  if (out == nullptr) return Error{file + ": cannot be written: " + std::strerror(errno)};
  std::unique_ptr<McapWriter> writer(new McapWriter(file, out));
  writer->write(kMagic);
  writer->write(Body().text("ros2").text("hapticd").record(kHeader));
  return writer;
}

McapWriter::~McapWriter() {
  if (out_ == nullptr) return;
  std::fclose(out_);
  removeIncomplete(file_);
}

void McapWriter::write(std::string_view bytes) {
  if (error_ == 0 && std::fwrite(bytes.data(), 1, bytes.size(), out_) != bytes.size()) error_ = errno;
  offset_ += bytes.size();
}

uint16_t McapWriter::addChannel(const std::string& topic, const std::string& type, const std::string& definition) {
  channels_.push_back({topic, type, definition, 0, {}});
  return static_cast<uint16_t>(channels_.size());
}

/// Returns the records of schemas and channels, which stand before the messages and again in the summary.
std::string McapWriter::schemas() const {
  std::string records;
  for (size_t i = 0; i < channels_.size(); ++i) {
    const auto number = static_cast<uint16_t>(i + 1);
    const Channel& channel = channels_[i];
    records += Body().n(number).text(channel.type).text("ros2msg").text(channel.definition).record(kSchema);
    records += Body().n(number).n(number).text(channel.topic).text("cdr").n(uint32_t{0}).record(kChannel);
  }
  return records;
}

void McapWriter::message(uint16_t channel, uint64_t time_ns, std::string_view head, std::string_view body) {
  Channel& to = channels_[channel - 1u];
  if (chunks_.empty() && chunk_.empty()) chunk_ = schemas();
  to.index.emplace_back(time_ns, chunk_.size());
  Body record;
  record.n(channel).n(static_cast<uint32_t>(to.messages)).n(time_ns).n(time_ns).raw(head).raw(body);
  chunk_ += record.record(kMessage);
  ++to.messages, ++messages_;
  chunk_first_ = std::min(chunk_first_, time_ns), chunk_last_ = std::max(chunk_last_, time_ns);
  if (chunk_.size() >= kChunkBytes) endChunk();
}

void McapWriter::endChunk() {
  if (chunk_.empty() || chunk_first_ == UINT64_MAX) return;
  std::string packed(ZSTD_compressBound(chunk_.size()), '\0');
  const size_t size = ZSTD_compress(packed.data(), packed.size(), chunk_.data(), chunk_.size(), kLevel);
  const bool fits = ZSTD_isError(size) == 0;
  const std::string_view stored = fits ? std::string_view(packed.data(), size) : std::string_view(chunk_);
  ChunkPlace place{chunk_first_, chunk_last_, offset_, 0, 0, stored.size(), chunk_.size(), {}};
  Body body;
  body.n(chunk_first_).n(chunk_last_).n(static_cast<uint64_t>(chunk_.size())).n(crc32(chunk_));
  body.text(fits ? "zstd" : "").n(static_cast<uint64_t>(stored.size())).raw(stored);
  write(body.record(kChunk));
  place.length = offset_ - place.offset;
  for (size_t i = 0; i < channels_.size(); ++i) {
    auto& index = channels_[i].index;
    if (index.empty()) continue;
    const auto number = static_cast<uint16_t>(i + 1);
    place.indexes[number] = offset_;
    Body entries;
    for (const auto& [time, at] : index) entries.n(time).n(at);
    const auto length = static_cast<uint32_t>(entries.bytes().size());
    write(Body().n(number).n(length).raw(entries.bytes()).record(kMessageIndex));
    index.clear();
  }
  place.index_length = offset_ - place.offset - place.length;
  chunks_.push_back(std::move(place));
  first_ = std::min(first_, chunk_first_), last_ = std::max(last_, chunk_last_);
  chunk_.clear();
  chunk_first_ = UINT64_MAX, chunk_last_ = 0;
}

void McapWriter::attach(const std::string& name, const std::string& media_type, const std::string& text,
                        uint64_t time_ns) {
  Body body;
  body.n(time_ns).n(time_ns).text(name).text(media_type).n(static_cast<uint64_t>(text.size())).raw(text);
  const uint32_t crc = crc32(body.bytes());
  const uint64_t at = offset_;
  write(body.n(crc).record(kAttachment));
  attachments_.push_back({at, offset_ - at, time_ns, text.size(), name, media_type});
}

std::string McapWriter::statistics() const {
  std::map<uint16_t, uint64_t> each;
  for (size_t i = 0; i < channels_.size(); ++i) each[static_cast<uint16_t>(i + 1)] = channels_[i].messages;
  Body body;
  body.n(messages_).n(static_cast<uint16_t>(channels_.size())).n(static_cast<uint32_t>(channels_.size()));
  body.n(static_cast<uint32_t>(attachments_.size())).n(uint32_t{0}).n(static_cast<uint32_t>(chunks_.size()));
  body.n(messages_ > 0 ? first_ : 0).n(last_).raw(counts(each));
  return body.record(kStatistics);
}

/// Writes the summary at the end of the file, with which a reader finds everything else.
void McapWriter::summary() {
  const uint64_t start = offset_;
  std::string bytes = schemas() + statistics();
  for (const ChunkPlace& c : chunks_) {
    Body body;
    body.n(c.start).n(c.end).n(c.offset).n(c.length).raw(counts(c.indexes)).n(c.index_length).text("zstd");
    bytes += body.n(c.compressed).n(c.uncompressed).record(kChunkIndex);
  }
  for (const AttachmentPlace& a : attachments_) {
    Body body;
    body.n(a.offset).n(a.length).n(a.time).n(a.time).n(a.bytes).text(a.name).text(a.media_type);
    bytes += body.record(kAttachmentIndex);
  }
  // the checksum covers the summary and the footer up to itself
  Body footer;
  footer.n(static_cast<uint8_t>(kFooter)).n(uint64_t{20}).n(start).n(uint64_t{0});
  const uint32_t crc = crc32(footer.bytes(), crc32(bytes));
  write(bytes);
  write(footer.n(crc).bytes());
}

Result<void> McapWriter::close() {
  if (chunks_.empty() && chunk_.empty()) write(schemas());
  endChunk();
  write(Body().n(uint32_t{0}).record(kDataEnd));  // 0 means that there is no checksum of the data section
  summary();
  write(kMagic);
  if (std::fclose(std::exchange(out_, nullptr)) != 0 && error_ == 0) error_ = errno;
  if (error_ == 0) return {};
  removeIncomplete(file_);
  return Error{file_ + ": could not be written completely, so it was removed: " + std::strerror(error_)};
}

}  // namespace hapticd::record
