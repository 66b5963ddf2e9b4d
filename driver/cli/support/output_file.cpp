// SPDX-License-Identifier: MIT
#include "cli/support/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace hapticd::cli {

namespace {

constexpr size_t kHeadBytes = 8192;  ///< recordings need 512 bytes, reports their first lines

std::string headOf(const std::string& file) {
  std::string head(kHeadBytes, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<size_t>(in.gcount()));
  return head;
}

bool isOf(const OutputKind& kind, std::string_view head) {
  const bool begins = std::any_of(kind.beginnings.begin(), kind.beginnings.end(),
                                  [&](std::string_view beginning) { return head.starts_with(beginning); });
  return begins && head.find(kind.within) != std::string_view::npos;
}

}  // namespace

std::string whyNotWritable(const std::string& file) {
  if (file.empty()) return "";
  int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  const bool made = fd >= 0;
  // a pipe without a reader counts as not writable
  if (!made) fd = open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  if (made) unlink(file.c_str());
  if (fd >= 0 && close(fd) == 0) return "";
  return file + ": cannot be written, expected a file in a folder that you may write to";
}

const OutputKind& pictureKind() {
  static const OutputKind kind{"a picture (SVG)", {"<svg", "<?xml"}, "<svg", true};
  return kind;
}

const OutputKind& recordingKind() {
  static const OutputKind kind{"a recording", {"\x89HDF\r\n"}, "hapticd-recording/", true};
  return kind;
}

const OutputKind& reportKind() {
  static const OutputKind kind{"a report", {"{"}, "\"overruns\"", true};
  return kind;
}

const OutputKind& mcapKind() {
  static const OutputKind kind{"an MCAP file", {"\x89MCAP"}, {}, true};
  return kind;
}

const OutputKind& objKind() {
  static const OutputKind kind{"triangles of ctl geometry (OBJ)", {kObjBeginning}, {}, true};
  return kind;
}

const OutputKind& partKind() {
  static const OutputKind kind{"a part (.hpart)", {"hapticd-part/"}, {}, true};
  return kind;
}

const OutputKind& modelKind() {
  static const OutputKind kind{"a model file", {"#", "format: ", "{"}, "hapticd-model/"};
  return kind;
}

OutputKind tableKind(std::string_view header) {
  return {"a table of this command (CSV)", {header}};
}

std::string whyNotWritten(const std::string& out, const OutputKind& kind, const Inputs& inputs) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (out.empty() || (out == "-" && !kind.file_only)) return "";
  if (out == "-")
    return std::string("-: ") + kind.name + " goes to a file, not to standard output; expected a name, such as ./-";
  for (const auto& [file, what] : inputs)
    if (!file.empty() && fs::equivalent(out, file, error))
      return out + ": is " + what + " itself, expected another file";
  if (!fs::is_regular_file(out, error) || fs::file_size(out, error) == 0) return "";
  if (!std::ifstream(out, std::ios::binary) || isOf(kind, headOf(out))) return "";
  return out + ": exists already and is not " + kind.name + ", so it would be lost; expected a new name, or that of " +
         kind.name + " to be replaced\n  fix: give another name, or remove the file";
}

}  // namespace hapticd::cli
