// SPDX-License-Identifier: MIT
#include "stage.hpp"

#include <algorithm>
#include <cstring>
#include <set>
#include <utility>

#include "document/json_text.hpp"
#include "mesh.hpp"

namespace hapticd::view {

namespace {

constexpr std::chrono::milliseconds kFindEvery(500), kPollEvery(1000);
constexpr std::chrono::milliseconds kGeometryEvery(60),
    /// For this time after a touch, the shape of a body is requested, because the body may still swing.
    kRestless(1500);
constexpr uint64_t kContactsAtOnce = 512;

/// Calls use(number, model) for each model of a list. Rows use the same number.
template <class Use>
void eachModel(const Json& list, Use&& use) {
  const auto models = list.find("models");
  if (models == list.end() || !models->is_array()) return;
  uint32_t place = 0;
  for (const Json& model : *models) {
    if (model.is_object() && model.contains("name")) use(model.value("number", place), model);
    ++place;
  }
}

}  // namespace

ModelKey keyOf(const Json& request, const char* name) {
  const auto since = request.find("since");
  return {request.value(name, ""), since != request.end() && since->is_number_unsigned() ? since->get<uint64_t>() : 0};
}

/// Requests the triangles as memory instead of text: with exact normals, without a limit on the size, and without
/// conversion. A daemon has one model of a name, and a recording may have several.
Json Stage::geometryRequest(const ModelKey& model) const {
  Json request = {{"do", "geometry"}, {"model", model.name}, {"as", "memory"}};
  if (recorded()) request["since"] = model.since;
  return request;
}

Stage::Stage(boost::asio::io_context& io, StageOptions options) : io_(io), options_(std::move(options)) {
  socket_ = recorded() ? options_.drawings : options_.folder + "/" + options_.name + ".sock";
  daemon_ = Daemon::at(io, socket_);
}

Result<void> Stage::open() {
  if (!recorded()) {
    find();
    return {};
  }
  auto rows = openRecording(options_.file);
  if (!rows) return Error{rows.error()};
  adopt(std::move(*rows));
  daemon_->connect();
  return {};
}

void Stage::adopt(std::unique_ptr<RowSource> rows) {
  rows_ = std::move(rows);
  about_ = document::parseJson(rows_->aboutJson());
  if (!about_.is_object()) about_ = Json::object();
  meshes_.clear();
  live_.clear();
  soft_.clear();
  next_contact_ = 0;
  list_ = status_ = Json::object();
  ++run_, ++list_number_, ++status_number_;
}

/// Searches for the daemon. A daemon has started when its socket answers; its black box exists before.
void Stage::find() {
  daemon_->connect();
  if (!daemon_->connected()) return;
  if (auto rows = openBlackBox(options_.folder + "/" + options_.name + ".blackbox.h5")) {
    adopt(std::move(*rows));
    next_poll_ = {};
  }
}

void Stage::tick() {
  const Clock::time_point now = Clock::now();
  if (was_connected_ && !daemon_->connected()) ++status_number_;  // so that pages report the daemon's end
  was_connected_ = daemon_->connected();
  if (!recorded() && !daemon_->connected() && now >= next_find_) {
    next_find_ = now + kFindEvery;
    find();
  }
  if (daemon_->connected() && now >= next_poll_) {
    next_poll_ = now + kPollEvery;
    poll();
  }
  if (daemon_->connected() && !recorded()) pollSoft();
}

void Stage::poll() {
  daemon_->ask({{"do", "list"}}, [this](const Json& answer, const Descriptor&) {
    if (answer.value("ok", false) && answer != list_) takeList(answer);
  });
  if (recorded()) return;
  daemon_->ask({{"do", "status"}}, [this](const Json& answer, const Descriptor&) {
    if (!answer.value("ok", false)) return;
    status_ = answer;
    ++status_number_;
  });
}

/// Takes a new list, and forgets what belongs to models that have left.
void Stage::takeList(const Json& list) {
  list_ = list;
  ++list_number_;
  std::set<ModelKey> present;
  std::map<ModelKey, Soft> soft;
  eachModel(list_, [&](uint32_t number, const Json& model) {
    const ModelKey key = keyOf(model, "name");
    present.insert(key);
    if (!model.value("deforms", false)) return;
    if (const auto known = soft_.find(key); known != soft_.end()) soft[key] = known->second;
    soft[key].number = number;
  });
  soft_ = std::move(soft);
  const auto left = [&](const auto& one) { return !present.contains(one.first); };
  std::erase_if(meshes_, left);
  std::erase_if(live_, left);
}

/// Requests the newest frame of each model that deforms, as soon as the last answer has come.
void Stage::pollSoft() {
  findTouched();
  const Clock::time_point now = Clock::now();
  for (auto& [model, soft] : soft_) {
    if (soft.asked || now < soft.next) continue;
    if (soft.frames)
      askVertices(model);
    else if (now - soft.touched < kRestless)
      askGeometry(model);
  }
}

void Stage::askVertices(const ModelKey& model) {
  soft_[model].asked = true;
  daemon_->ask({{"do", "vertices"}, {"model", model.name}, {"after", live_[model].frame}},
               [this, model, run = run_](const Json& answer, const Descriptor&) {
                 const auto soft = soft_.find(model);
                 if (run != run_ || soft == soft_.end()) return;
                 soft->second.asked = false;
                 soft->second.frames = answer.value("ok", false);
                 if (Message message = verticesMessage(answer, soft->second.number))
                   live_[model] = {answer.value("frame", uint64_t{0}), std::move(message)};
               });
}

void Stage::askGeometry(const ModelKey& model) {
  soft_[model].asked = true;
  soft_[model].next = Clock::now() + kGeometryEvery;
  daemon_->ask(geometryRequest(model), [this, model, run = run_](const Json& answer, const Descriptor& memory) {
    const auto soft = soft_.find(model);
    if (run != run_ || soft == soft_.end()) return;
    soft->second.asked = false;
    const uint64_t frame = live_[model].frame + 1;
    if (Message message = verticesMessage(answer, memory.get(), soft->second.number, static_cast<uint32_t>(frame)))
      live_[model] = {frame, std::move(message)};
  });
}

/// Finds out from the newest contacts which models were touched.
void Stage::findTouched() {
  const size_t stream = rows_->find("contacts");
  if (soft_.empty() || stream >= rows_->streams().size()) return;
  const uint64_t end = rows_->end(stream),
                 first = std::max(next_contact_, end > kContactsAtOnce ? end - kContactsAtOnce : 0);
  const uint32_t bytes = rows_->streams()[stream].row_bytes;
  const Json columns = about_.value("columns", Json::object()).value("contacts", Json::array());
  uint32_t model_at = UINT32_MAX, depth_at = UINT32_MAX;
  for (const Json& column : columns) {
    if (column.value("name", "") == "model") model_at = column.value("offset", UINT32_MAX);
    if (column.value("name", "") == "depth") depth_at = column.value("offset", UINT32_MAX);
  }
  if (model_at > bytes - 4 || depth_at > bytes - 8) return;
  std::vector<std::byte> rows((end - first) * bytes);
  const uint64_t got = end > first ? rows_->copy(stream, first, end - first, rows.data()) : 0;
  next_contact_ = end;
  for (uint64_t i = 0; i < got; ++i) {
    uint32_t model = 0;
    double depth = 0;
    std::memcpy(&model, rows.data() + i * bytes + model_at, sizeof model);
    std::memcpy(&depth, rows.data() + i * bytes + depth_at, sizeof depth);
    if (!(depth > 0)) continue;
    for (auto& [key, soft] : soft_)
      if (soft.number == model) soft.touched = Clock::now();
  }
}

void Stage::draw(const ModelKey& model, uint32_t most, std::function<void(const DrawnModel&)> drawn) {
  const auto known = meshes_.find(model);
  if (known != meshes_.end() && known->second.most == most) return drawn(known->second.drawn);
  Json request = geometryRequest(model);
  request["triangles"] = most;
  daemon_->ask(request,
               [this, model, most, run = run_, drawn = std::move(drawn)](const Json& answer, const Descriptor& memory) {
                 DrawnModel result;
                 if (answer.value("ok", false)) result.mesh = meshMessage(answer, memory.get());
                 if (!result.mesh)
                   result.error = answer.value("error", std::string("the model's triangles cannot be read"));
                 for (const char* key : {"tolerance", "triangles", "full_triangles", "off", "note"})
                   if (answer.contains(key)) result.facts[key] = answer[key];
                 if (run == run_ && result.mesh && !soft_.contains(model)) meshes_[model] = {most, result};
                 drawn(result);
               });
}

void Stage::drawAt(const ModelKey& model, double t, std::function<void(const Message&)> drawn) {
  Json request = geometryRequest(model);
  request["at"] = t;
  daemon_->ask(request,
               [this, model, drawn = std::move(drawn), run = run_](const Json& answer, const Descriptor& memory) {
                 const auto soft = soft_.find(model);
                 if (run != run_) return;
                 drawn(soft != soft_.end() ? verticesMessage(answer, memory.get(), soft->second.number, 0) : nullptr);
               });
}

std::vector<ModelKey> Stage::bodies() const {
  std::vector<ModelKey> models;
  for (const auto& [model, soft] : soft_) models.push_back(model);
  return models;
}

}  // namespace hapticd::view
