// SPDX-License-Identifier: MIT
#include "cli/device/content.hpp"

#include <filesystem>
#include <fstream>
#include <iostream>

#include "base/regular_file.hpp"

namespace hapticd::cli {

namespace {

constexpr size_t kMostMebibytes = 256, kMostBytes = kMostMebibytes << 20;

Result<std::string> streamed(std::istream& in) {
  std::string text;
  char part[16384];
  while (text.size() <= kMostBytes && (in.read(part, sizeof part), in.gcount() > 0))
    text.append(part, static_cast<size_t>(in.gcount()));
  if (text.size() <= kMostBytes) return text;
  return Error{"gives more than " + std::to_string(kMostMebibytes) + " MiB, the most that is read"};
}

}  // namespace

Result<std::string> contentOf(const std::string& file) {
  if (file == "-") return streamed(std::cin);
  std::error_code error;
  if (std::filesystem::status(file, error).type() != std::filesystem::file_type::fifo)
    return readRegular(file, kMostBytes);
  std::ifstream pipe(file, std::ios::binary);
  if (!pipe) return Error{"cannot be read"};
  return streamed(pipe);
}

}  // namespace hapticd::cli
