// SPDX-License-Identifier: MIT
#include "cli/recording/joint_motion.hpp"

#include <cmath>
#include <vector>

namespace hapticd::cli {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kHinge = 1;  // index of `hinge` among the words of `joint`

}  // namespace

std::optional<JointMotion> JointMotion::of(const scene::Model& model) {
  const scene::Value *joint = givenIn(model.parameters, "joint"), *limits = givenIn(model.parameters, "limits");
  const bool swings = model.plugin == "pendulum";  // it has no `joint`, and its pose in the scene is that of angle 0
  if (!swings && (joint == nullptr || joint->number == 0)) return {};
  const scene::Value *axis = givenIn(model.parameters, "axis"),
                     *angle = swings ? givenIn(model.parameters, "angle") : nullptr;
  const bool given = axis != nullptr && axis->numbers.size() == 3;
  const Vector3d usual = swings ? Vector3d::UnitZ() : Vector3d::UnitY();
  JointMotion motion(model.pose, given ? Vector3d(axis->numbers.data()) : usual, swings || joint->number == kHinge);
  if (angle != nullptr) motion.last_ = angle->number;  // from here the turns are counted
  if (limits != nullptr && limits->numbers.size() == 2) motion.limits_ = {limits->numbers[0], limits->numbers[1]};
  return motion;
}

JointPlace JointMotion::next(const Vector3d& position, const Quaterniond& orientation) {
  constexpr double kSame = 1e-6;  // [rad or m]
  if (turns_) {
    const Quaterniond turn = orientation * start_.orientation.conjugate();
    const double angle = 2 * std::atan2(turn.vec().dot(axis_), turn.w());
    last_ += std::remainder(angle - last_, 2 * M_PI);
  } else {
    last_ = axis_.dot(position - start_.position);
  }
  JointPlace place{last_, 0};
  if (!limits_) return place;
  if (std::abs(last_ - (*limits_)[0]) < kSame) place.stop = -1;
  if (std::abs(last_ - (*limits_)[1]) < kSame) place.stop = 1;
  return place;
}

void eachJointPlace(const record::Recording& recording, const servo::RunModels& models,
                    const std::function<void(size_t, const JointMotion&, double, const JointPlace&)>& take) {
  std::vector<std::optional<JointMotion>> joints;
  for (const servo::RunModel& one : models.all()) joints.push_back(JointMotion::of(one.model));
  const record::RecordedStream* poses = recording.stream("poses");
  if (poses == nullptr) return;
  std::array<const record::Column*, 9> columns{};
  constexpr const char* kNames[] = {"model", "x", "y", "z", "qw", "qx", "qy", "qz", "tick"};
  for (size_t i = 0; i < columns.size(); ++i) {
    columns[i] = poses->find(kNames[i]);
    if (columns[i] == nullptr) return;
  }
  for (uint64_t row = 0; row < poses->rows(); ++row) {
    const auto at = [&](size_t column) { return poses->number(row, *columns[column]); };
    const size_t model = models.find(at(0), at(8));
    if (model == servo::RunModels::kNone || !joints[model]) continue;
    take(model, *joints[model], at(8), joints[model]->next({at(1), at(2), at(3)}, {at(4), at(5), at(6), at(7)}));
  }
}

}  // namespace hapticd::cli
