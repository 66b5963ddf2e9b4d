// SPDX-License-Identifier: MIT
#include "foxglove.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <map>
#include <set>

#include "document/json_text.hpp"
#include "export/ros_message.hpp"
#include "mesh.hpp"
#include "transforms.hpp"

namespace hapticd::view {

namespace {

constexpr uint64_t kTickBytes = 1u << 20;  ///< [bytes] largest size of the rows of one stream that are sent at once
/// Triangles of all models together in /scene. They go as text, about 50 bytes each, and all at once.
constexpr uint32_t kSceneTriangles = 200000;
/// Ticks of the server (60 a second) in which a client names one topic after the other.
constexpr unsigned kSubscribing = 12;
constexpr char kMessageData = 1;  ///< op code of a message to a subscription

uint64_t wallNow() {
  return static_cast<uint64_t>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
          .count());
}

std::vector<record::Column> columnsOf(const Json& about, const std::string& stream) {
  std::vector<record::Column> columns;
  const Json list = about.value("columns", Json::object()).value(stream, Json::array());
  for (const Json& column : list)
    if (const auto type = record::typeOf(column.value("type", "")))
      columns.push_back({column.value("name", ""), column.value("unit", ""), column.value("doc", ""), *type,
                         column.value("offset", 0u)});
  return columns;
}

class FoxgloveSession final : public PeerSession {
 public:
  FoxgloveSession(Peer& peer, Stage& stage) : peer_(peer), stage_(stage), alive_(std::make_shared<bool>(true)) {}
  ~FoxgloveSession() override { *alive_ = false; }

  void onText(std::string_view text) override;
  void onBinary(std::span<const std::byte>) override {}  // this server ignores messages that clients publish
  void onTick() override;

 private:
  /// A channel of the protocol: a stream of rows, /tf or /scene.
  struct Channel {
    size_t stream = SIZE_MAX;  ///< number of the stream; SIZE_MAX for /tf and /scene
    Json advert;
    std::vector<record::Column> columns = {};  ///< of the stream
  };

  bool isReady();
  void begin();
  void advertise();
  void sendStream(size_t stream);
  void send(uint32_t subscription, uint64_t time, std::string_view head, std::string_view body);
  void sendTransforms();
  uint64_t untilChange(size_t stream) const;
  void takeList();
  void sendScene();
  uint32_t subscriptionOf(uint32_t channel) const;
  uint32_t tfChannel() const { return static_cast<uint32_t>(channels_.size()) - 1; }
  uint32_t sceneChannel() const { return static_cast<uint32_t>(channels_.size()); }

