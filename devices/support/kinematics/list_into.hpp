// SPDX-License-Identifier: MIT
/// Lists of a device file, as arm.lengths, put into the members of a geometry.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace hapticd::kinematics {

/// [main] Fills in the numbers in their order; an empty list keeps the published ones. Throws std::invalid_argument
/// with a message for the user where their count is wrong.
/// @param id of the list, for the message
template <class... Member>
void assign(const std::vector<double>& from, const char* id, Member&... members) {
  if (from.empty()) return;
  if (from.size() != sizeof...(members))
    throw std::invalid_argument(std::string(id) + ": " + std::to_string(from.size()) +
                                (from.size() == 1 ? " number" : " numbers") + ", expected " +
                                std::to_string(sizeof...(members)) + " for this kind of arm");
  size_t i = 0;
  ((members = from[i++]), ...);
}

}  // namespace hapticd::kinematics
