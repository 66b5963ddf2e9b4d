// SPDX-License-Identifier: MIT
#include "diagnostics/scene/model_trial.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <functional>
#include <iterator>
#include <set>
#include <sstream>
#include <string_view>

#include "base/shell_word.hpp"
#include "diagnostics/reading/key_place.hpp"
#include "diagnostics/scene/slow_setup.hpp"
#include "diagnostics/scene/trial_end.hpp"
#include "host/catalog.hpp"
#include "host/child.hpp"
#include "host/class_params.hpp"
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

/// A part of a plugin's message that is about one parameter, or about a row of it.
struct Objection {
  const scene::Value* value = nullptr;  ///< nullptr if the message names none
  std::string row;                      ///< such as "[2]"; "" for the whole parameter
  std::string what;
};

std::string beginningOf(const scene::Model& model) {
  return "model '" + model.name + "': cannot be set up: ";
}

/// Reads a line that begins with the name of a parameter, as in "stiffness: has no effect" or "detent[2]: too short".
std::optional<Objection> objectionIn(const scene::Model& model, std::string_view line) {
  const size_t colon = line.find(": ");
  if (colon == std::string_view::npos) return std::nullopt;
  const size_t bracket = std::min(line.find('['), colon);
  for (const scene::Value& value : model.parameters)
    if (line.substr(0, bracket) == value.id && value.place.line > 0)
      return Objection{&value, std::string(line.substr(bracket, colon - bracket)), std::string(line.substr(colon + 2))};
  return std::nullopt;
}

/// Returns the objections of a plugin's message. If its first line names a parameter, each line that names one is an
/// objection of its own.
std::vector<Objection> objectionsIn(const scene::Model& model, const std::string& text) {
  const std::string before = text.starts_with(beginningOf(model)) ? beginningOf(model) : "";
  std::vector<Objection> all;
  std::istringstream lines(text.substr(before.size()));
  for (std::string line; std::getline(lines, line);) {
    auto one = objectionIn(model, line);
    if (!one && all.empty()) return {{nullptr, "", text}};
    if (one)
      all.push_back({one->value, one->row, before + one->what});
    else
      all.back().what += "\n" + line;
  }
  if (all.empty()) all.push_back({nullptr, "", text});
  return all;
}

/// Returns the parameter whose file a message names; nullptr if it names none.
const scene::Value* fileIn(const scene::Model& model, const std::string& text) {
  const auto named = [&text](const scene::Value& value) {
    return value.kind == HSP_PATH && value.place.line > 0 && !value.text.empty() &&
           text.find(value.text) != std::string::npos;
  };
  const auto found = std::find_if(model.parameters.begin(), model.parameters.end(), named);
  return found != model.parameters.end() ? &*found : nullptr;
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
      const std::string text = in.text();
      if (index >= scene.models.size()) break;
      const scene::Model& model = scene.models[index];
      const std::string key = "models[" + std::to_string(index) + "]";
      for (const Objection& one : objectionsIn(model, text)) {
        if (one.value == nullptr) {
          const scene::Value* file = fileIn(model, one.what);
          if (file != nullptr)
            document::report(problems, file->place, key + ".parameters." + file->id, one.what);
          else
            document::report(problems, model.place, key, one.what);
          continue;
        }
        const std::string of_row = key + ".parameters." + one.value->id + one.row;
        const auto row = one.row.empty() ? std::nullopt : placeOfKey(one.value->place.file, of_row);
        document::report(problems, row.value_or(one.value->place), of_row, one.what);
      }
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
    for (const char* id : {"mass", "inertia", "gravity", "drag", "angular_drag", "joint", "tether", "angular_tether",
                           "rest", "velocity"})
      if (value.id == id)
        document::report(warnings, value.place, "models[" + std::to_string(index) + "].parameters." + id,
                         "has no effect, because this model does not move by forces; set parameters.motion: dynamic if "
                         "the plugin has that parameter, or remove this line");
}

/// Reports a crash, an exit or a hang, with the model whose plugin caused it.
void reportEnd(const std::string& how, const host::ChildProgress& trail, const scene::Scene& scene,
               document::Problems& problems) {
  const uint32_t index = trail.item();
  if (index >= scene.models.size())
    return document::report(problems, scene.file.string(), 1, 1, "models",
                            "the process in which check sets up the models " + how);
  const scene::Model& model = scene.models[index];
  const bool more = index + 1 < scene.models.size();
  const bool hangs = how.starts_with("did not return");
  document::report(problems, model.place, "models[" + std::to_string(index) + "]",
                   "plugin '" + model.plugin + "' of model '" + model.name + "' " + how + whereAtEnd(trail.call()) +
                       (more ? "; the models after it were not tried" : "") +
                       (hangs ? "; if it only needs longer, give --setup-limit more seconds" : "") +
                       "; hapticd plugin check " + shellWord(model.library.string()) + " looks for the cause");
}

