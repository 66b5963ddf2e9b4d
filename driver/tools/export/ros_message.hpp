// SPDX-License-Identifier: MIT
/// Turns rows into ROS 2 messages. The columns of a row are aligned as in CDR (OMG DDS-XTypes 1.3, 7.4.3): each number
/// lies at a multiple of its size. So a message consists of four bytes and the unchanged row, and nothing has to be
/// encoded, except for a text, which may only be the last column.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "record/columns.hpp"

namespace hapticd::record {

/// The four bytes that stand before a row in a message. They mean: plain CDR, little-endian, no options.
constexpr std::array<char, 4> kCdrHead = {0, 1, 0, 0};

/// [any] Returns the name of the message type, such as "hapticd_msgs/msg/Ticks" for "ticks".
std::string rosType(const std::string& stream);

/// [any] Returns the text of the .msg file: one field per column, with its unit and meaning as a comment.
std::string rosDefinition(const std::vector<Column>& columns);

/// [any] True if rows of these columns have the layout of CDR. Otherwise no ROS reader can read them.
bool liesAsCdr(const std::vector<Column>& columns);

/// [any] Returns what follows the head in a message: the row itself, or, if its last column is a text, a copy of the
/// row in which the text is a string of CDR. @param encoded memory for the copy
std::string_view cdrBody(const std::vector<Column>& columns, std::string_view row, std::string& encoded);

}  // namespace hapticd::record
