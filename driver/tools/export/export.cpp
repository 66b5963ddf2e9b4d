// SPDX-License-Identifier: MIT
#include "export/export.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/regular_file.hpp"
#include "export/mcap.hpp"
#include "export/ros_message.hpp"

namespace hapticd::record {

namespace {

constexpr double kNanoseconds = 1e9;

/// [ns] Returns when the run started, since 1970; 0 if the recording does not say.
uint64_t startOf(const Recording& recording) {
  const auto about = nlohmann::json::parse(recording.aboutJson(), nullptr, false);
  if (!about.is_object() || !about.contains("started") || !about["started"].is_string()) return 0;
  const std::string text = about["started"];
  std::tm parts{};
  if (strptime(text.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts) == nullptr) return 0;
  const time_t seconds = timegm(&parts);
  return seconds > 0 ? static_cast<uint64_t>(seconds) * 1'000'000'000u : 0;
}

uint64_t tickOf(const RecordedStream& stream, uint64_t row) {
  uint64_t tick = 0;
  std::memcpy(&tick, stream.row(row), sizeof tick);
  return tick;
}

/// One stream that is being exported.
struct Outgoing {
  const RecordedStream* stream;
  uint16_t channel;
  uint64_t next = 0;
};

/// Writes the rows of a stream up to and including a tick.
void send(McapWriter& out, Outgoing& from, uint64_t tick, uint64_t time) {
  const RecordedStream& stream = *from.stream;
  const std::string_view head(kCdrHead.data(), kCdrHead.size());
  std::string encoded;
  for (; from.next < stream.rows() && tickOf(stream, from.next) <= tick; ++from.next)
    out.message(
        from.channel, time, head,
        cdrBody(stream.columns(), {reinterpret_cast<const char*>(stream.row(from.next)), stream.rowBytes()}, encoded));
}

/// Appends a text in quotes, because it may contain commas. Quotes in it are written twice (RFC 4180).
void appendText(std::string& line, const std::string& text) {
  line += '"';
  for (const char letter : text) line.append(letter == '"' ? 2 : 1, letter);
  line += '"';
}

void appendValue(std::string& line, const RecordedStream& stream, uint64_t row, const Column& column) {
  if (column.type == ColumnType::kText) return appendText(line, stream.text(row, column));
  const std::byte* at = stream.row(row) + column.offset;
  uint64_t count = 0;
  if (column.type == ColumnType::kCount) {  // not through a double, because it may have more than 53 bits
    std::memcpy(&count, at, sizeof count);
    line += fmt::format("{}", count);
    return;
  }
  const double value = stream.number(row, column);
  if (std::isnan(value))
    line += "nan";
  else if (column.type == ColumnType::kReal32)
    line += fmt::format("{:.9g}", value);
  else
    line += fmt::format("{:.17g}", value);
}

}  // namespace

Result<Exported> exportMcap(const Recording& recording, const std::string& file,
                            const std::vector<Attachment>& further) {
  auto out = McapWriter::create(file);
  if (!out) return Error{out.error()};
  std::vector<Outgoing> others;
  const RecordedStream* ticks = recording.stream("ticks");
  if (ticks == nullptr || ticks->find("t") == nullptr)
    return Error{"the recording has no ticks, expected at least one"};
  Outgoing clock{ticks, 0};
  for (const RecordedStream& stream : recording.streams()) {
    if (!liesAsCdr(stream.columns()))
      return Error{"rows of " + stream.name() +
                   " do not have the layout of CDR: a newer hapticd wrote them; use it to export them"};
    const uint16_t channel =
        (*out)->addChannel("/hapticd/" + stream.name(), rosType(stream.name()), rosDefinition(stream.columns()));
    if (&stream == ticks)
      clock.channel = channel;
    else
      others.push_back({&stream, channel});
  }
  const Column& t = *ticks->find("t");
  const uint64_t start = startOf(recording);
  uint64_t time = start;
  for (uint64_t row = 0; row < ticks->rows(); ++row) {
    const uint64_t tick = tickOf(*ticks, row);
    time = start + static_cast<uint64_t>(std::llround(std::max(0.0, ticks->number(row, t)) * kNanoseconds));
    for (Outgoing& other : others) send(**out, other, tick, time);
    send(**out, clock, tick, time);
  }
  for (Outgoing& other : others) send(**out, other, UINT64_MAX, time);
  (*out)->attach("about.json", "application/json", recording.aboutJson(), start);
  for (const Attachment& one : further) (*out)->attach(one.name, one.media_type, one.text, start);
  if (auto closed = (*out)->close(); !closed) return Error{closed.error()};
  return Exported{(*out)->messages(), (*out)->bytes()};
}

Result<Exported> exportCsv(const RecordedStream& stream, const std::string& file) {
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(file.c_str(), "wbe"), std::fclose);
  if (!out) return Error{file + ": cannot be written: " + std::strerror(errno)};
  Exported done;
  std::string line;
  const auto flush = [&] {
    done.bytes += line.size();
    const bool good = std::fwrite(line.data(), 1, line.size(), out.get()) == line.size();
    line.clear();
    return good;
  };
  for (const Column& column : stream.columns()) line += (line.empty() ? "" : ",") + column.name;
  line += "\n";
  bool good = flush();
  for (uint64_t row = 0; good && row < stream.rows(); ++row, ++done.rows) {
    for (size_t i = 0; i < stream.columns().size(); ++i) {
      if (i > 0) line += ",";
      appendValue(line, stream, row, stream.columns()[i]);
    }
    line += "\n";
    if (line.size() > (1u << 16)) good = flush();
  }
  if (good && flush() && std::fflush(out.get()) == 0) return done;
  const int code = errno;
  out.reset();
  removeIncomplete(file);
  return Error{file + ": could not be written completely, so it was removed: " + std::strerror(code)};
}

}  // namespace hapticd::record
