// SPDX-License-Identifier: MIT
#include "transforms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "mesh.hpp"

namespace hapticd::view {

namespace {

constexpr uint64_t kNanoseconds = 1'000'000'000;

/// Writes numbers in CDR. The offset of each number, counted from the end of the head, is a multiple of its size.
class Cdr {
 public:
  template <class T>
  void n(T value) {
    while ((bytes_.size() - kHead) % sizeof value != 0) bytes_ += '\0';
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes_.append(raw, sizeof raw);
  }
  void text(const std::string& value) {
    n(static_cast<uint32_t>(value.size() + 1));
    bytes_.append(value.c_str(), value.size() + 1);
  }
  std::string take() { return std::move(bytes_); }

 private:
  static constexpr size_t kHead = 4;
  std::string bytes_ = std::string("\0\1\0\0", kHead);
};

uint32_t offsetOf(const Json& about, const char* stream, const std::string& name) {
  const Json columns = about.value("columns", Json::object()).value(stream, Json::array());
  for (const Json& column : columns)
    if (column.value("name", "") == name) return column.value("offset", 0u);
  return 0;
}

/// Reads a frame from seven numbers: position and orientation.
void readFrame(const std::byte* at, Frame& frame) {
  std::memcpy(frame.position.data(), at, sizeof frame.position);
  std::memcpy(frame.orientation.data(), at + sizeof frame.position, sizeof frame.orientation);
}

constexpr size_t kFrameBytes = 7 * sizeof(double);

constexpr const char* kOwnColour = R"({"r":0.64,"g":0.72,"b":0.79,"a":1})";  ///< of models without colours

/// Returns the elements of a list of colours. @param words as in hsp_mesh
std::string coloursOf(const uint32_t* words, uint32_t count) {
  std::string text;
  for (uint32_t i = 0; i < count; ++i) {
    const auto share = [&](int byte) { return static_cast<double>(words[i] >> (8 * byte) & 255) / 255; };
    text += i == 0 ? "" : ",";
    text += words[i] == 0 ? kOwnColour
                          : fmt::format(R"({{"r":{:.4g},"g":{:.4g},"b":{:.4g},"a":1}})", share(0), share(1), share(2));
  }
  return text;
}

/// Returns the frame of a model of a scene or a list. @param place its place there, which is its number if none is
/// given
ModelFrame modelFrame(const Json& model, uint32_t place) {
  const auto number = [](const Json& value) { return value.is_number() ? value.get<double>() : 0.0; };
  ModelFrame listed;
  Frame& frame = listed.frame;
  frame.name = model.value("name", "");
  const Json pose = model.value("pose", Json::object());
  const Json position = pose.value("position", Json::array()), turn = pose.value("orientation", Json::array());
  for (size_t i = 0; i < position.size() && i < 3; ++i) frame.position[i] = number(position[i]);
  for (size_t i = 0; i < turn.size() && i < 4; ++i) frame.orientation[i] = number(turn[i]);
  const auto whole = [&](const char* key, uint64_t otherwise) {
    const auto it = model.find(key);
    return it != model.end() && it->is_number_unsigned() ? it->get<uint64_t>() : otherwise;
  };
  listed.number = static_cast<uint32_t>(whole("number", place));
  listed.since = whole("since", 0);
  listed.until = whole("until", UINT64_MAX);
  return listed;
}

}  // namespace

Frames::Frames(const Json& about) {
  list(about.value("scene", Json::object()));
  size_t arm = 0;
  for (const Json& device : about.value("devices", Json::array())) {
    tips_.push_back({device.value("name", "arm") + "_tip", {}, {1, 0, 0, 0}});
    tip_at_.push_back(offsetOf(about, "ticks", fmt::format("arm{}_x", arm++)));
  }
  model_at_ = offsetOf(about, "poses", "model");
  pose_at_ = offsetOf(about, "poses", "x");
}

void Frames::list(const Json& answer) {
  const std::vector<ModelFrame> former = std::move(models_);
  models_.clear();
  for (const Json& model : answer.value("models", Json::array())) {
    const ModelFrame listed = modelFrame(model, static_cast<uint32_t>(models_.size()));
    const auto known = std::find_if(former.begin(), former.end(), [&](const ModelFrame& one) {
      return one.frame.name == listed.frame.name && one.number == listed.number && one.since == listed.since;
    });
    models_.push_back(listed);
    if (known == former.end() || !known->moved) continue;
    models_.back().frame = known->frame;
    models_.back().moved = true;
  }
}

void Frames::take(const std::string& stream, const std::byte* rows, uint64_t count, uint32_t row_bytes) {
  if (count == 0) return;
  if (stream == "ticks") {
    const std::byte* newest = rows + (count - 1) * row_bytes;
    std::memcpy(&tick_, newest, sizeof tick_);
    for (size_t i = 0; i < tips_.size(); ++i)
      if (tip_at_[i] != 0 && tip_at_[i] + kFrameBytes <= row_bytes) readFrame(newest + tip_at_[i], tips_[i]);
    return;
  }
  if (stream != "poses" || pose_at_ + kFrameBytes > row_bytes) return;
  for (uint64_t i = 0; i < count; ++i) {
    const std::byte* row = rows + i * row_bytes;
    uint64_t tick = 0;
    uint32_t number = 0;
    std::memcpy(&tick, row, sizeof tick);
    std::memcpy(&number, row + model_at_, sizeof number);
    for (ModelFrame& model : models_) {
      if (model.number != number || !model.isThere(tick)) continue;
      readFrame(row + pose_at_, model.frame);
      model.moved = true;
    }
  }
}

std::vector<Frame> Frames::all() const {
  std::vector<Frame> frames;
  for (const ModelFrame& model : models_)
    if (model.isThere(tick_)) frames.push_back(model.frame);
  frames.insert(frames.end(), tips_.begin(), tips_.end());
  return frames;
}

std::string tfMessage(const std::vector<Frame>& frames, uint64_t time_ns) {
  Cdr cdr;
  cdr.n(static_cast<uint32_t>(frames.size()));
  for (const Frame& frame : frames) {
    cdr.n(static_cast<int32_t>(time_ns / kNanoseconds));
    cdr.n(static_cast<uint32_t>(time_ns % kNanoseconds));
    cdr.text("world");
    cdr.text(frame.name);
    for (const double p : frame.position) cdr.n(p);
    for (const size_t i : {1, 2, 3, 0}) cdr.n(frame.orientation[i]);  // ROS: x, y, z, w
  }
  return cdr.take();
}

const char* const kTfDefinition =
    "geometry_msgs/TransformStamped[] transforms\n"
    "================================================================================\n"
    "MSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform "
    "transform\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
    "================================================================================\n"
    "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
    "================================================================================\n"
    "MSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"
    "================================================================================\n"
    "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
    "================================================================================\n"
    "MSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n";

const char* const kSceneDefinition =
    R"({"title":"foxglove.SceneUpdate","type":"object","properties":{"deletions":{"type":"array","items":{"type":"object",)"
    R"("properties":{"timestamp":{"type":"object","properties":{"sec":{"type":"integer"},"nsec":{"type":"integer"}}},)"
    R"("type":{"type":"integer"},"id":{"type":"string"}}}},)"
    R"("entities":{"type":"array","items":{"type":"object","properties":{"timestamp":{"type":"object","properties":)"
    R"({"sec":{"type":"integer"},"nsec":{"type":"integer"}}},"frame_id":{"type":"string"},"id":{"type":"string"},)"
    R"("lifetime":{"type":"object"},"frame_locked":{"type":"boolean"},"metadata":{"type":"array"},"triangles":)"
    R"({"type":"array","items":{"type":"object"}}}}}}})";

std::string sceneRemoval(const std::string& model, uint64_t time_ns) {
  return fmt::format(R"({{"deletions":[{{"timestamp":{{"sec":{},"nsec":{}}},"type":0,"id":{}}}],"entities":[]}})",
                     time_ns / kNanoseconds, time_ns % kNanoseconds, Json(model).dump());
}

std::string sceneUpdate(const std::string& model, const std::string& mesh, uint64_t time_ns) {
  uint32_t head[4];
  std::memcpy(head, mesh.data(), sizeof head);
  const uint32_t vertices = head[1], triangles = head[2];
  const auto* xyz = reinterpret_cast<const float*>(mesh.data() + sizeof head);
  const std::size_t per_vertex = (head[3] & kHasNormals) != 0 ? 6 : 3;
  const auto* corners = reinterpret_cast<const uint32_t*>(xyz + per_vertex * vertices);
  const std::string time = fmt::format(R"({{"sec":{},"nsec":{}}})", time_ns / kNanoseconds, time_ns % kNanoseconds);
  const std::string name = Json(model).dump();
  std::string text = fmt::format(
      R"({{"deletions":[],"entities":[{{"timestamp":{},"frame_id":{},"id":{},"lifetime":{{"sec":0,"nsec":0}},)"
      R"("frame_locked":true,"metadata":[],"arrows":[],"cubes":[],"spheres":[],"cylinders":[],"lines":[],"texts":[],)"
      R"("models":[],"triangles":[{{"pose":{{"position":{{"x":0,"y":0,"z":0}},"orientation":{{"x":0,"y":0,"z":0,"w":1}}}},)"
      R"("color":{},"colors":[)",
      time, name, name, kOwnColour);
  if ((head[3] & kHasColours) != 0) text += coloursOf(corners + std::size_t{3} * triangles, vertices);
  text += R"(],"points":[)";
  for (uint32_t i = 0; i < vertices; ++i)
    text += fmt::format(R"({}{{"x":{:.7g},"y":{:.7g},"z":{:.7g}}})", i == 0 ? "" : ",", xyz[3 * i], xyz[3 * i + 1],
                        xyz[3 * i + 2]);
  text += R"(],"indices":[)";
  for (uint32_t i = 0; i < 3 * triangles; ++i) text += fmt::format("{}{}", i == 0 ? "" : ",", corners[i]);
  return text + "]}]}]}";
}

}  // namespace hapticd::view
