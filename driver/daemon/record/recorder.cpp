// SPDX-License-Identifier: MIT
#include "record/recorder.hpp"

#include <algorithm>

#include "base/clock.hpp"

namespace hapticd::record {

namespace {

constexpr size_t kBufferBytes = 1 << 20;
constexpr Nanoseconds kPause = 20'000'000;  ///< [ns] time between two copies. If the process is killed, the file lacks
                                            ///< rows of this time; the black box has them

}  // namespace

Result<std::unique_ptr<Recorder>> Recorder::create(const FlightRing& ring, const std::string& file) {
  auto recording = RecordingFile::create(file, ring.specs(), ring.about());
  if (!recording) return Error{recording.error()};
  return std::unique_ptr<Recorder>(new Recorder(ring, std::move(*recording)));
}

Recorder::Recorder(const FlightRing& ring, std::unique_ptr<RecordingFile> recording)
    : ring_(ring), recording_(std::move(recording)), next_(ring.specs().size()), rows_(kBufferBytes) {}

std::error_code Recorder::start() {
  return thread_.start("hapticd-record", [this] {
    RealClock clock(0);
    while (!stop_.load(std::memory_order_relaxed)) {
      drain();
      clock.waitUntil(clock.now() + kPause);
    }
  });
}

void Recorder::stop() {
  stop_.store(true, std::memory_order_relaxed);
  thread_.join();
}

void Recorder::drain() {
  // The rows of the first stream are the ticks. They are written after all other rows of their tick, so their number is
  // read first: then the other streams have all rows of these ticks.
  std::vector<uint64_t> ends;
  for (size_t i = 0; i < next_.size(); ++i) ends.push_back(ring_.written(i));
  for (size_t i = 0; i < next_.size() && !failed(); ++i) follow(i, ends[i]);
  if (failed()) return;
  if (auto published = recording_->publish(); !published) {
    error_ = published.error();
    failed_.store(true, std::memory_order_relaxed);
  }
}

void Recorder::follow(size_t stream, uint64_t end) {
  const uint64_t at_once = std::max<uint64_t>(rows_.size() / ring_.rowBytes(stream), 1);
  while (next_[stream] < end) {
    const uint64_t got = ring_.copy(stream, next_[stream], std::min(at_once, end - next_[stream]), rows_.data());
    if (got == 0) {  // the rows were overwritten: continue with newer rows, which are not overwritten while it copies
      const uint64_t newest = ring_.written(stream), kept = ring_.capacity(stream) / 2;
      const uint64_t resume = std::max(next_[stream] + 1, newest > kept ? newest - kept : 0);
      recording_->lost(stream, resume - next_[stream]);
      next_[stream] = resume;
      continue;
    }
    if (auto done = recording_->append(stream, rows_.data(), got); !done) {
      error_ = done.error();
      failed_.store(true, std::memory_order_relaxed);
      return;
    }
    next_[stream] += got;
  }
}

bool Recorder::behind() const noexcept HSP_RT {
  for (size_t i = 0; i < next_.size() && !failed(); ++i)
    if (ring_.written(i) - next_[i].load(std::memory_order_relaxed) > ring_.capacity(i) / 2) return true;
  return false;
}

uint64_t Recorder::lost() const {
  uint64_t lost = 0;
  for (size_t i = 0; i < next_.size(); ++i) lost += recording_->lostRows(i);
  return lost;
}

Result<void> Recorder::finish() {
  stop();
  drain();
  if (failed()) return Error{error_};
  return recording_->close();
}

}  // namespace hapticd::record
