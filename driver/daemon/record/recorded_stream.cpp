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

/// Returns a page as the first of pages_. Reads it in place of the one that was asked for longest ago, unless it is
/// there.
const RecordedStream::Page& RecordedStream::fetch(uint64_t number) const {
  auto at = std::find_if(pages_.begin(), pages_.end() - 1, [&](const Page& page) { return page.number == number; });
  std::rotate(pages_.begin(), at, at + 1);
  Page& page = pages_.front();
  if (page.number == number) return page;
  page.number = number;
  const uint64_t first = number % pages_per_chunk_ * page_rows_;
  page.rows.resize(size_t{std::min<uint32_t>(page_rows_, chunk_rows_ - static_cast<uint32_t>(first))} * row_bytes_);
  bytes_->read(chunks_[number / pages_per_chunk_] + first * row_bytes_, page.rows.data(), page.rows.size());
  return page;
}

}  // namespace hapticd::record
