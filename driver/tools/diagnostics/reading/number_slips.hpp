// SPDX-License-Identifier: MIT
/// Finds slips in the numbers of any file: a comma for a decimal point, a quaternion in another order, an arm placed in
/// millimetres.
#pragma once
#include <string>

#include "document/node.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of whole numbers that begin with a zero, as in [0,05, 0], where a comma was meant as a decimal point.
void warnOfZeros(const document::Node& root, const std::string& file, document::Problems& warnings);

/// [main] Warns of an arm that a scene puts metres away, because millimetres were meant.
void warnOfMounts(const document::Node& root, const std::string& file, document::Problems& warnings);

/// [main] Warns of one such position. @param position node of `mount.position`; may be nullptr
void warnOfMount(const document::Node* position, const std::string& key, const std::string& file,
                 document::Problems& warnings);

/// [main] Warns of orientations in a scene that were probably written x, y, z, w. @param key path of `root`, for
/// messages
void warnOfTurns(const document::Node& root, const std::string& file, document::Problems& warnings,
                 const std::string& key = "");

/// [main] Warns of one such orientation. @param orientation may be nullptr
void warnOfTurn(const document::Node* orientation, const std::string& key, const std::string& file,
                document::Problems& warnings);

}  // namespace hapticd::diagnostics
