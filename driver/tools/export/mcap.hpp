// SPDX-License-Identifier: MIT
/// Writes MCAP (mcap.dev, specification version 0): messages in compressed chunks with an index. Foxglove, PlotJuggler,
/// rosbag2 and others can read these files.
#pragma once
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"

namespace hapticd::record {

class McapWriter {
 public:
  /// [main] Creates the file. Times are ns since 1970.
  static Result<std::unique_ptr<McapWriter>> create(const std::string& file);
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// [main] Adds a channel of messages of one type, encoded as CDR. Call it before the first message. @return the
  /// number of the channel
  uint16_t addChannel(const std::string& topic, const std::string& type, const std::string& definition);

  /// [main] Appends a message that consists of `head` and then `body`. The times of a channel must not decrease.
  void message(uint16_t channel, uint64_t time_ns, std::string_view head, std::string_view body);

  /// [main] Adds a text as an attachment of the file.
  void attach(const std::string& name, const std::string& media_type, const std::string& text, uint64_t time_ns);

  /// [main] Writes the messages that are still in memory, the index and the end of the file.
  Result<void> close();

  uint64_t messages() const { return messages_; }
  uint64_t bytes() const { return offset_; }  ///< bytes of the file so far

 private:
  struct Channel {
    std::string topic, type, definition;
    uint64_t messages = 0;
    std::vector<std::pair<uint64_t, uint64_t>> index;  ///< time, and byte of the present chunk, of each message
  };
  struct ChunkPlace {
    uint64_t start, end, offset, length, index_length, compressed, uncompressed;
    std::map<uint16_t, uint64_t> indexes;
  };
  struct AttachmentPlace {
    uint64_t offset, length, time, bytes;
    std::string name, media_type;
  };
  explicit McapWriter(std::string file, std::FILE* out) : file_(std::move(file)), out_(out) {}
  void write(std::string_view bytes);
  void endChunk();
  std::string schemas() const;
  std::string statistics() const;
  void summary();

  std::string file_;
  std::FILE* out_;
  int error_ = 0;
  uint64_t offset_ = 0, messages_ = 0, first_ = UINT64_MAX, last_ = 0;
  std::vector<Channel> channels_;
  std::string chunk_;
  uint64_t chunk_first_ = UINT64_MAX, chunk_last_ = 0;
  std::vector<ChunkPlace> chunks_;
  std::vector<AttachmentPlace> attachments_;
};

/// [any] Computes the CRC-32 of IEEE 802.3, as zlib does. @param before CRC of the bytes before these
uint32_t crc32(std::string_view bytes, uint32_t before = 0);

}  // namespace hapticd::record
