// SPDX-License-Identifier: MIT
#include "diagnostics/model_trial.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <functional>

#include "host/child.hpp"
#include "host/shape_instance.hpp"
#include "host/wire.hpp"

namespace hapticd::diagnostics {
namespace {

constexpr int kTrialLimitMs = 300'000;  ///< long, because thousands of models may need minutes

hsp_activation activationOf(const scene::Scene& scene, const scene::Model& model, double max_force) {
  hsp_activation activation{};
  activation.struct_size = sizeof activation;
  activation.max_probes = 1;
  activation.rate_hz = scene.servo.rate;
  activation.max_probe_speed = 2;
  activation.max_arm_force = max_force;
  Eigen::Map<Eigen::Vector3d>(activation.gravity) = scene.servo.gravity;
  Eigen::Map<Eigen::Vector3d>(activation.pose.position) = model.pose.position;
  const Eigen::Quaterniond& q = model.pose.orientation;
  const double orientation[4] = {q.w(), q.x(), q.y(), q.z()};
  std::copy(orientation, orientation + 4, activation.pose.orientation);
  return activation;
}

/// Returns the value that a plugin's message names at its beginning, as in "stiffness: has no effect", and removes the
/// name from `text`; nullptr if there is none.
const scene::Value* valueNamed(const scene::Model& model, std::string& text) {
  const std::string before = "model '" + model.name + "': cannot be set up: ";
  const size_t begin = text.rfind(before, 0) == 0 ? before.size() : 0, colon = text.find(": ", begin);
  if (colon == std::string::npos) return nullptr;
  for (const scene::Value& value : model.parameters)
    if (text.compare(begin, colon - begin, value.id) == 0 && value.place.line > 0) {
      text.erase(begin, colon + 2 - begin);
      return &value;
    }
  return nullptr;
}

/// Texts about models, each with the number of its model, packed so that they can come from the child.
class PackedTexts {
 public:
  void add(size_t model, const std::string& text) {
    ++count_;
    list_.number(static_cast<uint32_t>(model));
    list_.text(text);
  }
  std::string take() {
    host::Packer all;
    all.number(count_);
    return all.take() + list_.take();
  }
  static document::Problems read(host::Unpacker& in, const scene::Scene& scene) {
    document::Problems problems;
    for (uint32_t left = in.count(); left > 0 && in.good(); --left) {
      const uint32_t index = in.count();
      std::string text = in.text();
      if (index >= scene.models.size()) break;
      const scene::Model& model = scene.models[index];
      const scene::Value* value = valueNamed(model, text);
      const std::string key = "models[" + std::to_string(index) + "]";
      document::report(problems, value != nullptr ? value->place : model.place,
                       value != nullptr ? key + ".parameters." + value->id : key, text);
    }
    return problems;
  }

