// SPDX-License-Identifier: MIT
#include "cli/recording/joint_ranges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>

#include "cli/recording/joint_motion.hpp"
#include "cli/recording/tick_times.hpp"

namespace hapticd::cli {
namespace {

/// One time at which a joint stood at a stop.
struct Stay {
  double from = 0, to = 0;  ///< [s]
};

/// An end stop that a joint came to.
struct Stop {
  double position = 0;  ///< [rad or m]
  uint64_t ticks = 0;
  std::vector<Stay> stays;
};

/// Returns the times, such as "2 times: 0.9 to 2 s, 4.9 to 5.9 s"; no more than the first four.
std::string timesOf(const std::vector<Stay>& stays) {
  constexpr size_t kMost = 4;
  std::string all = std::to_string(stays.size()) + (stays.size() == 1 ? " time: " : " times: ");
  for (size_t i = 0; i < std::min(stays.size(), kMost); ++i) {
    char part[60];
    std::snprintf(part, sizeof part, "%s%.4g to %.4g s", i > 0 ? ", " : "", stays[i].from, stays[i].to);
    all += part;
  }
  return all + (stays.size() > kMost ? ", ..." : "");
}

/// How one joint moved.
class JointRange {
 public:
  void add(const JointMotion& joint, const JointPlace& place, double t) {
    turns_ = joint.turns(), unit_ = joint.unit();
    lowest_ = std::min(lowest_, place.position);
    highest_ = std::max(highest_, place.position);
    if (place.stop != 0) {
      Stop& stop = stops_[place.stop > 0 ? 1 : 0];
      stop.position = joint.limit(place.stop);
      ++stop.ticks;
      if (place.stop != last_) stop.stays.push_back({t, t});
      stop.stays.back().to = t;
    }
    last_ = place.stop;
  }

  std::string text(double rate) const {
    char part[120];
    const auto shown = [](double way) { return std::abs(way) < 1e-9 ? 0.0 : way; };  // rounding of quaternions
    std::snprintf(part, sizeof part, "%s from %.4g to %.4g %s", turns_ ? "turned" : "slid", shown(lowest_),
                  shown(highest_), unit_);
    std::string all = part;
    for (const Stop& stop : stops_) {
      if (stop.ticks == 0) continue;
      std::snprintf(part, sizeof part, "; at its stop at %.4g %s for %.3g s (", stop.position, unit_,
                    static_cast<double>(stop.ticks) / rate);
      all += part + timesOf(stop.stays) + ")";
    }
    return all;
  }

 private:
  bool turns_ = false;
  const char* unit_ = "";
  std::array<Stop, 2> stops_;  // lowest, highest
  int last_ = 0;               // JointPlace::stop of the last tick
  double lowest_ = 0, highest_ = 0;
};

}  // namespace

std::vector<std::string> jointRanges(const record::Recording& recording, const servo::RunModels& models, double rate) {
  std::map<size_t, JointRange> ranges;
  TickTimes times(recording);
  eachJointPlace(recording, models, [&](size_t model, const JointMotion& joint, double tick, const JointPlace& place) {
    ranges[model].add(joint, place, times.of(tick));
  });
  std::vector<std::string> lines;
  for (const auto& [model, range] : ranges) lines.push_back(models.all()[model].model.name + ": " + range.text(rate));
  return lines;
}

}  // namespace hapticd::cli
