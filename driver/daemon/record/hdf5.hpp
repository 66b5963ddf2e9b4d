// SPDX-License-Identifier: MIT
/// Writes the part of the HDF5 file format (HDF Group, "File Format Specification Version 3.0") that a recording needs:
/// superblock version 2, compact groups, one-dimensional chunked tables of compounds, and texts of fixed length. Every
/// HDF5 library from 1.8 on can read it. The HDF5 library itself is not used, because it keeps its index in memory: if
/// the process is killed, its file cannot be opened. Here the file is valid between any two writes.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "record/columns.hpp"

namespace hapticd::record::hdf5 {

constexpr uint64_t kNowhere = UINT64_MAX;  ///< HDF5's undefined address

/// [any] Returns the checksum that HDF5 uses for its metadata: Jenkins' lookup3.
uint32_t checksum(const std::string& bytes);

/// [main] Returns the superblock, which contains the address of the root group and the end of the file.
std::string superblock(uint64_t root_address, uint64_t end_of_file);

struct Link {
  std::string name;
  uint64_t address;  ///< address of the object header
};

/// [main] Returns the object header of a group with links and with texts as attributes.
std::string group(const std::vector<Link>& links, const std::vector<std::pair<std::string, std::string>>& attributes);

/// [main] Returns the object header of a dataset that is one text of fixed length at `address`.
std::string textDataset(uint64_t address, uint64_t length);

/// The object header of a table of rows in chunks. It changes as the table grows, and each change must be one write
/// within one page. So the description of the columns, which may be long, is in a separate block.
struct TableHeader {
  uint64_t rows = 0, index_address = kNowhere;
  uint32_t chunk_rows = 1, row_bytes = 8;
  uint64_t description_address = 0, description_bytes = 0;

  /// [main] Returns the bytes of the header, whose number is always the same.
  std::string bytes() const;
};
std::string tableDescription(const RowLayout& layout);  ///< [main] block for TableHeader::description_address

/// The index of the chunks of one table: a B-tree that grows at its right edge. A node never changes its size or its
/// address. Only the last node of each level is rewritten, and a node is written before anything points to it.
class ChunkIndex {
 public:
  static constexpr uint32_t kFanOut = 64;  ///< entries per node, HDF5's default
  static constexpr uint32_t kNodeBytes = 24 + (kFanOut + 1) * 24 + kFanOut * 8;

  ChunkIndex(uint32_t chunk_rows, uint64_t chunk_bytes) : chunk_rows_(chunk_rows), chunk_bytes_(chunk_bytes) {}

  /// A node and the address at which it must be written.
  struct Write {
    uint64_t address;
    std::string bytes;
  };

  /// [main] Adds the next chunk. @param newNode returns the address of kNodeBytes for a new node
  /// @return the nodes to write, in this order
  template <class NewNode>
  std::vector<Write> add(uint64_t chunk_address, NewNode&& newNode) {
    std::vector<Write> writes;
    insert(0, chunks_ * chunk_rows_, chunk_address, newNode, writes);
    ++chunks_;
    for (size_t level = 0; level < levels_.size(); ++level) writes.push_back({levels_[level].address, bytes(level)});
    return writes;
  }

  uint64_t root() const { return levels_.empty() ? kNowhere : levels_.back().address; }

 private:
  struct Node {
    uint64_t address = kNowhere, left = kNowhere, right = kNowhere;
    std::vector<std::pair<uint64_t, uint64_t>> entries;  ///< first row and address of each child
  };

  template <class NewNode>
  void insert(size_t level, uint64_t first_row, uint64_t child, NewNode&& newNode, std::vector<Write>& writes) {
    if (level == levels_.size()) {
      Node root{newNode(), kNowhere, kNowhere, {}};
      if (level > 0) root.entries.emplace_back(0, first_child_[level - 1]);
      levels_.push_back(root);
      first_child_.push_back(root.address);
    }
    if (levels_[level].entries.size() == kFanOut) {
      const Node next{newNode(), levels_[level].address, kNowhere, {}};
      levels_[level].right = next.address;
      const Write full{levels_[level].address, bytes(level)};
      levels_[level] = next;
      levels_[level].entries.emplace_back(first_row, child);
      writes.push_back({next.address, bytes(level)});
      writes.push_back(full);
      insert(level + 1, first_row, next.address, newNode, writes);
      return;
    }
    levels_[level].entries.emplace_back(first_row, child);
  }
  std::string bytes(size_t level) const;
  uint64_t fullChild(size_t level) const;  ///< number of rows below one entry of a full node

  uint32_t chunk_rows_;
  uint64_t chunk_bytes_, chunks_ = 0;
  std::vector<Node> levels_;           ///< the rightmost node of each level, leaves first
  std::vector<uint64_t> first_child_;  ///< the first node of each level
};

}  // namespace hapticd::record::hdf5
