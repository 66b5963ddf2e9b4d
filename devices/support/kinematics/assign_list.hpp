// SPDX-License-Identifier: MIT
/// Puts a list of a device file, such as arm.lengths, into the members of a geometry.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace hapticd::kinematics {

/// [main] Assigns the numbers to the members in their order. An empty list changes nothing. Throws
/// std::invalid_argument with a message for the user if the number of numbers is wrong.
/// @param id name of the list, for the message
template <class... Member>
void assignList(const std::vector<double>& from, const char* id, Member&... members) {
  if (from.empty()) return;
  if (from.size() != sizeof...(members))
    throw std::invalid_argument(std::string(id) + ": " + std::to_string(from.size()) +
                                (from.size() == 1 ? " number" : " numbers") + ", expected " +
                                std::to_string(sizeof...(members)) + " for this kind of arm");
  size_t i = 0;
  ((members = from[i++]), ...);
}

}  // namespace hapticd::kinematics
