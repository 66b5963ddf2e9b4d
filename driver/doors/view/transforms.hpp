// SPDX-License-Identifier: MIT
/// Where everything is now, as ROS and Foxglove take it: transforms of models and tips in CDR, triangles as a scene.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "daemon.hpp"
#include "row_source.hpp"

namespace hapticd::view {

/// A frame in the world.
struct Frame {
  std::string name;
  std::array<double, 3> position{};               ///< [m]
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< w, x, y, z
};

/// Follows models and tips through the rows of a run.
class Frames {
 public:
  /// [main] @param about describes the run; models at rest are where its scene puts them
  explicit Frames(const Json& about);

  /// [main] Takes rows of "ticks" or "poses"; others are of no use here.
  void take(const std::string& stream, const std::byte* rows, uint64_t count, uint32_t row_bytes);

  std::vector<Frame> all() const;  ///< [main] models, then tips

 private:
  std::vector<Frame> models_, tips_;
  std::vector<uint32_t> tip_at_;  ///< [bytes] where the place of each tip begins in a row of ticks
  uint32_t model_at_ = 0, pose_at_ = 0;
};

/// [any] tf2_msgs/msg/TFMessage in CDR, with its head. @param time_ns since 1970
std::string tfMessage(const std::vector<Frame>& frames, uint64_t time_ns);

extern const char* const kTfDefinition;     ///< .msg text
extern const char* const kSceneDefinition;  ///< JSON Schema of foxglove.SceneUpdate, the part that is used

/// [any] foxglove.SceneUpdate in JSON with one entity: the triangles of a message (see mesh.hpp) in the model's frame.
std::string sceneUpdate(const std::string& model, const std::string& mesh, uint64_t time_ns);

}  // namespace hapticd::view
