// SPDX-License-Identifier: MIT
#include "cli/view/still.hpp"

#include <unistd.h>

#include <filesystem>
#include <optional>

#include "base/file_ending.hpp"
#include "base/shell_word.hpp"
#include "base/short_number.hpp"
#include "cli/import/cad.hpp"
#include "cli/import/mesh.hpp"
#include "cli/import/patches.hpp"
#include "cli/support/command.hpp"
#include "cli/support/model_file.hpp"
#include "cli/support/scratch_folder.hpp"
#include "mesh_import/mesh_file.hpp"
#include "record/recording_file.hpp"
#include "session/replay/about.hpp"
#include "session/telemetry/flight.hpp"

namespace hapticd::cli {

namespace {

namespace fs = std::filesystem;

bool isPatches(const std::string& file) {
  return endingOf(file) == ".bpt";
}

bool isImported(const std::string& file) {
  return isCadFile(file) || importing::isMeshFile(file) || isPatches(file);
}

/// The ending of what a file is imported to.
std::string endingOfModel(const std::string& file) {
  return isPatches(file) ? ".yaml" : ".hpart";
}

/// Makes a model of a CAD file, a mesh or patches. Returns the exit code.
int importInto(const std::string& file, const std::string& out, double scale) {
  importing::Placement placement;
  placement.scale = scale;
  if (isPatches(file)) return importPatches({file, out, file, placement});
  if (isCadFile(file)) {
    CadImport how;
    how.file = how.named = file;
    how.out = out;
    how.placement = placement;
    return importCad(how);
  }
  MeshImport how;
  how.file = how.named = file;
  how.out = out;
  how.placement = placement;
  how.felt = false;
  return importMesh(how);
}

/// Returns the command with which a file is felt.
std::string feltBy(const std::string& file, ModelFile kind, double scale) {
  const std::string name = shellWord(file);
  if (kind == ModelFile::kNone) return "hapticd run " + name + " --view";
  if (!isImported(file)) return "hapticd import " + name + " --scene SCENE.yaml";
  const std::string scaled = scale == 1 ? "" : " --scale " + withDigits(scale, 6);
  return "hapticd import " + name + scaled + " -o " + shellWord(fs::path(file).stem().string() + endingOfModel(file)) +
         " --scene SCENE.yaml";
}

/// Makes a scene of one model. Reports what is wrong.
std::optional<scene::Scene> sceneOf(const std::string& file, ModelFile kind) {
  std::string quoted;
  for (const char c : fs::absolute(file).string()) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  const std::string text = "hapticd: 1\nmodels:\n  - name: model\n    plugin: " +
                           std::string(kind == ModelFile::kSoft ? "mat_deformable" : "nurbs_rigid") +
                           "\n    parameters: {geometry: '" + quoted + "'}\n";
  std::optional<scene::Scene> scene;
  printProblems(scene::checkText(text, fs::current_path() / "view.yaml", catalog(), &scene), stderr);
  if (scene) scene->models[0].name = fs::path(file).stem().string();
  return scene;
}

/// Builds each model, so that the first one that cannot be built is reported before a page opens.
Result<void> tryModels(const scene::Scene& scene) {
  const auto world = servo::World::build(scene, {}, [](int, const std::string&, const std::string&) {});
  return world ? Result<void>{} : Error{world.error()};
}

/// Writes a recording of the scene that has no rows.
Result<void> writeRecording(const scene::Scene& scene, const std::string& file) {
  scene::Scene empty = scene;
  empty.models.clear();
  const auto world = servo::World::build(empty, {}, [](int, const std::string&, const std::string&) {});
  if (!world) return Error{world.error()};
  const servo::RunFacts facts;
  const auto streams = servo::flightStreams(scene, {}, facts.rate, 1, 0);
  auto recording = record::RecordingFile::create(file, streams, servo::aboutRun(scene, **world, {}, facts, streams));
  if (!recording) return Error{recording.error()};
  return (*recording)->close();
}

}  // namespace

bool Still::is(const std::string& file) {
  const std::string ending = endingOf(file);
  for (const char* other : {".yaml", ".yml", ".json", ".hpart", ".ma"})
    if (ending == other) return true;
  return isImported(file);
}

std::unique_ptr<Still> Still::of(const std::string& file, double scale, int& exit_code) {
  auto folder = ScratchFolder::make("still");
  if (!folder) {
    exit_code = fail(kFailed, folder.error());
    return nullptr;
  }
  std::unique_ptr<Still> still(new Still(std::move(*folder)));
  exit_code = still->read(file, scale);
  return exit_code == kWorked ? std::move(still) : nullptr;
}

/// Returns the exit code.
int Still::read(const std::string& file, double scale) {
  std::string shown = file;
  if (std::error_code error; !fs::exists(file, error)) return fail(kBadInput, file + ": there is no such file");
  if (!isImported(file) && scale != 1)
    return fail(kBadInput, file + ": --scale has an effect only with CAD files, meshes and patches (.bpt)");
  if (isImported(file)) {
    shown = folder_.path() + "/" + fs::path(file).stem().string() + endingOfModel(file);
    const int code = importInto(file, shown, scale);
    if (code != kWorked) return code;
  }
  const ModelFile kind = modelFileOf(shown);
  std::optional<scene::Scene> scene =
      kind == ModelFile::kNone ? loadSceneOrReport(shown, "", false) : sceneOf(shown, kind);
  if (!scene) return kBadInput;
  scene->file = file;
  scene->devices.clear();
  if (const auto built = tryModels(*scene); !built) return fail(kBadInput, built.error());
  if (const auto written = writeRecording(*scene, recording()); !written) return fail(kFailed, written.error());
  command_ = feltBy(file, kind, scale);
  return kWorked;
}

}  // namespace hapticd::cli
