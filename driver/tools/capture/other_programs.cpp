// SPDX-License-Identifier: MIT
#include "capture/other_programs.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <sstream>

namespace hapticd::capture {
namespace {

bool isHex(char c) {
  return std::isxdigit(static_cast<unsigned char>(c)) != 0;
}

bool allOf(const std::string& text, int (*test)(int)) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [&](char c) { return test(static_cast<unsigned char>(c)) != 0; });
}

/// Returns the number of characters of the bytes "01 ff 3c" at the beginning of a text, 16 at most.
size_t pairsIn(const std::string& text) {
  constexpr size_t kRow = 16;
  size_t at = 0;
  for (size_t pairs = 0; pairs < kRow && at + 1 < text.size(); ++pairs) {
    const bool pair = isHex(text[at]) && isHex(text[at + 1]) && (at + 2 == text.size() || text[at + 2] == ' ');
    if (!pair) break;
    at = std::min(at + 3, text.size());
    if (at < text.size() && text[at] == ' ') break;  // two spaces end the bytes
  }
  return at;
}

}  // namespace

std::optional<Result<UsbmonLine>> usbmonLine(const std::string& line) {
  std::istringstream in(line);
  std::string tag, stamp, event, address, status, length, mark;
  if (!(in >> tag >> stamp >> event >> address) || !allOf(tag, std::isxdigit) || !allOf(stamp, std::isdigit))
    return std::nullopt;
  const bool known = event.size() == 1 && std::string("SCE").find(event) != std::string::npos && address.size() > 3 &&
                     std::string("CZIB").find(address[0]) != std::string::npos && address[2] == ':';
  if (!known) return std::nullopt;
  UsbmonLine read;
  read.time = std::strtod(stamp.c_str(), nullptr) * 1e-6;
  const bool from_device = event == "C" && address[1] == 'i' && (address[0] == 'I' || address[0] == 'B');
  if (!from_device || !(in >> status >> length >> mark) || mark != "=") return read;
  for (std::string word; in >> word;) read.digits += word;
  const auto bytes = static_cast<size_t>(std::strtoul(length.c_str(), nullptr, 10));
  if (read.digits.size() / 2 < bytes)
    return Error{"usbmon has kept only " + std::to_string(read.digits.size() / 2) + " of the " + length +
                 " bytes of this transfer; capture with Wireshark, hid-recorder or `hapticd device record` instead"};
  return read;
}

std::optional<size_t> takeDumpOffset(std::string& line) {
  constexpr size_t kDigits = 4;
  if (line.size() < kDigits + 2 || line.compare(kDigits, 2, "  ") != 0) return std::nullopt;
  const std::string offset = line.substr(0, kDigits);
  if (!allOf(offset, std::isxdigit) || offset.back() != '0') return std::nullopt;
  const std::string rest = line.substr(std::min(line.find_first_not_of(' ', kDigits), line.size()));
  line = rest.substr(0, pairsIn(rest));
  return std::strtoul(offset.c_str(), nullptr, 16);
}

std::string formOfProgram(const std::string& line) {
  const bool bytes = line.rfind("b'", 0) == 0 || line.rfind("b\"", 0) == 0;
  if (bytes || line.rfind("bytearray(", 0) == 0)
    return "; Python has written this line: let it write report.hex(\" \") instead";
  const bool numbers = line.find_first_not_of("0123456789, ;\t\r[]()") == std::string::npos;
  return numbers && line.find_first_of(",; ") != std::string::npos
             ? "; these look like decimal numbers: in Python, bytes(numbers).hex(\" \") writes them as expected"
             : "";
}

}  // namespace hapticd::capture
