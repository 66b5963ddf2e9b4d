// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>

#include "kernels/part/crc32c.hpp"
#include "kernels/part/file.hpp"
#include "kernels/part/names.hpp"
#include "kernels/part/sections.hpp"

namespace hapticd::brep {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t kMagicLength = sizeof kPartMagic - 1;
constexpr std::size_t kHeadLength = kMagicLength + sizeof(std::uint32_t);
constexpr std::string_view kAnyMagic = "hapticd-part/";

struct Section {
  std::string name;
  std::uint64_t offset = 0, count = 0, record = 0;
  std::uint32_t crc = 0;
};

/// Reads a whole number from the header. @throws PartError
std::uint64_t wholeNumber(const Json& object, const char* key, const std::string& what) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number_unsigned())
    throw PartError(what + ": " + key +
                    " is missing, negative or not a whole number, expected a whole number of 0 or more");
  return found->get<std::uint64_t>();
}

std::string textAt(const Json& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  return found != object.end() && found->is_string() ? plainText(found->get<std::string>()) : "";
}

std::vector<std::string> textsAt(const Json& object, const char* key) {
  std::vector<std::string> texts;
  const auto found = object.find(key);
  if (found == object.end()) return texts;
  if (!found->is_array()) throw PartError(std::string("header: ") + key + " is not a list, expected a list of texts");
  for (const Json& text : *found) {
    if (!text.is_string())
      throw PartError(std::string("header: ") + key + " has an entry that is not a text, expected only texts");
    texts.push_back(plainText(text.get<std::string>()));
  }
  return texts;
}

double numberAt(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : 0;
}

Source readSource(const Json& header) {
  Source source{textAt(header, "file"), textAt(header, "sha256"), textAt(header, "unit")};
  source.placed = textAt(header, "placed");
  source.unit_assumed = header.is_object() && header.value("unit_assumed", Json()) == true;
  if (const double scale = header.is_object() ? numberAt(header, "scale") : 0; scale > 0) source.scale = scale;
  return source;
}

void readLosses(const Json& header, Part& part) {
  const auto losses = header.find("losses");
  if (losses == header.end()) return;
  if (!losses->is_array()) throw PartError("header: losses is not a list, expected a list of {what, reason, size_m}");
  for (const Json& entry : *losses) {
    if (!entry.is_object())
      throw PartError("header: an entry of losses is not an object, expected {what, reason, size_m}");
    Loss loss{textAt(entry, "what"), textAt(entry, "reason"), numberAt(entry, "size_m"), kNone};
    if (const auto face = entry.find("face"); face != entry.end() && face->is_number_unsigned())
      loss.face = static_cast<std::uint32_t>(std::min<std::uint64_t>(face->get<std::uint64_t>(), kNone));
    part.losses.push_back(std::move(loss));
  }
}

std::vector<Section> readSections(const Json& header) {
  const auto list = header.find("sections");
  if (list == header.end() || !list->is_array())
    throw PartError("header: sections is missing or not a list, expected a list");
  std::vector<Section> sections;
  for (const Json& entry : *list) {
    const std::string name = textAt(entry, "name");
    if (name.empty()) throw PartError("header: a section has no name, expected {name, offset, count, record, crc32c}");
    const std::string what = "section " + name;
    sections.push_back({name, wholeNumber(entry, "offset", what), wholeNumber(entry, "count", what),
                        wholeNumber(entry, "record", what),
                        static_cast<std::uint32_t>(wholeNumber(entry, "crc32c", what))});
  }
  return sections;
}

