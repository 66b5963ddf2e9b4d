// SPDX-License-Identifier: MIT
#include "export/ros_message.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace hapticd::record {

namespace {

const char* rosTypeOf(ColumnType type) {
  switch (type) {
    case ColumnType::kReal:
      return "float64";
    case ColumnType::kReal32:
      return "float32";
    case ColumnType::kCount:
      return "uint64";
    case ColumnType::kWord:
      return "uint32";
    case ColumnType::kInt:
      return "int32";
    case ColumnType::kText:
      return "string";
  }
  return "uint8";
}

}  // namespace

std::string rosType(const std::string& stream) {
  std::string name = stream;
  if (!name.empty()) name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return "hapticd_msgs/msg/" + name;
}

std::string rosDefinition(const std::vector<Column>& columns) {
  std::string text;
  for (const Column& column : columns) {
    std::string comment = column.unit.empty() ? column.doc : column.unit + ": " + column.doc;
    std::replace(comment.begin(), comment.end(), '\n', ' ');
    text += std::string(rosTypeOf(column.type)) + " " + column.name + "  # " + comment + "\n";
  }
  return text;
}

bool liesAsCdr(const std::vector<Column>& columns) {
  uint32_t end = 0;
  for (const Column& column : columns) {
    const uint32_t unit = alignmentOf(column.type);
    if (column.offset != (end + unit - 1) / unit * unit) return false;
    if (column.type == ColumnType::kText && &column != &columns.back()) return false;
    end = column.offset + bytesOf(column.type);
  }
  return true;
}

std::string_view cdrBody(const std::vector<Column>& columns, std::string_view row, std::string& encoded) {
  if (columns.empty() || columns.back().type != ColumnType::kText) return row;
  const uint32_t offset = columns.back().offset;
  const std::string_view text(row.data() + offset, strnlen(row.data() + offset, kTextBytes));
  const auto bytes = static_cast<uint32_t>(text.size() + 1);  // CDR counts the zero at the end
  encoded.assign(row.substr(0, offset));
  encoded.append(reinterpret_cast<const char*>(&bytes), sizeof bytes).append(text).push_back('\0');
  return encoded;
}

}  // namespace hapticd::record
