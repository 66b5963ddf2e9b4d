// SPDX-License-Identifier: MIT
#include "playback.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace hapticd::view {

namespace {

constexpr double kSlowest = 0.01, kFastest = 100;

}  // namespace

Playback::Playback(const RowSource& rows, const Json& about)
    : rows_(rows), ticks_(rows.find("ticks")), last_(Clock::now()), ends_(rows.streams().size()) {
  const Json columns = about.value("columns", Json::object()).value("ticks", Json::array());
  for (const Json& column : columns)
    if (column.value("name", "") == "t") t_offset_ = column.value("offset", 0u);
  if (ticks_ >= rows.streams().size() || rows.end(ticks_) == 0) return;
  from_ = t_ = timeOf(0);
  to_ = timeOf(rows.end(ticks_) - 1);
  place();
}

double Playback::timeOf(uint64_t row) const {
  std::vector<std::byte> bytes(rows_.streams()[ticks_].row_bytes);
  double t = 0;
  if (rows_.copy(ticks_, row, 1, bytes.data()) == 1 && t_offset_ + sizeof t <= bytes.size())
    std::memcpy(&t, bytes.data() + t_offset_, sizeof t);
  return t;
}

/// Returns the number of the first row of `ticks` at the time t or later.
uint64_t Playback::tickAt(double t) const {
  uint64_t low = 0, high = rows_.end(ticks_);
  while (low < high) {
    const uint64_t middle = low + (high - low) / 2;
    if (timeOf(middle) < t)
      low = middle + 1;
    else
      high = middle;
  }
  if (low == rows_.end(ticks_)) --low;
  std::vector<std::byte> bytes(rows_.streams()[ticks_].row_bytes);
  uint64_t tick = 0;
  if (rows_.copy(ticks_, low, 1, bytes.data()) == 1) std::memcpy(&tick, bytes.data(), sizeof tick);
  return tick;
}

void Playback::place() {
  if (ticks_ >= ends_.size() || rows_.end(ticks_) == 0) return;
  const uint64_t tick = tickAt(t_);
  for (size_t i = 0; i < ends_.size(); ++i) ends_[i] = firstRowOf(rows_, i, tick + 1);
}

void Playback::advance() {
  const Clock::time_point now = Clock::now();
  const double passed = std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  if (!playing_ || to_ <= from_) return;
  t_ += passed * speed_;
  if (t_ >= to_) {
    changed_ = true;
    jumped_ = loop_;
    playing_ = loop_;
    t_ = loop_ ? from_ : to_;
  }
  place();
}

std::vector<uint64_t> Playback::rowsFrom(double seconds) const {
  std::vector<uint64_t> from(ends_.size(), 0);
  if (ticks_ >= ends_.size() || rows_.end(ticks_) == 0) return from;
  const uint64_t tick = tickAt(t_ - seconds);
  for (size_t i = 0; i < from.size(); ++i) from[i] = firstRowOf(rows_, i, tick);
  return from;
}

bool Playback::knows(const std::string& word) {
  return word == "play" || word == "pause" || word == "seek";
}

std::string Playback::execute(const Json& request) {
  const std::string word = request.value("do", "");
  const auto number = [&](const char* key, double otherwise) {
    const auto it = request.find(key);
    return it != request.end() && it->is_number() ? it->get<double>() : otherwise;
  };
  changed_ = true;
  if (word == "pause") {
    playing_ = false;
    return "";
  }
  if (word == "play") {
    const double speed = number("speed", speed_);
    if (!(speed >= kSlowest && speed <= kFastest))
      return "\"speed\": expected a number from 0.01 to 100 (1 is real time)";
    speed_ = speed;
    loop_ = request.contains("loop") && request["loop"].is_boolean() ? request["loop"].get<bool>() : loop_;
    jumped_ = jumped_ || t_ >= to_;
    if (t_ >= to_) t_ = from_;
    playing_ = true;
    last_ = Clock::now();
    return "";
  }
  const double t = number("t", NAN);
  if (!(t >= from_ - 1e-9 && t <= to_ + 1e-9))
    return fmt::format("\"t\": expected a time of the recording, from {:g} to {:g} s", from_, to_);
  t_ = std::clamp(t, from_, to_);
  jumped_ = true;
  place();
  return "";
}

bool Playback::takeJumped() {
  return std::exchange(jumped_, false);
}

bool Playback::takeChanged() {
  return std::exchange(changed_, false);
}

std::string Playback::stateJson() const {
  return Json({{"type", "playback"},
               {"from", from_},
               {"to", to_},
               {"t", t_},
               {"playing", playing_},
               {"speed", speed_},
               {"loop", loop_}})
      .dump();
}

}  // namespace hapticd::view
