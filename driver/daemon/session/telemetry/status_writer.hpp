// SPDX-License-Identifier: MIT
/// Writes each tick to the status page.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "record/contact_statistics.hpp"
#include "servo/arm/arm.hpp"
#include "servo/core/core.hpp"
#include "status/page_file.hpp"

namespace hapticd::servo {

class StatusWriter {
 public:
  /// [main] Writes all names, then makes the page valid for readers.
  StatusWriter(std::unique_ptr<status::PageFile> file, const scene::Scene& scene, const Arms& arms, double rate);

  /// [main] Called when a model takes a place, or leaves it (an empty name).
  void name(uint32_t place, const std::string& name, const std::string& plugin);

  /// [main] Called when a program begins or stops pushing on an arm. @param pid 0 if it has stopped
  void pusher(uint32_t arm, uint32_t place, uint64_t pid, const std::string& program);

  /// [rt] Called after a tick. Copies only models that changed, so models far away cost nothing.
  /// @param books statistics by the place of a model
  void tick(const status::TickStatus& now, Nanoseconds late, Nanoseconds spent, const Core& core, const Arms& arms,
            std::span<const record::ContactStatistics> books) noexcept HSP_RT;

  const status::Page& page() const { return file_->page(); }

 private:
  void pushers(uint32_t index, const ClientForces& clients) noexcept HSP_RT;
  void models(uint64_t tick, const Core& core, std::span<const record::ContactStatistics> books) noexcept HSP_RT;
  std::unique_ptr<status::PageFile> file_;
};

}  // namespace hapticd::servo
