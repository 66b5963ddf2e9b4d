// SPDX-License-Identifier: MIT
#include "cli/ctl/geometry.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <vector>

#include "cli/ctl/answer.hpp"
#include "cli/support/command.hpp"
#include "cli/support/output_file.hpp"
#include "control/client.hpp"
#include "document/json_text.hpp"

namespace hapticd::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Reads numbers from the memory of an answer. Returns an empty list if it has fewer.
template <class T>
std::vector<T> readNumbers(int memory, std::size_t first, std::size_t count) {
  std::vector<T> numbers(count);
  const std::size_t bytes = count * sizeof(T);
  for (std::size_t got = 0; got < bytes;) {
    const ssize_t more = pread(memory, reinterpret_cast<char*>(numbers.data()) + got, bytes - got,
                               static_cast<off_t>(first * sizeof(T) + got));
    if (more <= 0) return {};
    got += static_cast<std::size_t>(more);
  }
  return numbers;
}

int writeObj(const std::vector<float>& xyz, const std::vector<uint32_t>& corners, const std::string& file) {
  std::ofstream out(file);
  out << kObjBeginning << "\n";
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3)
    out << fmt::format("v {:.7g} {:.7g} {:.7g}\n", xyz[i], xyz[i + 1], xyz[i + 2]);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    out << fmt::format("f {} {} {}\n", corners[i] + 1, corners[i + 1] + 1, corners[i + 2] + 1);
  if (!(out << std::flush))
    return fail(kFailed, file + ": cannot be written, expected a file in a folder that you may write to");
  std::printf("%s: %zu vertices, %zu triangles\n", file.c_str(), xyz.size() / 3, corners.size() / 3);
  return kWorked;
}

}  // namespace

int saveGeometry(const std::string& socket, Json request, const std::string& file) {
  if (const std::string wrong = whyNotWritten(file, objKind()); !wrong.empty()) return fail(kBadInput, wrong);
  auto client = control::Client::connect(socket);
  if (!client) return fail(kFailed, client.error());
  request["as"] = "memory";
  const auto reply = client->askForMore(document::jsonLine(request), kDrawingPatience);
  if (!reply) return fail(kFailed, reply.error());
  const auto accepted = acceptedAnswer(reply->line);
  if (!accepted) return fail(exitCodeOf(reply->line), accepted.error());
  const Json& answer = *accepted;
  const std::size_t places = 3 * answer.value("vertices", std::size_t{0});
  const std::size_t before = answer.value("normals", false) ? 2 * places : places;
  const int memory = reply->descriptor.get();
  const auto xyz = readNumbers<float>(memory, 0, places);
  const auto corners = readNumbers<uint32_t>(memory, before, 3 * answer.value("triangles", std::size_t{0}));
  if (xyz.empty() || corners.empty())
    return fail(kFailed, "the daemon's triangles cannot be read: its memory is short");
  printNote(answer);
  return writeObj(xyz, corners, file);
}

}  // namespace hapticd::cli
