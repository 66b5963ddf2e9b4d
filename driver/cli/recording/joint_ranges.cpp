// SPDX-License-Identifier: MIT
#include "cli/recording/joint_ranges.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>

namespace hapticd::cli {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kHinge = 1;  // index of `hinge` among the words of `joint`

const scene::Value* valueOf(const scene::Model& model, const char* id) {
  const auto found = std::find_if(model.parameters.begin(), model.parameters.end(),
                                  [id](const scene::Value& value) { return value.id == id; });
  return found != model.parameters.end() ? &*found : nullptr;
}

/// The joint of a model, and how it moved.
class JointRange {
 public:
  /// Returns nothing if the model has no joint with end stops.
  static std::optional<JointRange> of(const scene::Model& model) {
    const scene::Value *joint = valueOf(model, "joint"), *limits = valueOf(model, "limits");
    if (joint == nullptr || joint->number == 0 || limits == nullptr || limits->numbers.size() != 2) return {};
    const scene::Value* axis = valueOf(model, "axis");
    const bool given = axis != nullptr && axis->numbers.size() == 3;
    return JointRange(model.pose, given ? Vector3d(axis->numbers.data()) : Vector3d::UnitY(), joint->number == kHinge,
                      {limits->numbers[0], limits->numbers[1]});
  }

  void add(const Vector3d& position, const Quaterniond& orientation) {
    constexpr double kSame = 1e-6;  // [rad or m]
    const double now = turns_ ? angleOf(orientation) : axis_.dot(position - start_.position);
    last_ = now;
    lowest_ = std::min(lowest_, now);
    highest_ = std::max(highest_, now);
    for (size_t i = 0; i < stops_.size(); ++i) {
      const bool at = std::abs(now - stops_[i].position) < kSame;
      stops_[i].ticks += at ? 1 : 0;
      stops_[i].times += at && !stops_[i].now ? 1 : 0;
      stops_[i].now = at;
    }
  }

  std::string text(double rate) const {
    const char* unit = turns_ ? "rad" : "m";
    char part[120];
    std::snprintf(part, sizeof part, "%s from %.4g to %.4g %s", turns_ ? "turned" : "slid", lowest_ + 0.0,
                  highest_ + 0.0, unit);
    std::string all = part;
    for (const Stop& stop : stops_) {
      if (stop.ticks == 0) continue;
      std::snprintf(part, sizeof part, "; at its stop at %.4g %s for %.3g s (%llu time%s)", stop.position, unit,
                    static_cast<double>(stop.ticks) / rate, static_cast<unsigned long long>(stop.times),
                    stop.times == 1 ? "" : "s");
      all += part;
    }
    return all;
  }

 private:
  struct Stop {
    double position = 0;  ///< [rad or m]
    bool now = false;     ///< true if the joint stood there in the last tick
    uint64_t ticks = 0, times = 0;
  };

  JointRange(const scene::Pose& start, const Vector3d& axis, bool turns, const std::array<double, 2>& limits)
      : start_(start), axis_((start.orientation * axis).normalized()), turns_(turns) {
    for (size_t i = 0; i < limits.size(); ++i) stops_[i].position = limits[i];
  }

  /// Returns the angle since the start, which counts whole turns.
  double angleOf(const Quaterniond& orientation) const {
    const Quaterniond turn = orientation * start_.orientation.conjugate();
    const double angle = 2 * std::atan2(turn.vec().dot(axis_), turn.w());
    return last_ + std::remainder(angle - last_, 2 * M_PI);
  }

  scene::Pose start_;
  Vector3d axis_;  // in the world
  bool turns_;
  std::array<Stop, 2> stops_;
  double last_ = 0, lowest_ = 0, highest_ = 0;
};

}  // namespace

std::vector<std::string> jointRanges(const record::Recording& recording, const scene::Scene& scene, double rate) {
  std::vector<std::optional<JointRange>> joints;
  for (const scene::Model& model : scene.models) joints.push_back(JointRange::of(model));
  const record::RecordedStream* poses = recording.stream("poses");
  if (poses == nullptr) return {};
  std::array<const record::Column*, 8> columns{};
  constexpr const char* kNames[] = {"model", "x", "y", "z", "qw", "qx", "qy", "qz"};
  for (size_t i = 0; i < columns.size(); ++i)
    if ((columns[i] = poses->find(kNames[i])) == nullptr) return {};
  std::vector<bool> moved(joints.size());
  for (uint64_t row = 0; row < poses->rows(); ++row) {
    const auto at = [&](size_t column) { return poses->number(row, *columns[column]); };
    const auto model = static_cast<size_t>(at(0));
    if (model >= joints.size() || !joints[model]) continue;  // others were added during the run
    joints[model]->add({at(1), at(2), at(3)}, {at(4), at(5), at(6), at(7)});
    moved[model] = true;
  }
  std::vector<std::string> lines;
  for (size_t i = 0; i < joints.size(); ++i)
    if (moved[i]) lines.push_back(scene.models[i].name + ": " + joints[i]->text(rate));
  return lines;
}

}  // namespace hapticd::cli
