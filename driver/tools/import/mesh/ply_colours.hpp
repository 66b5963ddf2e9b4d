// SPDX-License-Identifier: MIT
/// The colour of an item of a PLY file, a vertex or a face: red, green and blue.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "mesh_import/ply_body.hpp"

namespace hapticd::importing::ply {

class ItemColour {
 public:
  void beginItem() { seen_ = 0; }

  /// Takes a value of an item, if it is one of a colour.
  void see(std::string_view name, Type type, double value);

  /// Returns the colour of the item; 0 if it has none.
  std::uint32_t word() const;

 private:
  static constexpr unsigned kAll = 7;
  std::array<double, 3> share_{};  ///< 0 to 1
  unsigned seen_ = 0;              ///< bit k: share_[k] has come
};

}  // namespace hapticd::importing::ply
