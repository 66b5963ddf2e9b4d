// SPDX-License-Identifier: MIT
#include "device_check/sample_check.hpp"

#include <cmath>
#include <cstdio>

#include "host/class_table.hpp"

namespace hapticd::device_check {
namespace {

std::string numbered(const char* what, uint32_t joint) {
  return std::string(what) + "[" + std::to_string(joint) + "]";
}

}  // namespace

std::string SampleCheck::wrongNumbers(const hdv_sample& sample) const {
  for (uint32_t i = 0; i < info_.joint_count; ++i) {
    if (!std::isfinite(sample.position[i])) return numbered("position", i);
    if ((sample.flags & HDV_S_VELOCITY) != 0 && !std::isfinite(sample.velocity[i])) return numbered("velocity", i);
    if ((sample.flags & HDV_S_TORQUE) != 0 && !std::isfinite(sample.torque[i])) return numbered("torque", i);
  }
  return "";
}

std::string SampleCheck::look(const Reading& reading) {
  const hdv_sample& sample = *reading.sample;
  const std::string at = " at read number " + std::to_string(++reads_);
  if (reading.read < 0)
    return "read() gives " + host::statusName(reading.read) + at + ": the device would count as lost";
  if (reading.write < 0)
    return "write() gives " + host::statusName(reading.write) + at + ", though only HDV_OFF was asked for";
  if ((sample.flags & HDV_S_LOST) != 0) return ++lost_, "";
  if ((sample.flags & HDV_S_FAULT) != 0) return "samples carry HDV_S_FAULT" + at + ": the arm would get no force";
  if (const std::string name = wrongNumbers(sample); !name.empty())
    return "sample." + name + " is not a finite number" + at + ": a run would end the force there";
  constexpr uint64_t kFar = 100'000'000;  // [ns]
  const bool fresh = reads_ == 1 || sample.sequence != last_;
  fresh_ += fresh ? 1 : 0;
  last_ = sample.sequence;
  timeless_ += sample.time_ns == 0 ? 1 : 0;
  ahead_ += sample.time_ns > reading.now_ns + kFar ? 1 : 0;
  behind_ += fresh && sample.time_ns != 0 && sample.time_ns + kFar < reading.now_ns ? 1 : 0;
  flags_ |= sample.flags, buttons_ |= sample.buttons;
  for (uint32_t i = 0; i < info_.joint_count && beyond_ < 0; ++i) {
    const double way = info_.position_max[i] - info_.position_min[i];
    if (!(way > 0) || !std::isfinite(way)) continue;
    const double beyond =
        std::max(sample.position[i] - info_.position_max[i], info_.position_min[i] - sample.position[i]);
    if (beyond > way) beyond_ = static_cast<int>(i), beyond_at_ = sample.position[i];
  }
  return "";
}

Finding SampleCheck::sum() const {
  char text[240];
  if (lost_ > 0)
    return Finding::warned(std::to_string(lost_) + " of " + std::to_string(reads_) + " samples carry HDV_S_LOST");
  if (fresh_ <= 1)
    return Finding::failed(
        "hdv_sample.sequence does not grow: " + std::to_string(reads_) +
        " reads gave the same sequence number; a run takes the force away after 50 ms without a new one; expected a "
        "larger number with each new sample");
  if (timeless_ == reads_)
    return Finding::warned(
        "hdv_sample.time_ns is never set; expected the time of the measurement, on the clock of now_ns");
  if (ahead_ > 0)
    return Finding::warned(
        "hdv_sample.time_ns is more than 0.1 s ahead of now_ns; expected the time of the measurement, on the "
        "clock of now_ns");
  if (2 * behind_ > fresh_)
    return Finding::warned(
        "hdv_sample.time_ns is more than 0.1 s behind now_ns in new samples; expected the time of the measurement, in "
        "ns on the clock of now_ns");
  if (beyond_ >= 0) {
    std::snprintf(text, sizeof text,
                  "position[%d] is %.4g, but open() says that this joint goes from %.4g to %.4g; positions must be in "
                  "rad, or in m if the joint slides",
                  beyond_, beyond_at_, info_.position_min[beyond_], info_.position_max[beyond_]);
    return Finding::warned(text);
  }
  if (info_.buttons < 32 && (buttons_ >> info_.buttons) != 0)
    return Finding::warned("a button beyond the " + std::to_string(info_.buttons) + " of hdv_info.buttons is down");
  for (const auto& [claim, flag, name] :
       {std::tuple{HDV_C_VELOCITY, HDV_S_VELOCITY, "VELOCITY"}, {HDV_C_TORQUE, HDV_S_TORQUE, "TORQUE"}})
    if ((info_.capabilities & claim) != 0 && (flags_ & flag) == 0)
      return Finding::failed(std::string("open() claims HDV_C_") + name + ", but no sample carries HDV_S_" + name +
                             "; expected both or none");
  return Finding::passed(std::to_string(reads_) + " reads, " + std::to_string(fresh_) + " new samples");
}

}  // namespace hapticd::device_check
