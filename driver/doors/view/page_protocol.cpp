// SPDX-License-Identifier: MIT
#include "page_protocol.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <string_view>

#include "document/json_text.hpp"
#include "lead.hpp"
#include "mesh.hpp"
#include "playback.hpp"

namespace hapticd::view {

namespace {

/// [bytes] largest size of the rows that a new page gets: 10 s of one arm at 1 kHz.
constexpr uint64_t kBacklogBytes = 4u << 20;
constexpr uint64_t kMessageBytes = 1u << 20;  ///< [bytes] largest size of the rows of one stream in one message
constexpr double kBacklogSeconds = 10;
constexpr std::array<std::string_view, 4> kReads = {"status", "list", "geometry", "feature"};
constexpr std::array<std::string_view, 14> kControls = {"enable", "disable", "move", "set",  "add", "remove", "reload",
                                                        "hold",   "clear",   "dump", "stop", "get", "lead",   "unlead"};
constexpr double kUsualTriangles = 200000;  ///< most triangles of a drawing if the page does not say
constexpr size_t kMostLeads = 4;            ///< largest number of leads of one page

template <class Words>
bool contains(const Words& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Returns the oldest row that will still exist when it is copied: the servo overwrites old rows meanwhile.
uint64_t oldest(const RowSource& rows, size_t stream) {
  constexpr uint64_t kMargin = 64;
  const uint64_t begin = rows.begin(stream);
  return begin == 0 ? 0 : std::min(begin + kMargin, rows.end(stream));
}

class NativeSession final : public PeerSession {
 public:
  NativeSession(Peer& peer, Stage& stage) : peer_(peer), stage_(stage), alive_(std::make_shared<bool>(true)) {}
  ~NativeSession() override { *alive_ = false; }

  void onText(std::string_view text) override;
  void onBinary(std::span<const std::byte> bytes) override;
  void onTick() override;

 private:
  void begin();
  void sendChanges();
  void sendRows();
  void sendRows(size_t stream, uint64_t end);
  void jump();
  void sendVertices();
  void askBodies();
  void answer(const Json& id, Json answer);
  void draw(const Json& id, const Json& request);
  void pass(const Json& id, Json request);
  void lead(const Json& id, const Json& request);
  void unlead(const Json& id, const Json& request);

  Peer& peer_;
  Stage& stage_;
  std::shared_ptr<bool> alive_;  ///< false after the page has gone, so that later answers are dropped
  uint64_t run_ = 0, list_number_ = 0, status_number_ = 0;
  std::vector<uint64_t> next_;  ///< next row to send of each stream
  std::map<ModelKey, uint64_t> frames_;
  std::unique_ptr<Playback> playback_;
  /// What this page has requested of a body of the recording.
  struct Body {
    double time = NAN;  ///< [s] time of the shape that was requested last
    bool asked = false;
  };
  std::map<ModelKey, Body> bodies_;
  std::map<uint32_t, std::unique_ptr<Lead>> leads_;
  uint32_t next_lead_ = 1;
};

void NativeSession::onTick() {
  if (stage_.rows() == nullptr) {
    if (run_ == 0 && peer_.idle() && status_number_ != stage_.statusNumber() + 1) {
      status_number_ = stage_.statusNumber() + 1;
      peer_.text(Json({{"type", "waiting"}, {"name", stage_.options().name}}).dump());
    }
    return;
  }
  if (run_ != stage_.run()) begin();
  sendChanges();
  if (!peer_.idle()) return;  // a slow page gets only the newest values; others are skipped
  sendRows();
  sendVertices();
  if (playback_) askBodies();
}

/// Called when a run was found: sends its description, and the first rows for this page.
void NativeSession::begin() {
  run_ = stage_.run();
  const RowSource& rows = *stage_.rows();
  Json streams = Json::array();
  for (const RowStream& stream : rows.streams())
    streams.push_back({{"name", stream.name}, {"row_bytes", stream.row_bytes}});
  Json hello = {{"type", "about"},
                {"control", stage_.options().control},
                {"recorded", stage_.recorded()},
                {"name", stage_.recorded() ? stage_.options().file : stage_.options().name},
                {"streams", streams},
                {"about", stage_.about()}};
  peer_.text(document::jsonLine(hello));
  next_.assign(rows.streams().size(), 0);
  frames_.clear();
  bodies_.clear();
  list_number_ = status_number_ = 0;
  if (stage_.recorded()) {
    playback_ = std::make_unique<Playback>(rows, stage_.about());
    peer_.text(playback_->stateJson());
    next_ = playback_->rowsFrom(0);
    return;
  }
  for (size_t i = 0; i < next_.size(); ++i) {
    const uint64_t most = kBacklogBytes / rows.streams()[i].row_bytes, end = rows.end(i);
    next_[i] = std::max(oldest(rows, i), end > most ? end - most : 0);
  }
}

void NativeSession::sendChanges() {
  if (list_number_ != stage_.listNumber() && !stage_.list().empty()) {
    list_number_ = stage_.listNumber();
    Json list = stage_.list();
    list["type"] = "list";
    peer_.text(document::jsonLine(list));
  }
  if (status_number_ == stage_.statusNumber()) return;
  status_number_ = stage_.statusNumber();
  Json status = stage_.alive() ? stage_.status() : Json::object();
  status["type"] = stage_.alive() ? "status" : "end";
  peer_.text(document::jsonLine(status));
}

void NativeSession::sendRows() {
  const RowSource& rows = *stage_.rows();
  if (playback_) {
    playback_->advance();
    jump();
  }
  const auto endOf = [&](size_t stream) { return playback_ ? playback_->ends()[stream] : rows.end(stream); };
  // Marks name the models that come, so they go before the events of these. The end of the ticks is read last, because
  // rows of other streams are written before the row of their tick.
  const size_t ticks = rows.find("ticks"), marks = rows.find("marks");
  if (marks < next_.size()) sendRows(marks, endOf(marks));
  for (size_t i = 0; i < next_.size(); ++i)
    if (i != ticks && i != marks) sendRows(i, endOf(i));
  if (ticks < next_.size()) sendRows(ticks, endOf(ticks));
  if (playback_ && playback_->takeChanged()) peer_.text(playback_->stateJson());
}

/// Called when the place in the recording has jumped. Makes the page forget its rows, and sends it the rows before the
/// new place.
void NativeSession::jump() {
  if (!playback_->takeJumped()) return;
  peer_.text(R"({"type":"reset"})");
  next_ = playback_->rowsFrom(kBacklogSeconds);
}

void NativeSession::sendRows(size_t stream, uint64_t end) {
  const RowSource& rows = *stage_.rows();
  const RowStream& what = rows.streams()[stream];
  uint64_t& next = next_[stream];
  if (what.name == "activations") return;  // thousands of rows per second, which no page draws
  if (next < rows.begin(stream)) next = oldest(rows, stream);
  const uint64_t most = kMessageBytes / what.row_bytes;
  if (!playback_ && end > next + kBacklogBytes / what.row_bytes) next = end - most;
  if (next >= end) return;
  const uint64_t count = std::min(end - next, most);
  std::string bytes = headed(static_cast<uint32_t>(stream), what.row_bytes, 0, 0);
  bytes.resize(16 + count * what.row_bytes);
  const uint64_t got = rows.copy(stream, next, count, reinterpret_cast<std::byte*>(bytes.data() + 16));
  next += std::max<uint64_t>(got, 1);
  if (got == 0) return;
  bytes.resize(16 + got * what.row_bytes);
  const auto words = static_cast<uint32_t>(got);
  bytes.replace(8, sizeof words, reinterpret_cast<const char*>(&words), sizeof words);
  peer_.binary(std::make_shared<const std::string>(std::move(bytes)));
}

void NativeSession::sendVertices() {
  for (const auto& [model, live] : stage_.live()) {
    if (!live.vertices || frames_[model] == live.frame) continue;
    frames_[model] = live.frame;
    peer_.binary(live.vertices);
  }
}

/// Requests, for each body of a recording, the shape at the page's present place, as soon as the last answer has come.
void NativeSession::askBodies() {
  const double now = playback_->time();
  for (const ModelKey& model : stage_.bodies()) {
    Body& body = bodies_[model];
    if (body.asked || body.time == now) continue;
    body = {now, true};
    stage_.drawAt(model, now, [this, model, alive = alive_](const Message& vertices) {
      if (!*alive) return;
      bodies_[model].asked = false;
      if (vertices) peer_.binary(vertices);
    });
  }
}

void NativeSession::onText(std::string_view text) {
  Json request = document::parseJson(text);
  const bool good = request.is_object() && request.contains("do") && request["do"].is_string();
  const Json id = request.is_object() && request.contains("id") ? request["id"] : Json();
  if (!good)
    return answer(id, {{"ok", false},
                       {"error", "the message is no request, expected a JSON object with the keys \"do\" and \"id\""}});
  const std::string word = request["do"];
  request.erase("id");
  if (word == "geometry") return draw(id, request);
  if (playback_ && Playback::knows(word)) {
    const std::string error = playback_->execute(request);
    jump();
    return answer(id, error.empty() ? Json({{"ok", true}}) : Json({{"ok", false}, {"error", error}}));
  }
  if (contains(kReads, word)) return pass(id, std::move(request));
  if (!contains(kControls, word))
    return answer(id, {{"ok", false}, {"error", "the view does not know the request \"" + word.substr(0, 40) + "\""}});
  if (!stage_.options().control)
    return answer(id, {{"ok", false}, {"error", "this view may not change the run\n  fix: hapticd view --control"}});
  if (word == "lead") return lead(id, request);
  if (word == "unlead") return unlead(id, request);
  pass(id, std::move(request));
}

/// Takes a message with the record of a lead: u32 lead, u32 0, hapticd_target. An unknown lead is ignored, because it
/// may have ended meanwhile.
void NativeSession::onBinary(std::span<const std::byte> bytes) {
  constexpr size_t kHead = 8;
  uint32_t number = 0;
  if (bytes.size() < kHead) return;
  std::memcpy(&number, bytes.data(), sizeof number);
  const auto lead = leads_.find(number);
  if (lead != leads_.end()) lead->second->put(bytes.subspan(kHead));
}

void NativeSession::lead(const Json& id, const Json& request) {
  std::erase_if(leads_, [](const auto& known) { return known.second->refused(); });
  if (leads_.size() >= kMostLeads)
    return answer(id, {{"ok", false}, {"error", "this page already has 4 leads, which is the limit: end one of them"}});
  const uint32_t number = next_lead_++;
  leads_[number] =
      Lead::ask(stage_.io(), stage_.socket(), request, [this, id, number, alive = alive_](const Json& said) {
        if (!*alive) return;
        Json taken = said;
        if (said.value("ok", false)) taken["lead"] = number;
        answer(id, std::move(taken));
      });
}

void NativeSession::unlead(const Json& id, const Json& request) {
  const auto it = request.find("lead");
  const bool known = it != request.end() && it->is_number_unsigned() && leads_.erase(it->get<uint32_t>()) == 1;
  answer(id, known ? Json({{"ok", true}})
                   : Json({{"ok", false}, {"error", "\"lead\": expected the number of a lead of this page"}}));
}

void NativeSession::answer(const Json& id, Json answer) {
  answer["type"] = "answer";
  answer["id"] = id;
  peer_.text(document::jsonLine(answer));
}

/// Answers a request for triangles. The mesh is sent as bytes, directly before the answer that names it.
void NativeSession::draw(const Json& id, const Json& request) {
  if (!request.contains("model") || !request["model"].is_string())
    return answer(id, {{"ok", false}, {"error", "\"model\" is missing in \"geometry\", expected the name of a model"}});
  const auto wish = request.find("triangles");
  const double most = wish != request.end() && wish->is_number() ? wish->get<double>() : kUsualTriangles;
  if (!(most >= kFewestTriangles && most <= kMostTriangles))
    return answer(id, {{"ok", false}, {"error", "\"triangles\": expected a whole number from 1000 to 600000"}});
  stage_.draw(keyOf(request, "model"), static_cast<uint32_t>(most),
              [this, id, alive = alive_](const DrawnModel& drawn) {
                if (!*alive) return;
                if (!drawn.mesh) return answer(id, {{"ok", false}, {"error", drawn.error}});
                peer_.binary(drawn.mesh);
                Json said = drawn.facts;
                said["ok"] = true;
                answer(id, std::move(said));
              });
}

void NativeSession::pass(const Json& id, Json request) {
  if (!stage_.recorded()) request.erase("since");  // a daemon has one model of a name
  stage_.daemon().ask(request, [this, id, alive = alive_](const Json& said, const Descriptor&) {
    if (*alive) answer(id, said);
  });
}

}  // namespace

std::unique_ptr<PeerSession> startPageSession(Peer& peer, Stage& stage) {
  return std::make_unique<NativeSession>(peer, stage);
}

}  // namespace hapticd::view
