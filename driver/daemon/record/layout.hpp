// SPDX-License-Identifier: MIT
/// The layout of a recording: an HDF5 file with an additional header in its second sector. HDF5 readers follow the
/// superblock and never see this header. hapticd's reader follows only this header, so it can read the file after a
/// crash, whatever the state of the HDF5 index. The format is "hapticd-recording/1", described in recording.md of the
/// manual.
#pragma once
#include <atomic>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "record/columns.hpp"

namespace hapticd::record {

constexpr const char* kRecordingFormat = "hapticd-recording/1";
constexpr uint64_t kHeaderAt = 512;  ///< [bytes] address of FileHeader in the file
constexpr uint32_t kMaxStreams = 11;
constexpr uint32_t kMaxRowBytes = 1 << 16;

struct StreamHeader {
  char name[16] = {};
  uint32_t row_bytes = 0, chunk_rows = 0;
  uint64_t rows = 0;  ///< in a file: number of complete rows; in a black box: number of rows ever written
  uint64_t lost = 0;  ///< number of rows that were overwritten before they could be written to the file
};

struct FileHeader {
  char magic[24] = {};
  uint32_t stream_count = 0;
  uint32_t ring = 0;    ///< 1: a black box, with the newest rows of each stream in a ring
  uint32_t closed = 0;  ///< 1: the writer ended normally; in a black box: the run ended in order
  uint32_t reserved = 0;
  uint64_t about_address = 0, about_bytes = 0;  ///< place of the JSON with versions, columns and the scene
  uint64_t blocks_address = 0;                  ///< address of the first block
  StreamHeader streams[kMaxStreams];
};
static_assert(sizeof(FileHeader) <= 512, "it must fit into one sector, so that it is never half written");
static_assert(std::is_trivially_copyable_v<FileHeader> && std::atomic_ref<uint64_t>::is_always_lock_free);

/// The header before each chunk of rows, and before each node of the HDF5 index between them.
struct BlockHeader {
  static constexpr uint32_t kMagic = 0x4b4c4248;  ///< "HBLK"
  static constexpr uint32_t kIndex = UINT32_MAX;  ///< a node of the index
  uint32_t magic = kMagic, stream = 0;
  uint64_t bytes = 0;  ///< number of bytes that follow
};

/// The description in a recording. Both texts are datasets of the file.
struct About {
  std::string json;   ///< dataset "about"
  std::string scene;  ///< dataset "scene": the scene file as the user wrote it
};

/// The fixed part of a file, before its first block.
struct Skeleton {
  std::string bytes;
  std::vector<uint64_t> tables;        ///< address of each stream's table header
  std::vector<uint64_t> descriptions;  ///< address of each stream's description
  std::vector<uint64_t> description_bytes;
  uint64_t root = 0;
};

/// [main] Lays out everything that does not grow. @param chunk_rows rows per chunk of each stream
Skeleton makeSkeleton(const std::vector<StreamSpec>& streams, const std::vector<uint32_t>& chunk_rows,
                      const About& about, bool ring);

/// [main] Returns the JSON of the columns, which is part of About::json.
std::string columnsJson(const std::vector<StreamSpec>& streams);

}  // namespace hapticd::record
