// SPDX-License-Identifier: MIT
/// Turns rows into ROS 2 messages. Columns have the same alignment as in CDR (OMG DDS-XTypes 1.3, 7.4.3: each number at
/// a multiple of its size). So a row with four bytes in front of it is such a message already, and nothing is encoded
/// again.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "record/columns.hpp"

namespace hapticd::record {

/// The four bytes in front of a row that make it a message. They mean: plain CDR, little-endian, no options.
constexpr std::array<char, 4> kCdrHead = {0, 1, 0, 0};

/// [any] Returns the name of the message type, such as "hapticd_msgs/msg/Ticks" for "ticks".
std::string rosType(const std::string& stream);

/// [any] Returns the text of the .msg file: one field per column, with its unit and meaning as a comment.
std::string rosDefinition(const std::vector<Column>& columns);

/// [any] True if rows of these columns have the layout of CDR. Otherwise no ROS reader can read them.
bool liesAsCdr(const std::vector<Column>& columns);

}  // namespace hapticd::record