  Peer& peer_;
  Stage& stage_;
  std::shared_ptr<bool> alive_;
  uint64_t run_ = 0, list_number_ = 0, start_ = 0;
  std::vector<Channel> channels_;               ///< channel numbers count from 1
  std::map<uint32_t, uint32_t> subscriptions_;  ///< subscription -> channel
  std::vector<uint64_t> next_;
  std::unique_ptr<Frames> frames_;
  std::set<ModelKey> shown_;       ///< models whose triangles were sent to the subscriber of /scene
  unsigned since_subscribed_ = 0;  ///< ticks of the server since a subscription came
  size_t drawing_ = 0;             ///< number of models whose triangles were asked for and have not come
  uint32_t t_offset_ = 0;
  uint64_t newest_ = 0;  ///< [ns] time of the newest tick, since 1970
};

void FoxgloveSession::onTick() {
  if (stage_.rows() == nullptr) return;
  if (run_ != stage_.run()) begin();
  if (!peer_.idle()) return;  // the rows stay in the black box until later
  takeList();
  if (stage_.recorded() && !isReady()) return;
  for (size_t i = 0; i < next_.size(); ++i) sendStream(i);
  sendTransforms();
  sendScene();
}

/// A recording is sent from its start, once. So it waits until its client has subscribed to what it wants, for its
/// list, which says what each row means, and for triangles, which come before later rows.
bool FoxgloveSession::isReady() {
  const bool listed = list_number_ > 0 || !stage_.daemon().connected();
  return !subscriptions_.empty() && listed && drawing_ == 0 && ++since_subscribed_ > kSubscribing;
}

void FoxgloveSession::begin() {
  run_ = stage_.run();
  const RowSource& rows = *stage_.rows();
  next_.clear();
  for (size_t i = 0; i < rows.streams().size(); ++i) next_.push_back(stage_.recorded() ? 0 : rows.end(i));
  frames_ = std::make_unique<Frames>(stage_.about());
  list_number_ = 0;
  shown_.clear();
  t_offset_ = 0;
  for (const record::Column& column : columnsOf(stage_.about(), "ticks"))
    if (column.name == "t") t_offset_ = column.offset;
  start_ = 0;  // set when the first tick is seen
  peer_.text(Json({{"op", "serverInfo"},
                   {"name", "hapticd " + stage_.about().value("hapticd", "")},
                   {"capabilities", Json::array()},
                   {"supportedEncodings", Json::array()},
                   {"metadata", Json::object()},
                   {"sessionId", std::to_string(run_)}})
                 .dump());
  advertise();
}

void FoxgloveSession::advertise() {
  channels_.clear();
  subscriptions_.clear();
  const auto add = [&](size_t stream, const std::string& topic, const char* encoding, const std::string& type,
                       const char* schema_encoding, const std::string& schema) {
    const auto id = static_cast<uint32_t>(channels_.size() + 1);
    channels_.push_back({stream,
                         {{"id", id},
                          {"topic", topic},
                          {"encoding", encoding},
                          {"schemaName", type},
                          {"schemaEncoding", schema_encoding},
                          {"schema", schema}}});
  };
  const RowSource& rows = *stage_.rows();
  for (size_t i = 0; i < rows.streams().size(); ++i) {
    const std::string& name = rows.streams()[i].name;
    const auto columns = columnsOf(stage_.about(), name);
    if (!record::liesAsCdr(columns)) continue;
    add(i, "/hapticd/" + name, "cdr", record::rosType(name), "ros2msg", record::rosDefinition(columns));
    channels_.back().columns = columns;
  }
  add(SIZE_MAX, "/tf", "cdr", "tf2_msgs/msg/TFMessage", "ros2msg", kTfDefinition);
  add(SIZE_MAX, "/scene", "json", "foxglove.SceneUpdate", "jsonschema", kSceneDefinition);
  Json adverts = Json::array();
  for (const Channel& channel : channels_) adverts.push_back(channel.advert);
  peer_.text(document::jsonLine(Json({{"op", "advertise"}, {"channels", adverts}})));
}

/// Returns 1 + the client's number of a subscription to the channel, or 0 if nobody has subscribed. The client may
/// choose any number, including 0.
uint32_t FoxgloveSession::subscriptionOf(uint32_t channel) const {
  for (const auto& [subscription, of] : subscriptions_)
    if (of == channel) return subscription + 1;
  return 0;
}

/// Returns how many of the next rows of a recording's ticks have the same models: /scene and /tf change behind them.
uint64_t FoxgloveSession::untilChange(size_t stream) const {
  const RowSource& rows = *stage_.rows();
  if (!stage_.recorded() || stream != rows.find("ticks")) return UINT64_MAX;
  uint64_t change = UINT64_MAX;
  for (const ModelFrame& model : frames_->models())
    for (const uint64_t tick : {model.since, model.until})
      if (tick > frames_->tick() + 1) change = std::min(change, tick);
  if (change == UINT64_MAX) return UINT64_MAX;
  const uint64_t row = firstRowOf(rows, stream, change);
  return row > next_[stream] ? row - next_[stream] : 1;
}

void FoxgloveSession::sendStream(size_t stream) {
  const RowSource& rows = *stage_.rows();
  const RowStream& what = rows.streams()[stream];
  const auto channel =
      std::find_if(channels_.begin(), channels_.end(), [&](const Channel& c) { return c.stream == stream; });
  const uint32_t subscription =
      channel == channels_.end() ? 0 : subscriptionOf(static_cast<uint32_t>(channel - channels_.begin()) + 1);
  const bool followed = what.name == "ticks" || what.name == "poses";
  const uint64_t end = rows.end(stream);
  if (next_[stream] < rows.begin(stream)) next_[stream] = rows.begin(stream) + 1;  // the client reads too slowly
  if (subscription == 0 && !followed) next_[stream] = end;
  const uint64_t count =
      std::min({end - std::min(end, next_[stream]), kTickBytes / what.row_bytes, untilChange(stream)});
  if (count == 0) return;
  std::vector<std::byte> bytes(count * what.row_bytes);
  const uint64_t got = rows.copy(stream, next_[stream], count, bytes.data());
  next_[stream] += std::max<uint64_t>(got, 1);
  frames_->take(what.name, bytes.data(), got, what.row_bytes);
  std::string encoded;
  for (uint64_t i = 0; i < got; ++i) {
    const auto* row = reinterpret_cast<const char*>(bytes.data() + i * what.row_bytes);
    if (what.name == "ticks" && t_offset_ + sizeof(double) <= what.row_bytes) {
      double t = 0;
      std::memcpy(&t, row + t_offset_, sizeof t);
      const auto since = static_cast<uint64_t>(std::max(0.0, t) * 1e9);
      if (start_ == 0) start_ = wallNow() - since;  // the wall clock is read only once, because it may jump
      newest_ = start_ + since;
    }
    if (subscription != 0)
      send(subscription - 1, newest_, {record::kCdrHead.data(), record::kCdrHead.size()},
           record::cdrBody(channel->columns, {row, what.row_bytes}, encoded));
  }
}

void FoxgloveSession::send(uint32_t subscription, uint64_t time, std::string_view head, std::string_view body) {
  std::string bytes(1, kMessageData);
  bytes.append(reinterpret_cast<const char*>(&subscription), sizeof subscription);
  bytes.append(reinterpret_cast<const char*>(&time), sizeof time);
  bytes.append(head).append(body);
  peer_.binary(std::make_shared<const std::string>(std::move(bytes)));
}

void FoxgloveSession::sendTransforms() {
  const uint32_t subscription = subscriptionOf(tfChannel());
  if (subscription != 0 && newest_ != 0) send(subscription - 1, newest_, "", tfMessage(frames_->all(), newest_));
}

/// Takes a new list of models.
void FoxgloveSession::takeList() {
  if (list_number_ == stage_.listNumber() || stage_.list().empty()) return;
  list_number_ = stage_.listNumber();
  frames_->list(stage_.list());
}

/// Sends the triangles of the models that have come, and removes those that have left.
void FoxgloveSession::sendScene() {
  const uint32_t subscription = subscriptionOf(sceneChannel());
  if (subscription == 0 || list_number_ == 0) return;
  std::set<ModelKey> present;
  for (const ModelFrame& model : frames_->models())
    if (model.isThere(frames_->tick())) present.insert({model.frame.name, model.since});
  // first those that have left, because one that has come may have the same name
  std::erase_if(shown_, [&](const ModelKey& key) {
    const bool left = !present.contains(key);
    if (left) send(subscription - 1, newest_, "", sceneRemoval(key.name, newest_));
    return left;
  });
  const auto share = kSceneTriangles / std::max(static_cast<uint32_t>(present.size()), 1u);
  for (const ModelKey& key : present)
    if (shown_.insert(key).second) {
      ++drawing_;
      stage_.draw(key, std::max(share, kFewestTriangles),
                  [this, key, subscription, alive = alive_](const DrawnModel& drawn) {
                    if (!*alive) return;
                    --drawing_;
                    if (drawn.mesh && shown_.contains(key))
                      send(subscription - 1, newest_, "", sceneUpdate(key.name, *drawn.mesh, newest_));
                  });
    }
}

void FoxgloveSession::onText(std::string_view text) {
  const Json request = document::parseJson(text);
  if (!request.is_object()) return;
  const std::string op = request.contains("op") && request["op"].is_string() ? request["op"] : "";
  const auto number = [](const Json& from, const char* key) {
    const auto it = from.is_object() ? from.find(key) : from.end();
    return from.is_object() && it != from.end() && it->is_number_unsigned() ? it->get<uint32_t>() : UINT32_MAX;
  };
  if (op == "subscribe" && request.contains("subscriptions") && request["subscriptions"].is_array()) {
    for (const Json& wish : request["subscriptions"]) {
      const uint32_t id = number(wish, "id"), channel = number(wish, "channelId");
      if (id == UINT32_MAX || channel == 0 || channel > channels_.size() || subscriptions_.size() > channels_.size())
        continue;
      subscriptions_[id] = channel;
      since_subscribed_ = 0;
      if (channel == sceneChannel()) shown_.clear();
    }
  } else if (op == "unsubscribe" && request.contains("subscriptionIds") && request["subscriptionIds"].is_array()) {
    for (const Json& id : request["subscriptionIds"])
      if (id.is_number_unsigned()) subscriptions_.erase(id.get<uint32_t>());
  }
}

}  // namespace

std::unique_ptr<PeerSession> startFoxgloveSession(Peer& peer, Stage& stage) {
  return std::make_unique<FoxgloveSession>(peer, stage);
}

}  // namespace hapticd::view
