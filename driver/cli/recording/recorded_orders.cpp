// SPDX-License-Identifier: MIT
#include "cli/recording/recorded_orders.hpp"

#include <fmt/format.h>

#include <algorithm>
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
  explicit Names(const servo::RecordedRun& run) : run_(run), scene_(run.scene) {}

  std::string model(size_t place) const {
    return place < scene_.models.size() ? scene_.models[place].name : fmt::format("model {}", place);
  }
  std::string arm(size_t place) const {
    return place < scene_.devices.size() ? scene_.devices[place].name : fmt::format("arm {}", place);
  }
  /// Older recordings have the names of those parameters alone that the scene gives.
  std::string parameter(size_t place, uint32_t index) const {
    const auto live = run_.live.find(model(place));
    if (live != run_.live.end() && live->second.count(index) > 0) return live->second.at(index);
    if (place < scene_.models.size())
      for (const scene::Value& value : scene_.models[place].parameters)
        if (value.index == index) return value.id;
    return fmt::format("parameter {}", index);
  }

 private:
  const servo::RecordedRun& run_;
  const scene::Scene& scene_;
};

/// Returns "" for an order that is not told.
std::string words(const Row& row, const Names& names) {
  const bool force = row.param == static_cast<uint32_t>(Order::Led::kForce);
  switch (row.kind) {
    case Order::Kind::kEnable:
      return "enable " + names.model(row.target);
    case Order::Kind::kDisable:
      return "disable " + names.model(row.target);
    case Order::Kind::kMove:
      return "move " + names.model(row.target);
    case Order::Kind::kSet:
      return fmt::format("set {} {} {:g}", names.model(row.target), names.parameter(row.target, row.param), row.value);
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

std::vector<std::string> recordedOrders(const record::Recording& recording, const servo::RecordedRun& run) {
  std::vector<std::string> lines;
  const record::RecordedStream* orders = recording.stream("orders");
  if (orders == nullptr) return lines;
  std::array<const record::Column*, 5> columns{};
  constexpr const char* kNames[] = {"tick", "kind", "target", "param", "value"};
  for (size_t i = 0; i < columns.size(); ++i) {
    columns[i] = orders->find(kNames[i]);
    if (columns[i] == nullptr) return lines;
  }
  const Names names(run);
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
