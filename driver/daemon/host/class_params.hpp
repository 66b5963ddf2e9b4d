// SPDX-License-Identifier: MIT
/// Functions for the table of parameters of a shape class or a device class. The records of a table may be longer than
/// those that this hapticd knows, so they are never indexed as an array.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "hapticd/abi.h"

namespace hapticd::host {

/// [any] Returns a parameter of a class. @param index less than `param_count`
template <class Class>
const hsp_param& paramAt(const Class& described, uint32_t index) noexcept {
  return *HSP_AT(const hsp_param, described.params, described.params[0].struct_size, index);
}

/// [any] Returns the index of the parameter with this id; nothing if the class has no such parameter.
template <class Class>
std::optional<uint32_t> paramIndexOf(const Class& described, std::string_view id) noexcept {
  for (uint32_t i = 0; i < described.param_count; ++i)
    if (id == paramAt(described, i).id) return i;
  return std::nullopt;
}

}  // namespace hapticd::host
