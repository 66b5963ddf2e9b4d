// SPDX-License-Identifier: MIT
#include "capture/capture.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "capture/other_programs.hpp"

namespace hapticd::capture {
namespace {

int digitOf(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Parses "01 ff", "01,FF" or "0x01 0xff"; returns nothing for any other text.
std::optional<std::vector<uint8_t>> bytesIn(const std::string& text) {
  std::vector<uint8_t> bytes;
  for (size_t i = 0; i < text.size();) {
    if (text[i] == ' ' || text[i] == '\t' || text[i] == ',' || text[i] == ':' || text[i] == '\r') {
      ++i;
      continue;
    }
    if (text[i] == '0' && i + 1 < text.size() && (text[i + 1] == 'x' || text[i + 1] == 'X')) i += 2;
    const int high = i < text.size() ? digitOf(text[i]) : -1, low = i + 1 < text.size() ? digitOf(text[i + 1]) : -1;
    if (high < 0 || low < 0) return std::nullopt;
    bytes.push_back(static_cast<uint8_t>(high * 16 + low));
    i += 2;
  }
  return bytes;
}

/// Parses "E: 000012.345678 9 01 ...": hid-recorder gives seconds, a count and the bytes.
bool takeEvent(std::string& line, double& time) {
  if (line.rfind("E:", 0) != 0) return false;
  char* end = nullptr;
  time = std::strtod(line.c_str() + 2, &end);
  (void)std::strtol(end, &end, 10);
  line = end;
  return true;
}

/// Parses "@0.001234 01 ...", as `hapticd device record` writes it.
void takeTime(std::string& line, double& time) {
  if (line.empty() || line[0] != '@') return;
  char* end = nullptr;
  time = std::strtod(line.c_str() + 1, &end);
  line = end;
}

/// Returns true for the lines about the device that hid-recorder writes before its first event.
bool isHeading(const std::string& line) {
  return line.size() > 1 && line[1] == ':' && std::string("DRNIP").find(line[0]) != std::string::npos;
}

bool isPrintable(char c) {
  return (c >= ' ' && c <= '~') || c == '\n' || c == '\r' || c == '\t';
}

/// Returns the beginning of a line, made safe for a terminal whatever it contains.
std::string shown(const std::string& line) {
  constexpr size_t kShown = 40;
  std::string text = line.substr(0, kShown);
  std::replace_if(text.begin(), text.end(), [](char c) { return !isPrintable(c) || c == '\t'; }, '.');
  return text;
}

/// Returns advice for a text that cannot be read, or "" if its format is not recognised.
std::string otherForm(const std::string& text) {
  if (!std::all_of(text.begin(), text.end(), isPrintable))
    return "; the capture is binary, but --hex says that it is text with two digits a byte: leave --hex out";
  const bool dump = text.rfind("00000000", 0) == 0;  // as at the beginning of the output of xxd and hexdump -C
  return dump ? "; this is a dump with addresses: give the dumped file itself, or the output of `xxd -p -c SIZE`" : "";
}

Error notHexadecimal(int number, const std::string& line, const std::string& text) {
  const std::string form = otherForm(text);
  return Error{"line " + std::to_string(number) + ": \"" + shown(line) +
               "\" is not hexadecimal, expected two digits per byte and one report per line: 01 ff 3c" +
               (form.empty() ? formOfProgram(line) : form)};
}

/// Takes what other programs write before and after the bytes away from a line.
/// @param continues becomes true if the bytes belong to the transfer of the line before
Result<void> takeOther(std::string& line, Transfer& transfer, bool& continues) {
  if (const auto usbmon = usbmonLine(line)) {
    if (!*usbmon) return Error{usbmon->error()};
    line = (*usbmon)->digits, transfer.time = (*usbmon)->time;
  } else if (!takeEvent(line, transfer.time)) {
    takeTime(line, transfer.time);
    if (const auto offset = takeDumpOffset(line)) continues = *offset > 0;
  }
  return {};
}

Result<Capture> readText(const std::string& text) {
  Capture capture;
  capture.text = true;
  std::istringstream in(text);
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    line.erase(std::min(line.find('#'), line.size()));
    line.erase(0, line.find_first_not_of(" \t\r"));
    if (line.empty() || line[0] == '>' || isHeading(line)) continue;
    if (line[0] == '<') line.erase(0, 1), line.erase(0, line.find_first_not_of(' '));
    Transfer transfer;
    bool continues = false;
    if (const auto taken = takeOther(line, transfer, continues); !taken)
      return Error{"line " + std::to_string(number) + ": " + taken.error()};
    auto bytes = bytesIn(line);
    if (!bytes) return notHexadecimal(number, line, text);
    if (continues && !capture.transfers.empty()) {
      std::vector<uint8_t>& before = capture.transfers.back().bytes;
      before.insert(before.end(), bytes->begin(), bytes->end());
      continue;
    }
    transfer.bytes = std::move(*bytes);
    if (!transfer.bytes.empty()) capture.transfers.push_back(std::move(transfer));
  }
  return capture;
}

}  // namespace

size_t Capture::bytes() const {
  size_t all = 0;
  for (const Transfer& transfer : transfers) all += transfer.bytes.size();
  return all;
}

Result<Capture> readCapture(const std::string& bytes, Form form) {
  if (form == Form::kHex) return readText(bytes);
  if (form == Form::kGuess && std::all_of(bytes.begin(), bytes.end(), isPrintable)) {
    auto text = readText(bytes);
    if (text) return text;
    if (bytes.find_first_of(" \n\t,") != std::string::npos)
      return Error{text.error() + "; if these are raw bytes that only look like text, add --raw"};
  }
  Capture capture;
  if (!bytes.empty()) capture.transfers.push_back({-1, {bytes.begin(), bytes.end()}});
  return capture;
}

std::string hexText(const uint8_t* bytes, size_t count) {
  static const char kDigits[] = "0123456789abcdef";
  std::string text;
  for (size_t i = 0; i < count; ++i) {
    if (i > 0) text += ' ';
    text += kDigits[bytes[i] >> 4];
    text += kDigits[bytes[i] & 15];
  }
  return text;
}

}  // namespace hapticd::capture
