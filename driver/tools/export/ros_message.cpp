// SPDX-License-Identifier: MIT
#include "export/ros_message.hpp"

#include <algorithm>
#include <cctype>

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
    const uint32_t bytes = bytesOf(column.type);
    if (column.offset != (end + bytes - 1) / bytes * bytes) return false;
    end = column.offset + bytes;
  }
  return true;
}

}  // namespace hapticd::record