/// Warns of a plugin that crashes when the process ends. It was set up and removed without a problem.
void reportDestructor(const host::ChildProgress& trail, const scene::Scene& scene, document::Problems& warnings) {
  const uint32_t index = trail.item();
  if (*trail.call() == '\0' || index >= scene.models.size()) return;
  const scene::Model& model = scene.models[index];
  reportInModel(warnings, scene, index, "plugin",
                "plugin '" + model.plugin + "' of model '" + model.name +
                    "' crashes when the process ends, in a destructor of one of its static objects; a run ends "
                    "with this crash after its report; correct it in the source of " +
                    model.library.string());
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
  bool idle = false, reads_velocity = false, moves = false;
  Eigen::AlignedBox3d box;
};

/// Notes that a call of a plugin is about to begin.
void markCall(host::ChildProgress& trail, uint32_t index, const char* call) {
  trail.mark(index, call);
  trail.beginPiece();
}

using Log = std::function<void(int, const std::string&, const std::string&)>;

TrialResult tryOne(const scene::Scene& scene, const scene::Model& model, uint32_t index, double max_force,
                   const Log& log, host::ChildProgress& trail) {
  TrialResult tried;
  markCall(trail, index, "create() or set");
  auto shape = host::ShapeInstance::create(model, log);
  if (!shape) {
    tried.error = shape.error();
    return tried;
  }
  markCall(trail, index, "activate");
  const auto activated = (*shape)->activate(activationOf(scene, model, max_force));
  if (!activated) {
    tried.error = activated.error();
    return tried;
  }
  tried.stiffness = (*shape)->report().max_stiffness;
  tried.reads_velocity = ((*shape)->report().flags & HSP_R_VELOCITY) != 0;
  const bool may_move = ((*shape)->description().flags & HSP_C_MOVES) != 0;
  tried.moves = ((*shape)->report().flags & HSP_R_MOVES) != 0;
  tried.idle = may_move && !tried.moves;
  markCall(trail, index, "bounds");
  if (!(*shape)->bounds(tried.box.min().data(), tried.box.max().data())) tried.box.setEmpty();
  markCall(trail, index, "deactivate() or destroy");
  return tried;
}

/// Returns true for a parameter that says which instances of a part a model has.
bool choosesInstances(const std::string& id) {
  return id == "instance" || id == "without";
}

/// Sets up a refused model again without the parameters that the plugin objects to, a few times, so that further
/// objections and the size of the model are known. An objection that follows only from a left-out parameter is dropped,
/// and so is a warning that names no parameter: with the left-out ones the surfaces or the wall may be others.
TrialResult tryWithout(const scene::Scene& scene, uint32_t index, double max_force, std::string error,
                       host::ChildProgress& trail, PackedTexts& problems, PackedTexts& warnings) {
  constexpr int kMost = 3;  // parameters that are left out
  scene::Model rest = scene.models[index];
  std::vector<std::string> left_out;
  const Log log = [&](int level, const std::string&, const std::string& text) {
    if (level == HSP_LOG_WARNING && objectionsIn(rest, text).front().value != nullptr) warnings.add(index, text);
  };
  TrialResult tried;
  for (int round = 0; round < kMost; ++round) {
    std::set<std::string> named;
    for (const Objection& one : objectionsIn(rest, error))
      if (one.value != nullptr) named.insert(one.value->id);
    // Without its file a model has no surfaces, so any further objection would only follow from that.
    const bool of_file =
        std::any_of(rest.parameters.begin(), rest.parameters.end(),
                    [&named](const scene::Value& value) { return value.kind == HSP_PATH && named.contains(value.id); });
    if (named.empty() || of_file) break;
    left_out.insert(left_out.end(), named.begin(), named.end());
    std::erase_if(rest.parameters, [&named](const scene::Value& value) { return named.contains(value.id); });
    tried = tryOne(scene, rest, index, max_force, log, trail);
    const bool follows = std::any_of(left_out.begin(), left_out.end(), [&tried](const std::string& id) {
      return tried.error.find(id) != std::string::npos;
    });
    if (tried.error.empty() || follows) break;
    problems.add(index, tried.error);
    error = tried.error;
  }
  tried.stiffness = 0;  // it may depend on the parameters that were left out
  if (std::any_of(left_out.begin(), left_out.end(), choosesInstances)) tried.box.setEmpty();
  return tried;
}

/// Returns true for a parameter that a plugin can judge without knowing the surfaces.
bool isOfItself(const std::string& id) {
  constexpr std::string_view kOwn[] = {"detent", "end_stiffness", "friction_static", "friction_dynamic",
                                       "axis",   "inertia",       "limits"};
  return std::find(std::begin(kOwn), std::end(kOwn), id) != std::end(kOwn);
}

