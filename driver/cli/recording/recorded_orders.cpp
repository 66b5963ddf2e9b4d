// SPDX-License-Identifier: MIT
#include "cli/recording/recorded_orders.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>

#include "cli/recording/tick_times.hpp"
#include "servo/core/order.hpp"

namespace hapticd::cli {
namespace {

using servo::Order;

/// A row of the stream `orders`.
struct Row {
  double tick = 0, value = 0;
  Order::Kind kind = Order::Kind::kNone;
  size_t target = 0;
  uint32_t param = 0;
};

/// Names what the numbers of an order stand for.
class Names {
 public:
  Names(const servo::RecordedRun& run, const servo::RunModels& models) : run_(run), models_(models) {}

  std::string model(const Row& row) const { return models_.nameOf(static_cast<double>(row.target), row.tick); }
  std::string arm(size_t place) const {
    return place < run_.scene.devices.size() ? run_.scene.devices[place].name : fmt::format("arm {}", place);
  }
  /// Recordings name all live parameters of the scene's models; older ones, and those of later models, name only what
  /// the scene gives.
  std::string parameter(const Row& row) const {
    const size_t place = models_.find(static_cast<double>(row.target), row.tick);
    if (place == servo::RunModels::kNone) return fmt::format("parameter {}", row.param);
    const servo::RunModel& one = models_.all()[place];
    const auto live = one.since == 0 ? run_.live.find(one.model.name) : run_.live.end();
    if (live != run_.live.end() && live->second.count(row.param) > 0) return live->second.at(row.param);
    for (const scene::Value& value : one.model.parameters)
      if (value.index == row.param) return value.id;
    return fmt::format("parameter {}", row.param);
  }

 private:
  const servo::RecordedRun& run_;
  const servo::RunModels& models_;
};

/// Returns "" for an order that is not listed.
std::string words(const Row& row, const Names& names) {
  const bool force = row.param == static_cast<uint32_t>(Order::Led::kForce);
  switch (row.kind) {
    case Order::Kind::kEnable:
      return "enable " + names.model(row);
    case Order::Kind::kDisable:
      return "disable " + names.model(row);
    case Order::Kind::kMove:
      return "move " + names.model(row);
    case Order::Kind::kSet:
      return fmt::format("set {} {} {:g}", names.model(row), names.parameter(row), row.value);
    case Order::Kind::kClear:
      return "clear " + names.arm(row.target);
    case Order::Kind::kHold:
      return "hold " + names.arm(row.target);
    case Order::Kind::kLead:
      return force ? "a program pushes on " + names.arm(row.target) : "";
    case Order::Kind::kUnlead:
      return force ? "it pushes no longer on " + names.arm(row.target) : "";
    default:
      return "";
  }
}

}  // namespace

std::vector<std::string> recordedOrders(const record::Recording& recording, const servo::RecordedRun& run,
                                        const servo::RunModels& models) {
  std::vector<std::string> lines;
  const record::RecordedStream* orders = recording.stream("orders");
  if (orders == nullptr) return lines;
  std::array<const record::Column*, 5> columns{};
  constexpr const char* kNames[] = {"tick", "kind", "target", "param", "value"};
  for (size_t i = 0; i < columns.size(); ++i) {
    columns[i] = orders->find(kNames[i]);
    if (columns[i] == nullptr) return lines;
  }
  const Names names(run, models);
  TickTimes times(recording);
  for (uint64_t row = 0; row < orders->rows(); ++row) {
    const auto at = [&](size_t column) { return orders->number(row, *columns[column]); };
    const Row order{at(0), at(4), static_cast<Order::Kind>(at(1)), static_cast<size_t>(at(2)),
                    static_cast<uint32_t>(at(3))};
    if (const std::string text = words(order, names); !text.empty())
      lines.push_back(fmt::format("{:9.4f} s  {}", times.of(order.tick), text));
  }
  return lines;
}

}  // namespace hapticd::cli
