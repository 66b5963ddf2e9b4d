// SPDX-License-Identifier: MIT
/// Finds values in the nodes of a document: a node by its keys, and the numbers of a list.
#pragma once
#include <cstddef>
#include <initializer_list>
#include <vector>

#include "document/node.hpp"

namespace hapticd::diagnostics {

/// [any] Returns the node at a path of keys, or nullptr if one of the keys is missing.
const document::Node* find(const document::Node& root, std::initializer_list<const char*> keys);

/// [any] Returns all numbers of a list, or of a list of lists; 0 for what is not a number. @param list may be nullptr
std::vector<double> numbersIn(const document::Node* list);

/// [any] Returns the numbers of a list of this length; empty for any other list, and for nullptr.
std::vector<double> numbersOf(const document::Node* list, size_t count);

/// [any] Returns the greatest magnitude of some numbers; 0 if there are none.
double largest(const std::vector<double>& numbers);

}  // namespace hapticd::diagnostics
