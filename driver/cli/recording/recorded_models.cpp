// SPDX-License-Identifier: MIT
#include "cli/recording/recorded_models.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "cli/recording/tick_times.hpp"
#include "cli/support/command.hpp"
#include "cli/support/scratch_folder.hpp"
#include "control/request.hpp"
#include "control/server.hpp"
#include "document/json_text.hpp"
#include "record/recording.hpp"
#include "session/replay/about.hpp"
#include "session/replay/model_rerun.hpp"
#include "session/replay/run_models.hpp"
#include "session/requests/answers.hpp"
#include "session/requests/geometry_answer.hpp"
#include "world/world.hpp"

namespace hapticd::cli {

namespace {

using Json = nlohmann::ordered_json;
using control::Request;

class RecordedModelsImpl final : public RecordedModels {
 public:
  ~RecordedModelsImpl() override { server_.reset(); }  // before the folder of its socket

  Result<void> open(const std::string& file) {
    auto recording = record::Recording::open(file);
    if (!recording) return Error{recording.error()};
    auto run = servo::readAbout((*recording)->aboutJson());
    if (!run) return Error{file + ": " + run.error()};
    recording_ = std::move(*recording);
    const servo::RunModels models(*recording_, run->scene);
    for (const servo::RunModel& one : models.all()) models_.push_back(build(run->scene, one, run->facts.rate));
    auto folder = ScratchFolder::make("view");
    if (!folder) return Error{folder.error()};
    folder_ = std::move(*folder);
    socket_ = folder_.path() + "/models.sock";
    auto server = control::Server::listen(socket_);
    if (!server) return Error{server.error()};
    server_ = std::move(*server);
    control::Server::Service service;
    service.answer = [this](const control::Peer&, const std::string& line, std::vector<Descriptor>) {
      Descriptor memory;
      std::string text = answer(line, memory);
      return control::Reply(std::move(text), std::move(memory));
    };
    server_->start(std::move(service));
    return {};
  }

  const std::string& socket() const override { return socket_; }

 private:
  struct Built {
    servo::RunModel run;
    std::string error;
    std::unique_ptr<servo::World> world;
    /// Computes the shape of a body that deforms, if the recording has the positions of the tips.
    std::unique_ptr<servo::ModelRerun> rerun;
    double from = 0, to = HUGE_VAL;  ///< [s] times in which a body that deforms is there
  };

  /// Builds a scene with that model alone, so that a model that fails does not affect the others.
  Built build(const scene::Scene& scene, const servo::RunModel& one, double rate) const {
    Built built;
    built.run = one;
    built.error = one.lack;
    if (!built.error.empty()) return built;
    auto found = catalog().shape(one.model.plugin);
    if (!found) {
      built.error = found.error();
      return built;
    }
    scene::Scene alone = scene;
    alone.models = {one.model};
    alone.models[0].library = (*found)->file;
    servo::WorldOptions options;
    options.rate = rate;
    options.probe_count = static_cast<uint32_t>(std::max<size_t>(scene.devices.size(), 1));
    auto world = servo::World::build(alone, options, [](int, const std::string&, const std::string&) {});
    if (!world) {
      built.error = world.error();
      return built;
    }
    built.world = std::move(*world);
    if ((built.world->shapes()[0]->description().flags & HSP_C_DEFORMS) == 0) return built;
    if (auto rerun = servo::ModelRerun::prepare(*recording_, *built.world)) built.rerun = std::move(*rerun);
    TickTimes times(*recording_);
    if (one.since > 0) built.from = times.of(static_cast<double>(one.since));
    if (one.until != UINT64_MAX) built.to = times.of(static_cast<double>(one.until));
    return built;
  }

  /// Takes a number out of a request; nothing if it has none of that name.
  static std::optional<double> take(Json& request, const char* key) {
    if (!request.is_object() || !request.contains(key) || !request[key].is_number()) return std::nullopt;
    const auto number = request[key].get<double>();
    request.erase(key);
    return number;
  }

  /// Answers one request. Requests are those of a daemon, and may have in addition `"since"`, which is in the list and
  /// tells models of one name apart, and `"at"`, the time [s] of the recording at which the shape is wanted.
  std::string answer(const std::string& line, Descriptor& memory) {
    Json json = document::parseJson(line);
    const double since = take(json, "since").value_or(0);
    const std::optional<double> at = take(json, "at");
    const auto request = control::parseRequest(json.is_object() ? document::jsonLine(json) : line);
    if (!request) return control::refusal(request.error());
    if (request->kind == Request::Kind::kList) return list();
    const bool names = request->kind == Request::Kind::kFeature;
    if (!names && request->kind != Request::Kind::kGeometry) return control::refusal("a recording cannot be changed");
    const auto model = std::find_if(models_.begin(), models_.end(), [&](const Built& built) {
      return built.run.model.name == request->model && static_cast<double>(built.run.since) == since;
    });
    if (model == models_.end()) return control::refusal("the recording has no model \"" + request->model + "\"");
    if (!model->world) return control::refusal(model->error);
    if (at && !(model->from <= *at && *at < model->to)) return control::refusal("this model is not there at this time");
    if (at && model->rerun) model->rerun->goTo(*at);
    const host::ShapeInstance& shape = *model->world->shapes()[0];
    if (names) return servo::featureAnswer(shape, request->number);
    const servo::DrawingWish wish{request->tolerance, request->triangles};
    auto drawn = request->as_memory ? servo::geometryInMemory(shape, wish, memory) : servo::geometryAnswer(shape, wish);
    return drawn ? *drawn : control::refusal(drawn.error());
  }

  /// Lists the models of the scene and those that came later, with the ticks in which their numbers mean them.
  std::string list() const {
    Json models = Json::array();
    for (const Built& built : models_) {
      const servo::RunModel& one = built.run;
      models.push_back({{"name", one.model.name},
                        {"number", one.number},
                        {"since", one.since},
                        {"until", one.until == UINT64_MAX ? Json() : Json(one.until)},
                        {"plugin", one.model.plugin},
                        {"enabled", true},
                        {"pose", servo::jsonOf(one.model.pose)},
                        {"live_parameters", Json::array()},
                        {"deforms", built.rerun != nullptr},
                        {"tip_radius", scene::numberIn(one.model.parameters, "tip_radius", 0)}});
    }
    return document::jsonLine(Json({{"ok", true}, {"models", std::move(models)}}));
  }

  std::unique_ptr<record::Recording> recording_;
  std::vector<Built> models_;  // declared after the recording that the models read, so that they are destroyed first
  ScratchFolder folder_;
  std::string socket_;
  std::unique_ptr<control::Server> server_;
};

}  // namespace

Result<std::unique_ptr<RecordedModels>> RecordedModels::serve(const std::string& recording) {
  auto models = std::make_unique<RecordedModelsImpl>();
  if (auto opened = models->open(recording); !opened) return Error{opened.error()};
  return std::unique_ptr<RecordedModels>(std::move(models));
}

}  // namespace hapticd::cli
