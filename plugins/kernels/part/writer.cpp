// SPDX-License-Identifier: MIT
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>

#include "kernels/part/crc32c.hpp"
#include "kernels/part/file.hpp"
#include "kernels/part/sections.hpp"

namespace hapticd::brep {
namespace {

static_assert(std::endian::native == std::endian::little, "part files hold little-endian records");
using Json = nlohmann::ordered_json;

Json lossesOf(const Part& part) {
  Json losses = Json::array();
  for (const Loss& loss : part.losses) {
    Json entry = {{"what", loss.what}, {"reason", loss.reason}, {"size_m", loss.size}};
    if (loss.face != kNone) entry["face"] = loss.face;
    losses.push_back(std::move(entry));
  }
  return losses;
}

Json sourceOf(const Source& source) {
  Json json = {{"file", source.file}, {"sha256", source.sha256}, {"unit", source.unit}};
  if (source.unit_assumed) json["unit_assumed"] = true;
  if (source.scale != 1) json["scale"] = source.scale;
  if (!source.placed.empty()) json["placed"] = source.placed;
  return json;
}

}  // namespace

std::string writePart(const Part& part) {
  checkPart(part);
  Json header = {{"source", sourceOf(part.source)}, {"tolerance", part.tolerance}, {"names", part.names},
                 {"warnings", part.warnings},       {"losses", lossesOf(part)},    {"sections", Json::array()}};
  std::string data;
  forEachSection(part, [&](const char* name, const auto& records) {
    if (records.empty()) return;
    const auto bytes = std::as_bytes(std::span(records));
    data.resize(alignedSection(data.size()), '\0');
    header["sections"].push_back({{"name", name},
                                  {"offset", data.size()},
                                  {"count", records.size()},
                                  {"record", sizeof records[0]},
                                  {"crc32c", crc32c(bytes)}});
    data.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  });
  // Names come from other programs, so bytes that are not UTF-8 are replaced.
  const std::string text = header.dump(-1, ' ', false, Json::error_handler_t::replace);
  const auto length = static_cast<std::uint32_t>(text.size());
  std::string file = kPartMagic;
  char four[sizeof length];
  std::memcpy(four, &length, sizeof length);
  file.append(four, sizeof four);
  file += text;
  file.resize(alignedSection(file.size()), '\0');
  return file + data;
}

}  // namespace hapticd::brep