/// Returns the bytes of a section, after a check of their place, size and checksum.
std::span<const std::byte> bytesOf(const Section& section, std::span<const std::byte> data) {
  const std::string what = "section " + section.name;
  if (section.count > data.size() / section.record)
    throw PartError(what + ": " + std::to_string(section.count) + " records of " + std::to_string(section.record) +
                    " bytes, which is more than the file holds; the file may be incomplete");
  const std::uint64_t size = section.count * section.record;
  if (section.offset % kSectionAlignment != 0 || section.offset > data.size() || size > data.size() - section.offset)
    throw PartError(what + ": begins at byte " + std::to_string(section.offset) +
                    ", expected a multiple of 64 inside the file; the file may be incomplete");
  const auto bytes = data.subspan(section.offset, size);
  if (crc32c(bytes) != section.crc)
    throw PartError(what + ": its checksum differs, so the file was damaged; import the part again");
  return bytes;
}

/// Reads the records of a section. If an older version wrote shorter records, the missing members keep their defaults.
template <class Record>
void readRecords(const Section& section, std::span<const std::byte> data, std::vector<Record>& records) {
  if (section.record > sizeof(Record))
    throw PartError("section " + section.name + ": records of " + std::to_string(section.record) +
                    " bytes, expected at most " + std::to_string(sizeof(Record)) +
                    "; a newer hapticd wrote this file: import the part again with this one");
  // No version wrote records as short as this. A file could otherwise demand much more memory than its own size.
  if (2 * section.record < sizeof(Record))
    throw PartError("section " + section.name + ": records of " + std::to_string(section.record) + " bytes, expected " +
                    std::to_string(sizeof(Record)));
  const auto bytes = bytesOf(section, data);
  records.assign(section.count, Record{});
  if (section.record == sizeof(Record)) {
    if (!records.empty()) std::memcpy(static_cast<void*>(records.data()), bytes.data(), bytes.size());
    return;
  }
  for (std::size_t i = 0; i < records.size(); ++i)
    std::memcpy(static_cast<void*>(&records[i]), bytes.data() + i * section.record, section.record);
}

Json readHeader(std::span<const std::byte> bytes) {
  if (bytes.size() < kHeadLength || std::memcmp(bytes.data(), kPartMagic, kMagicLength) != 0)
    throw PartError(
        "not a part file (.hpart, format hapticd-part/1), expected one that hapticd import wrote: "
        "hapticd import FILE -o PART.hpart");
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + kMagicLength, sizeof length);
  if (length > bytes.size() - kHeadLength) throw PartError("the header is cut off; expected a complete file");
  const auto* text = reinterpret_cast<const char*>(bytes.data()) + kHeadLength;
  Json header = Json::parse(text, text + length, nullptr, false);
  if (!header.is_object()) throw PartError("the header is not a JSON object; import the part again");
  return header;
}

Part readBytes(std::span<const std::byte> bytes) {
  const Json header = readHeader(bytes);
  Part part;
  if (const auto source = header.find("source"); source != header.end()) part.source = readSource(*source);
  part.names = textsAt(header, "names");
  part.warnings = textsAt(header, "warnings");
  part.tolerance = numberAt(header, "tolerance");
  readLosses(header, part);
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + kMagicLength, sizeof length);
  const std::size_t begin = std::min(alignedSection(kHeadLength + length), bytes.size());
  const auto sections = readSections(header);
  forEachSection(part, [&](const char* name, auto& records) {
    const Section* wanted = nullptr;
    for (const Section& section : sections) {
      if (section.name != name) continue;
      if (wanted != nullptr) throw PartError("section " + section.name + ": occurs twice, expected once");
      wanted = &section;
    }
    if (wanted != nullptr) readRecords(*wanted, bytes.subspan(begin), records);
  });
  checkPart(part);
  return part;
}

}  // namespace

bool looksLikePart(std::span<const std::byte> bytes) noexcept {
  return bytes.size() >= kAnyMagic.size() && std::memcmp(bytes.data(), kAnyMagic.data(), kAnyMagic.size()) == 0;
}

Part readPart(std::span<const std::byte> bytes, const std::string& name) {
  try {
    return readBytes(bytes);
  } catch (const PartError& error) {
    throw PartError(name + ": " + error.what());
  }
}

}  // namespace hapticd::brep
