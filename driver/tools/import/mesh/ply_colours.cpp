// SPDX-License-Identifier: MIT
#include "mesh_import/ply_colours.hpp"

#include "mesh_import/mesh_colours.hpp"

namespace hapticd::importing::ply {
namespace {

/// Returns the value that means full colour.
double fullOf(Type type) {
  if (type == Type::kFloat || type == Type::kDouble) return 1;
  return type == Type::kUint16 ? 65535 : 255;
}

}  // namespace

void ItemColour::see(std::string_view name, Type type, double value) {
  constexpr std::string_view kNames[] = {"red", "green", "blue"};
  for (unsigned k = 0; k < 3; ++k) {
    if (name != kNames[k]) continue;
    share_[k] = value / fullOf(type);
    seen_ |= 1u << k;
  }
}

std::uint32_t ItemColour::word() const {
  return seen_ == kAll ? colourWord(share_[0], share_[1], share_[2]) : 0;
}

}  // namespace hapticd::importing::ply
