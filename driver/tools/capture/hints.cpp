// SPDX-License-Identifier: MIT
#include "capture/hints.hpp"

#include "capture/checksum_hint.hpp"
#include "capture/layout_hint.hpp"

namespace hapticd::capture {

std::string hintsOf(const codec::Wire& wire, const Capture& capture, const Decoded& decoded) {
  const std::string layout = layoutHint(wire, capture, decoded);
  return layout.empty() ? checksumHint(wire, decoded) : layout;  // whatever else is wrong follows from the layout
}

}  // namespace hapticd::capture