 private:
  uint32_t count_ = 0;
  host::Packer list_;
};

/// Warns of parameters for moving bodies on a model that does not move by forces.
void warnOfMotion(const scene::Model& model, size_t index, document::Problems& warnings) {
  for (const scene::Value& value : model.parameters)
    for (const char* id : {"mass", "inertia", "gravity", "drag", "angular_drag", "joint", "tether", "velocity"})
      if (value.id == id)
        document::report(warnings, value.place, "models[" + std::to_string(index) + "].parameters." + id,
                         "has no effect, because this model does not move by forces; set parameters.motion: dynamic if "
                         "the plugin has that parameter, or remove this line");
}

/// Reports a crash, an exit or a hang, with the model whose plugin caused it.
void reportEnd(const std::string& how, const host::ChildProgress& trail, const scene::Scene& scene,
               document::Problems& problems) {
  const uint32_t index = trail.item();
  if (*trail.call() == '\0' || index >= scene.models.size())
    return document::report(problems, scene.file.string(), 1, 1, "models", "setting up the models " + how);
  const scene::Model& model = scene.models[index];
  const bool more = index + 1 < scene.models.size();
  document::report(problems, model.place, "models[" + std::to_string(index) + "]",
                   "plugin '" + model.plugin + "' of model '" + model.name + "' " + how + ", in its " + trail.call() +
                       "()" + (more ? "; the models after it were not tried" : "") + "; hapticd plugin check " +
                       model.library.string() + " looks for the cause");
}

/// Packs the box of a model in its own frame; it is empty if the plugin does not report one.
void packBox(const Eigen::AlignedBox3d& box, host::Packer& out) {
  for (const Eigen::Vector3d& corner : {Eigen::Vector3d(box.min()), Eigen::Vector3d(box.max())})
    for (const double x : corner) out.number(x);
}

std::optional<Eigen::AlignedBox3d> readBox(host::Unpacker& in) {
  Eigen::AlignedBox3d box;
  for (double& x : box.min()) x = in.real();
  for (double& x : box.max()) x = in.real();
  if (!in.good() || box.isEmpty()) return std::nullopt;
  return box;
}

/// What the set-up of one model showed.
struct TrialResult {
  std::string error;     ///< why it was refused; "" if it was not
  double stiffness = 0;  ///< [N/m]
  bool idle = false, reads_velocity = false;
  Eigen::AlignedBox3d box;
};

using Log = std::function<void(int, const std::string&, const std::string&)>;

TrialResult tryOne(const scene::Scene& scene, const scene::Model& model, uint32_t index, double max_force,
                   const Log& log, host::ChildProgress& trail) {
  TrialResult tried;
  trail.mark(index, "create() or set");
  auto shape = host::ShapeInstance::create(model, log);
  if (!shape) {
    tried.error = shape.error();
    return tried;
  }
  trail.mark(index, "activate");
  const auto activated = (*shape)->activate(activationOf(scene, model, max_force));
  if (!activated) {
    tried.error = activated.error();
    return tried;
  }
  tried.stiffness = (*shape)->report().max_stiffness;
  tried.reads_velocity = ((*shape)->report().flags & HSP_R_VELOCITY) != 0;
  const bool may_move = ((*shape)->description().flags & HSP_C_MOVES) != 0;
  tried.idle = may_move && ((*shape)->report().flags & HSP_R_MOVES) == 0;
  trail.mark(index, "bounds");
  if (!(*shape)->bounds(tried.box.min().data(), tried.box.max().data())) tried.box.setEmpty();
  trail.mark(index, "deactivate() or destroy");
  return tried;
}

/// Sets up a refused model again without the parameter that the plugin objects to, a few times, so that further
/// objections and the size of the model are known. An objection that follows only from a left-out parameter is dropped.
TrialResult tryWithout(const scene::Scene& scene, uint32_t index, double max_force, std::string error, const Log& log,
                       host::ChildProgress& trail, PackedTexts& problems) {
  constexpr int kMost = 3;  // parameters that are left out
  scene::Model rest = scene.models[index];
  std::vector<std::string> left_out;
  TrialResult tried;
  for (int round = 0; round < kMost; ++round) {
    const scene::Value* named = valueNamed(rest, error);
    if (named == nullptr) break;
    left_out.push_back(named->id);
    rest.parameters.erase(rest.parameters.begin() + (named - rest.parameters.data()));
    tried = tryOne(scene, rest, index, max_force, log, trail);
    const bool follows = std::any_of(left_out.begin(), left_out.end(), [&tried](const std::string& id) {
      return tried.error.find(id) != std::string::npos;
    });
    if (tried.error.empty() || follows) break;
    problems.add(index, tried.error);
    error = tried.error;
  }
  tried.stiffness = 0;  // it may depend on the parameters that were left out
  return tried;
}

std::string tryAll(const scene::Scene& scene, double max_force, const std::vector<bool>& unsound,
                   host::ChildProgress& trail) {
  PackedTexts problems, warnings;
  host::Packer claims, boxes;
  for (uint32_t i = 0; i < scene.models.size(); ++i) {
    const Log log = [&](int level, const std::string&, const std::string& text) {
      if (level == HSP_LOG_WARNING) warnings.add(i, text);
    };
    const bool left_out = i < unsound.size() && unsound[i];
    TrialResult tried = left_out ? TrialResult{} : tryOne(scene, scene.models[i], i, max_force, log, trail);
    if (!tried.error.empty()) {
      problems.add(i, tried.error);
      tried = tryWithout(scene, i, max_force, tried.error, log, trail, problems);
    }
    claims.number(tried.stiffness);
    claims.number(uint32_t{tried.idle ? 1u : 0u});
    claims.number(uint32_t{tried.reads_velocity ? 1u : 0u});
    packBox(tried.box, boxes);
  }
  return problems.take() + warnings.take() + claims.take() + boxes.take();
}

}  // namespace

ModelTrial tryModels(const scene::Scene& scene, double max_force, const std::vector<bool>& unsound) {
  ModelTrial trial;
  if (scene.models.empty()) return trial;
  host::ChildProgress trail;
  const auto told = host::runInChild([&] { return tryAll(scene, max_force, unsound, trail); }, kTrialLimitMs);
  if (!told) {
    reportEnd(told.error(), trail, scene, trial.problems);
    return trial;
  }
  host::Unpacker in(*told);
  trial.problems = PackedTexts::read(in, scene);
  trial.warnings = PackedTexts::read(in, scene);
  for (size_t i = 0; i < scene.models.size() && in.good(); ++i) {
    trial.stiffness.push_back(in.real());
    if (in.count() != 0) warnOfMotion(scene.models[i], i, trial.warnings);
    trial.needs_velocity = in.count() != 0 || trial.needs_velocity;
  }
  for (size_t i = 0; i < scene.models.size() && in.good(); ++i) trial.boxes.push_back(readBox(in));
  return trial;
}

}  // namespace hapticd::diagnostics
