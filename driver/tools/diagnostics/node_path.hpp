// SPDX-License-Identifier: MIT
/// Finds a node of a document by its keys.
#pragma once
#include <initializer_list>

#include "document/node.hpp"

namespace hapticd::diagnostics {

/// [any] Returns the node at a path of keys, or nullptr if one of the keys is missing.
inline const document::Node* find(const document::Node& root, std::initializer_list<const char*> keys) {
  const document::Node* at = &root;
  for (const char* key : keys) {
    at = at->isMap() ? at->find(key) : nullptr;
    if (at == nullptr) return nullptr;
  }
  return at;
}

}  // namespace hapticd::diagnostics
