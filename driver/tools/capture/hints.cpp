// SPDX-License-Identifier: MIT
#include "capture/hints.hpp"

#include "capture/checksum_hint.hpp"
#include "capture/framing_hint.hpp"
#include "capture/layout_hint.hpp"
#include "capture/stream_hint.hpp"

namespace hapticd::capture {

std::string hintsOf(const codec::Wire& wire, const Capture& capture, const Decoded& decoded) {
  std::string layout = layoutHint(wire, capture, decoded);
  if (layout.empty()) layout = framingHint(wire, capture, decoded);
  if (layout.empty()) layout = streamHint(wire, capture, decoded);
  return layout.empty() ? checksumHint(wire, decoded) : layout;  // if the layout is wrong, other errors follow from it
}

}  // namespace hapticd::capture
