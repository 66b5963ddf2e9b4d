// SPDX-License-Identifier: MIT
/// The names of the models that have had the places of a run. A model that leaves gives its place to the next one, and
/// its last events may be reported later: they need the name of their own time.
#pragma once
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "hapticd/client.h"

namespace hapticd::servo {

class PlaceNames {
 public:
  /// A model with the file of its plugin, or an arm with its device file.
  struct Named {
    std::string name, file;
  };
  static constexpr size_t kMostKept = 64;  ///< names kept for a place; older events get the oldest of these

  /// [main] @param places most models that the run can have
  explicit PlaceNames(size_t places) : places_(places) {}

  /// [any] Called before the servo adopts a model into an empty place. @param tick number of the tick that is next
  void came(uint32_t place, uint64_t tick, Named named);

  /// [any] Returns the model that the event is about; an empty name if it is about none.
  Named of(const hapticd_event& event) const;

 private:
  struct Tenant {
    uint64_t since;  ///< first tick in which its events can be
    Named named;
  };
  mutable std::mutex mutex_;  // because the request worker adds models
  std::vector<std::vector<Tenant>> places_;
};

}  // namespace hapticd::servo
