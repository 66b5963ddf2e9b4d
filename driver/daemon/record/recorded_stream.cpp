// SPDX-License-Identifier: MIT
#include "record/recorded_stream.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace hapticd::record {

namespace {

constexpr uint32_t kPageBytes = 1 << 16;

template <class T>
double as(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return static_cast<double>(value);
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

void RecordedStream::setChunkRows(uint32_t rows) {
  chunk_rows_ = rows;
  page_rows_ = std::clamp(kPageBytes / row_bytes_, 1u, rows);
  pages_per_chunk_ = (rows - 1) / page_rows_ + 1;
}

/// Reads a page in place of the oldest one, unless it is one of those that were read last.
const RecordedStream::Page& RecordedStream::fetch(uint64_t number) const {
  for (size_t i = 0; i < pages_.size(); ++i)
    if (pages_[i].number == number) return pages_[i];
  newest_ = (newest_ + 1) % pages_.size();
  Page& page = pages_[newest_];
  page.number = number;
  const uint64_t first = number % pages_per_chunk_ * page_rows_;
  page.rows.resize(size_t{std::min<uint32_t>(page_rows_, chunk_rows_ - static_cast<uint32_t>(first))} * row_bytes_);
  bytes_->read(chunks_[number / pages_per_chunk_] + first * row_bytes_, page.rows.data(), page.rows.size());
  return page;
}

}  // namespace hapticd::record
