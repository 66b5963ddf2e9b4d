// SPDX-License-Identifier: MIT
/// Fuzzes wire formats (the JSON text of the parameter `wire`): reads them, and reads reports with those that are
/// taken. The bytes after the first zero byte are the report. Of a wrong one, the draft is examined as `hapticd check`
/// does.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <string_view>

#include "codec/report.hpp"
#include "codec/wire.hpp"
#include "codec/wire_overlap.hpp"

namespace {

using namespace hapticd::codec;

void need(bool good) {
  if (!good) std::abort();
}

void use(const Wire& wire, std::span<const std::uint8_t> report) {
  State state;
  if (decode(wire.input, report, state) == Verdict::kGood)
    for (const auto* numbers : {&state.position, &state.velocity, &state.torque})
      for (const double x : *numbers) need(std::isfinite(x));
  Order order;
  order.enable = true;
  order.torque.fill(1);
  std::array<std::uint8_t, kMaxReportBytes + 1> bytes{};
  need(encode(wire.output, order, bytes) == wire.output.bytes());
  need(outsideChecksum(wire.input).size() <= wire.input.fields.size());
}

void examine(const Wire& draft) {
  for (const Report* report : {&draft.input, &draft.output})
    for (const Field& field : report->fields) need(bitsTaken(field, report->size).size() == report->size);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view all(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::string text(all.substr(0, all.find('\0')));
  const std::size_t joints = data[0] % (kMaxJoints + 1);
  try {
    examine(draftOfWire(text, joints));
    (void)misplacedInWire(text, joints);
    const std::size_t rest = std::min(text.size() + 1, all.size());
    use(readWire(text, joints), {data + 1 + rest, size - 1 - rest});
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
