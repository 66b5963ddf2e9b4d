// SPDX-License-Identifier: MIT
/// Rows as ROS 2 messages. Columns are aligned as CDR aligns them (OMG DDS-XTypes 1.3, 7.4.3: each number at a multiple
/// of its size), so four bytes in front of a row make it a message of its column table; nothing is encoded again.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "record/columns.hpp"

namespace hapticd::record {

/// The head before a row: plain CDR, little-endian, no options.
constexpr std::array<char, 4> kCdrHead = {0, 1, 0, 0};

/// [any] "hapticd_msgs/msg/Ticks" for "ticks".
std::string rosType(const std::string& stream);

/// [any] The .msg text: one field per column, with its unit and meaning as a comment.
std::string rosDefinition(const std::vector<Column>& columns);

/// [any] True if rows of these columns have the layout of CDR. Otherwise no ROS reader can read them.
bool liesAsCdr(const std::vector<Column>& columns);

}  // namespace hapticd::record
