// SPDX-License-Identifier: MIT
/// Poses and triangles in the formats of ROS and Foxglove: transforms of models and tips in CDR, triangles as a scene.
#pragma once
#include <array>
#include <cstdint>
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

/// The frame of a model. A model of a recording is there from tick `since` until tick `until`; one of a running daemon
/// as long as the daemon lists it.
struct ModelFrame {
  Frame frame;
  uint32_t number = 0;  ///< of the model in rows, while it is there
  uint64_t since = 0, until = UINT64_MAX;
  bool moved = false;  ///< a row has given its pose
  bool isThere(uint64_t tick) const { return since <= tick && tick < until; }
};

/// Keeps the poses of models and tips up to date from the rows of a run.
class Frames {
 public:
  /// [main] @param about describes the run; it has the first pose of each model of the scene
  explicit Frames(const Json& about);

  /// [main] Takes the models in an answer to `list`, also those that came later. Poses from rows stay.
  void list(const Json& answer);

  /// [main] Takes rows of "ticks" or "poses", and ignores rows of other streams.
  void take(const std::string& stream, const std::byte* rows, uint64_t count, uint32_t row_bytes);

  std::vector<Frame> all() const;  ///< [main] frames of the models that are there in the newest tick, then of the tips
  const std::vector<ModelFrame>& models() const { return models_; }
  uint64_t tick() const { return tick_; }  ///< [main] the newest tick

 private:
  std::vector<ModelFrame> models_;
  std::vector<Frame> tips_;
  uint64_t tick_ = 0;
  std::vector<uint32_t> tip_at_;  ///< [bytes] offset of each tip's position in a row of ticks
  uint32_t model_at_ = 0, pose_at_ = 0;
};

/// [any] Returns a tf2_msgs/msg/TFMessage in CDR, with its head. @param time_ns time since 1970
std::string tfMessage(const std::vector<Frame>& frames, uint64_t time_ns);

extern const char* const kTfDefinition;     ///< .msg text
extern const char* const kSceneDefinition;  ///< JSON Schema of foxglove.SceneUpdate, the part that is used

/// [any] Returns a foxglove.SceneUpdate in JSON that removes the entity of a model.
std::string sceneRemoval(const std::string& model, uint64_t time_ns);

/// [any] Returns a foxglove.SceneUpdate in JSON with one entity: the triangles of a mesh message (see mesh.hpp) in the
/// model's frame.
std::string sceneUpdate(const std::string& model, const std::string& mesh, uint64_t time_ns);

}  // namespace hapticd::view
