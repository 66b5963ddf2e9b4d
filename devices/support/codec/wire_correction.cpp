// SPDX-License-Identifier: MIT
#include "codec/wire_correction.hpp"

#include <cctype>
#include <utility>
#include <vector>

#include "codec/checksum.hpp"
#include "document/suggestion.hpp"

namespace hapticd::codec {
namespace {

/// Keeps only letters and digits, in lower case: catalogues differ in the other characters.
std::string squeezed(const std::string& text) {
  std::string out;
  for (const char c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

std::string asked(const std::string& name) {
  return " (did you mean \"" + name + "\"?)";
}

}  // namespace

std::string suggestType(const std::string& text) {
  static const std::pair<const char*, const char*> kWords[] = {
      {"short", "i16"}, {"char", "i8"}, {"byte", "u8"},   {"word", "u16"},   {"long", "i32"},
      {"int", "i32"},   {"bool", "u1"}, {"float", "f32"}, {"double", "f64"}, {"real", "f32"}};
  std::string word = squeezed(text);
  for (const auto& [theirs, ours] : kWords)
    if (word == theirs) return asked(ours);
  if (word.size() > 1 && word.back() == 't' && std::isdigit(static_cast<unsigned char>(word[word.size() - 2])) != 0)
    word.pop_back();  // int24_t
  const size_t digits = word.find_first_of("0123456789");
  if (digits == std::string::npos || word.find_first_not_of("0123456789", digits) != std::string::npos) return "";
  const std::string kind = word.substr(0, digits), bits = word.substr(digits);
  if (kind == "int" || kind == "s" || kind == "sint" || kind == "signed") return asked("i" + bits);
  if (kind == "uint" || kind == "ui" || kind == "unsigned" || kind == "bits") return asked("u" + bits);
  if (kind == "float" || kind == "real") return asked(bits == "64" ? "f64" : "f32");
  return "";
}

std::string suggestMethod(const std::string& text) {
  const std::string word = squeezed(text);
  std::string inside;
  std::vector<std::string> all{"sum", "xor", "sum8", "xor8", "crc"};
  for (const NamedCrc& named : namedCrcs()) {
    const std::string known = squeezed(named.name);
    if (word == known) return asked(named.name);
    if (inside.empty() && word.size() > 2 && known.find(word) != std::string::npos) inside = named.name;
    all.emplace_back(named.name);
  }
  return inside.empty() ? document::suggestion(text, all) : asked(inside);
}

}  // namespace hapticd::codec
