// SPDX-License-Identifier: MIT
#include "cli/recording/recorded_models.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "cli/support/command.hpp"
#include "control/request.hpp"
#include "control/server.hpp"
#include "document/json_text.hpp"
#include "record/recording.hpp"
#include "session/replay/about.hpp"
#include "session/replay/model_rerun.hpp"
#include "session/replay/run_models.hpp"
#include "session/requests/geometry_answer.hpp"
#include "world/world.hpp"

namespace hapticd::cli {

namespace {

using Json = nlohmann::ordered_json;
using control::Request;

class RecordedModelsImpl final : public RecordedModels {
 public:
  ~RecordedModelsImpl() override {
    server_.reset();
    std::error_code error;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, error);
  }

  Result<void> open(const std::string& file) {
    auto recording = record::Recording::open(file);
    if (!recording) return Error{recording.error()};
    auto run = servo::readAbout((*recording)->aboutJson());
    if (!run) return Error{file + ": " + run.error()};
    recording_ = std::move(*recording);
    later_ = laterJson(servo::RunModels(*recording_, run->scene), run->scene.models.size());
    for (const scene::Model& model : run->scene.models) models_.push_back(build(run->scene, model, run->facts.rate));
    std::string folder = (std::filesystem::temp_directory_path() / "hapticd-view-XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) return Error{folder + ": cannot be created"};
    folder_ = folder;
    socket_ = folder_ + "/models.sock";
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
    std::string name, plugin, error;
    std::unique_ptr<servo::World> world;
    /// Computes the shape of a body that deforms, if the recording has the positions of the tips.
    std::unique_ptr<servo::ModelRerun> rerun;
  };

  /// Builds a scene with that model alone, so that a model that fails does not affect the others.
  Built build(const scene::Scene& scene, const scene::Model& model, double rate) const {
    Built built{model.name, model.plugin, "", nullptr, nullptr};
    auto found = catalog().shape(model.plugin);
    if (!found) {
      built.error = found.error();
      return built;
    }
    scene::Scene alone = scene;
    alone.models = {model};
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
    return built;
  }

  /// Answers one request. Requests are those of a daemon; in addition, `geometry` takes `"at"`, the time [s] of the
  /// recording at which the shape is wanted.
  std::string answer(const std::string& line, Descriptor& memory) {
    Json json = document::parseJson(line);
    std::optional<double> at;
    if (json.is_object() && json.contains("at") && json["at"].is_number()) {
      at = json["at"].get<double>();
      json.erase("at");
    }
    const auto request = control::parseRequest(at ? document::jsonLine(json) : line);
    if (!request) return control::refusal(request.error());
    if (request->kind == Request::Kind::kList) return list();
    const bool names = request->kind == Request::Kind::kFeature;
    if (!names && request->kind != Request::Kind::kGeometry) return control::refusal("a recording cannot be changed");
    const auto model =
        std::find_if(models_.begin(), models_.end(), [&](const Built& built) { return built.name == request->model; });
    if (model == models_.end()) return control::refusal("the recording has no model \"" + request->model + "\"");
    if (!model->world) return control::refusal(model->error);
    if (at && model->rerun) model->rerun->goTo(*at);
    const host::ShapeInstance& shape = *model->world->shapes()[0];
    if (names) return servo::featureAnswer(shape, request->number);
    const servo::DrawingWish wish{request->tolerance, request->triangles};
    auto drawn = request->as_memory ? servo::geometryInMemory(shape, wish, memory) : servo::geometryAnswer(shape, wish);
    return drawn ? *drawn : control::refusal(drawn.error());
  }

  std::string list() const {
    Json models = Json::array();
    for (const Built& built : models_)
      models.push_back({{"name", built.name},
                        {"plugin", built.plugin},
                        {"enabled", true},
                        {"live_parameters", Json::array()},
                        {"deforms", built.rerun != nullptr}});
    return document::jsonLine(Json({{"ok", true}, {"models", std::move(models)}, {"later", later_}}));
  }

  /// Names the models that came during the run, with the tick from which on a number means them. They are not drawn.
  static Json laterJson(const servo::RunModels& models, size_t of_scene) {
    Json later = Json::array();
    for (size_t i = of_scene; i < models.all().size(); ++i) {
      const servo::RunModel& one = models.all()[i];
      later.push_back(
          {{"name", one.model.name}, {"plugin", one.model.plugin}, {"number", one.number}, {"tick", one.since}});
    }
    return later;
  }

  std::unique_ptr<record::Recording> recording_;
  std::vector<Built> models_;  // declared after the recording that the models read, so that they are destroyed first
  Json later_;
  std::string folder_, socket_;
  std::unique_ptr<control::Server> server_;
};

}  // namespace

Result<std::unique_ptr<RecordedModels>> RecordedModels::serve(const std::string& recording) {
  auto models = std::make_unique<RecordedModelsImpl>();
  if (auto opened = models->open(recording); !opened) return Error{opened.error()};
  return std::unique_ptr<RecordedModels>(std::move(models));
}

}  // namespace hapticd::cli
