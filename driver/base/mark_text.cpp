// SPDX-License-Identifier: MIT
#include "base/mark_text.hpp"

#include <cstdint>

namespace hapticd {

namespace {

/// The forms of a character in UTF-8: the bits that mark its first byte, and the smallest character that needs it.
struct Form {
  unsigned char mask, mark;
  size_t bytes;
  uint32_t least;
};
constexpr Form kForms[] = {{0x80, 0x00, 1, 0}, {0xE0, 0xC0, 2, 0x80}, {0xF0, 0xE0, 3, 0x800}, {0xF8, 0xF0, 4, 0x10000}};
constexpr uint32_t kNone = UINT32_MAX;

/// Takes the first character from a text that is not empty. Returns kNone if it is not valid UTF-8.
uint32_t takeCharacter(std::string_view& text) {
  const auto first = static_cast<unsigned char>(text[0]);
  for (const Form& form : kForms) {
    if ((first & form.mask) != form.mark) continue;
    if (text.size() < form.bytes) return kNone;
    uint32_t value = first & static_cast<unsigned char>(~form.mask);
    for (size_t i = 1; i < form.bytes; ++i) {
      const auto next = static_cast<unsigned char>(text[i]);
      if ((next & 0xC0) != 0x80) return kNone;
      value = value << 6 | (next & 0x3F);
    }
    text.remove_prefix(form.bytes);
    const bool surrogate = value >= 0xD800 && value < 0xE000;
    return value < form.least || value > 0x10FFFF || surrogate ? kNone : value;
  }
  return kNone;
}

/// True for characters that are not shown: the controls of ASCII and of Latin-1, the separators of lines and
/// paragraphs, and those that turn the direction of the text around them.
bool isControl(uint32_t c) {
  return c < 0x20 || (c >= 0x7F && c < 0xA0) || (c >= 0x2028 && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
}

}  // namespace

bool isMarkText(std::string_view text) {
  if (text.empty() || text.size() > kMostMarkBytes) return false;
  while (!text.empty())
    if (const uint32_t c = takeCharacter(text); c == kNone || isControl(c)) return false;
  return true;
}

}  // namespace hapticd