/// Returns an empty parameter `geometry` for a model whose file does not give it; nothing if its plugin has none.
std::optional<scene::Value> absentGeometry(const scene::Model& model, const Log& log) {
  const auto shape = host::ShapeInstance::create(model, log);
  if (!shape) return std::nullopt;
  const hsp_class& plugin = (*shape)->description();
  const auto index = host::paramIndexOf(plugin, "geometry");
  if (!index || host::paramAt(plugin, *index).kind != HSP_PATH) return std::nullopt;
  scene::Value value;
  value.id = "geometry";
  value.index = *index;
  value.kind = HSP_PATH;
  return value;
}

/// Sets up a model whose geometry was refused, or is missing, with a shipped file instead, so that objections to
/// parameters that do not depend on the surfaces, and warnings about them, are known, too.
void tryOtherGeometry(const scene::Scene& scene, uint32_t index, double max_force, host::ChildProgress& trail,
                      PackedTexts& problems, PackedTexts& warnings) {
  for (const char* name : {"models/box.yaml", "models/loaf.yaml"}) {  // rigid, soft
    scene::Model other = scene.models[index];
    const auto file = host::shippedFile(name);
    auto geometry = std::find_if(other.parameters.begin(), other.parameters.end(),
                                 [](const scene::Value& value) { return value.id == "geometry"; });
    if (geometry == other.parameters.end())
      if (const auto missing = absentGeometry(other, [](int, const std::string&, const std::string&) {}))
        geometry = other.parameters.insert(geometry, *missing);
    if (!file || geometry == other.parameters.end()) return;
    geometry->text = file->string();
    std::erase_if(other.parameters, [](const scene::Value& value) { return choosesInstances(value.id); });
    const Log log = [&](int level, const std::string&, const std::string& text) {
      const Objection one = objectionsIn(other, text).front();
      if (level == HSP_LOG_WARNING && one.value != nullptr && isOfItself(one.value->id)) warnings.add(index, text);
    };
    const TrialResult tried = tryOne(scene, other, index, max_force, log, trail);
    if (tried.error.empty()) return;
    for (const Objection& one : objectionsIn(other, tried.error))
      if (one.value != nullptr && isOfItself(one.value->id))
        problems.add(index, beginningOf(other) + one.value->id + one.row + ": " +
                                one.what.substr(std::min(one.what.size(), beginningOf(other).size())));
  }
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
      const bool of_file = objectionsIn(scene.models[i], tried.error).front().value == nullptr;
      tried = tryWithout(scene, i, max_force, tried.error, trail, problems, warnings);
      if (of_file) tryOtherGeometry(scene, i, max_force, trail, problems, warnings);
    }
    claims.number(tried.stiffness);
    claims.number(uint32_t{tried.idle ? 1u : 0u});
    claims.number(uint32_t{tried.reads_velocity ? 1u : 0u});
    claims.number(uint32_t{tried.moves ? 1u : 0u});
    packBox(tried.box, boxes);
  }
  return problems.take() + warnings.take() + claims.take() + boxes.take();
}

}  // namespace

ModelTrial tryModels(const scene::Scene& scene, double max_force, const std::vector<bool>& unsound,
                     double setup_seconds) {
  ModelTrial trial;
  if (scene.models.empty()) return trial;
  host::ChildProgress trail;
  SlowSetup slow(scene, trail, setup_seconds);
  const auto work = [&] {
    noteEnd(scene, trail);
    std::string found = tryAll(scene, max_force, unsound, trail);
    trail.mark(static_cast<uint32_t>(scene.models.size()), "");
    return found;
  };
  const int piece_ms = static_cast<int>(setup_seconds * 1e3);
  const host::ChildWatch watch{&trail, piece_ms, [&slow](double seconds) { slow.look(seconds); }, true};
  const auto told = host::runInChild(work, std::max(kTrialLimitMs, 2 * piece_ms), watch);
  if (!told) {
    reportEnd(told.error(), trail, scene, trial.problems);
    return trial;
  }
  host::Unpacker in(*told);
  trial.problems = PackedTexts::read(in, scene);
  trial.warnings = PackedTexts::read(in, scene);
  reportDestructor(trail, scene, trial.warnings);
  for (size_t i = 0; i < scene.models.size() && in.good(); ++i) {
    trial.stiffness.push_back(in.real());
    if (in.count() != 0) warnOfMotion(scene.models[i], i, trial.warnings);
    trial.needs_velocity = in.count() != 0 || trial.needs_velocity;
    trial.moves.push_back(in.count() != 0);
  }
  for (size_t i = 0; i < scene.models.size() && in.good(); ++i) trial.boxes.push_back(readBox(in));
  return trial;
}

}  // namespace hapticd::diagnostics
