// SPDX-License-Identifier: MIT
#include "session/messages/place_names.hpp"

#include <algorithm>
#include <utility>

namespace hapticd::servo {

void PlaceNames::came(uint32_t place, uint64_t tick, Named named) {
  const std::lock_guard lock(mutex_);
  if (place >= places_.size()) places_.resize(place + 1);
  auto& tenants = places_[place];
  if (tenants.size() == kMostKept) tenants.erase(tenants.begin());
  tenants.push_back({tick, std::move(named)});
}

PlaceNames::Named PlaceNames::of(const hapticd_event& event) const {
  const std::lock_guard lock(mutex_);
  const auto place = static_cast<size_t>(event.model);
  if (event.model < 0 || place >= places_.size() || places_[place].empty()) return {};
  const auto& tenants = places_[place];
  // The tick that reports that a model has left can be the one that is next when another model takes its place.
  const auto had = [&](const Tenant& tenant) {
    return event.kind == HAPTICD_LEFT ? tenant.since < event.tick : tenant.since <= event.tick;
  };
  const auto newest = std::find_if(tenants.rbegin(), tenants.rend(), had);
  return newest != tenants.rend() ? newest->named : tenants.front().named;
}

}  // namespace hapticd::servo
