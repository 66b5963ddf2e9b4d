// SPDX-License-Identifier: MIT
#include "import/unstated_unit.hpp"

#include <fmt/format.h>

#include "base/short_number.hpp"

namespace hapticd::importing {

std::string unstatedUnit(const Placement& placement, double largest) {
  if (placement.scale != 1 || placement.fit > 0) return "";
  const auto large = [&](double unit) { return shortNumber(1e3 * unit * largest) + " mm"; };
  return fmt::format(
      "the file states no unit, so metres were assumed: in millimetres it is {} large (--scale 0.001), in inches {} "
      "(--scale 0.0254)",
      large(0.001), large(0.0254));
}

}  // namespace hapticd::importing
