// SPDX-License-Identifier: MIT
#include "diagnostics/check/judge_file.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "diagnostics/check/draft_scene.hpp"
#include "diagnostics/check/warning_places.hpp"
#include "diagnostics/check/whole_scene.hpp"
#include "diagnostics/device/device_trial.hpp"
#include "diagnostics/device/device_warnings.hpp"
#include "diagnostics/hand/hand_start.hpp"
#include "diagnostics/reading/key_place.hpp"
#include "diagnostics/scene/model_file_problems.hpp"
#include "scene/device_draft.hpp"
#include "scene/load.hpp"

namespace hapticd::diagnostics {
namespace {

/// Judges one file. All steps add to one result.
class FileJudge {
 public:
  FileJudge(const std::string& file, const CheckOptions& options, host::Catalog& catalog)
      : options_(options), catalog_(catalog), result_{file} {}

  CheckResult judge();

 private:
  void judgeRest();
  void judgeDraft();
  void judgeDevices(bool named);
  void finish();

  const CheckOptions& options_;
  host::Catalog& catalog_;
  CheckResult result_;
};

CheckResult FileJudge::judge() {
  std::optional<scene::Scene> scene;
  result_.problems = scene::checkFile(result_.file, catalog_, &scene);
  if (scene && !options_.device.empty()) {  // the same replacement as in hapticd run --device
    scene::Loaded other = scene::load(result_.file, catalog_, {true, options_.device});
    scene = std::move(other.scene);
    result_.problems = std::move(other.problems);
    result_.whole = result_.problems.empty();
    if (!scene) {
      judgeDevices(false);
      return std::move(result_);
    }
  }
  if (scene && !options_.files_only)
    if (document::Problems bad = badModules(*scene, catalog_); !bad.empty()) {
      document::append(result_.problems, std::move(bad));
      scene.reset();  // the checks of a whole scene would call these modules in this process
    }
  if (scene)
    judgeScene(*scene, options_, catalog_, result_);
  else
    judgeRest();
  finish();
  return std::move(result_);
}

/// Judges a device file, or as much as can be read of a scene that has problems.
void FileJudge::judgeRest() {
  document::Problems& found = result_.problems;
  if (!found.empty()) {
    judgeDraft();
    if (!options_.files_only) judgeDevices(true);
  }
  document::append(found, tryDevice(result_.file, catalog_, found, &result_.warnings));
  if (!document::leavesOut(found, result_.file))
    document::append(result_.warnings, warnOfDevice(result_.file, catalog_, found));
  if (found.empty() && !options_.files_only) found = refusedAlone(result_.file, catalog_, result_.warnings);
  document::sortByPlace(found);
}

/// Judges what could be read of a scene that has problems, so that the user sees all problems at once.
void FileJudge::judgeDraft() {
  const auto draft = scene::sceneDraft(result_.file, catalog_);
  result_.whole = !draft && std::none_of(result_.problems.begin(), result_.problems.end(),
                                         [](const document::Problem& problem) { return problem.key.empty(); });
  // What was left out after a syntax error may be what another value depends on.
  if (!draft || options_.files_only || document::leavesOut(result_.problems, result_.file)) return;
  result_.hands_moved = judgeDraftScene(*draft, catalog_, options_.setup_seconds, result_.problems, result_.warnings);
  document::sortByPlace(result_.problems);
}

/// Judges the device files of a scene with problems, with their modules and values, so that the user sees all problems
/// at once. @param named true if the devices that the scene names are used, and not the one of the option --device
void FileJudge::judgeDevices(bool named) {
  std::set<std::string> others;
  for (const document::Problem& one : result_.problems)
    if (one.place.file != result_.file) others.insert(one.place.file);
  if (const auto draft = scene::sceneDraft(result_.file, catalog_); draft && named)
    for (const scene::Device& device : draft->devices) others.insert(device.file.string());
  for (const std::string& file : others) {
    document::Problems known;
    for (const document::Problem& one : result_.problems)
      if (one.place.file == file) known.push_back(one);
    const document::Problems more = tryDevice(file, catalog_, known);
    document::append(known, more);
    document::append(result_.problems, more);
    if (document::leavesOut(known, file)) continue;
    document::append(result_.warnings, warnOfDevice(file, catalog_, known));
  }
  document::sortByPlace(result_.problems);
}

/// Removes warnings that may only follow from text that a syntax error left out, or put into another place.
void dropWarningsThatFollow(CheckResult& result) {
  document::Problems all;
  for (const document::Problem& one : result.problems)
    if (!one.left_out.empty()) all.push_back(one);  // these are never removed
  const auto errors = static_cast<std::ptrdiff_t>(all.size());
  document::append(all, result.warnings);
  document::dropFollowUps(all);
  result.warnings.assign(all.begin() + errors, all.end());
}

/// Puts all that was found into its place, and removes what only follows from something else.
void FileJudge::finish() {
  const std::filesystem::path file = result_.file;
  const bool sound = result_.problems.empty();
  result_.whole = result_.whole && sound;
  result_.hand_left_out =
      !sound && !options_.files_only && placeOfKey(file, "hand") && placeOfKey(file, "models") && !result_.hands_moved;
  placeWarnings(result_.warnings);
  placeInModelFiles(result_.warnings);
  separateModelFiles(result_.problems);
  document::dropFollowUps(result_.problems);
  dropWarningsThatFollow(result_);
}

}  // namespace

CheckResult judgeFile(const std::string& file, const CheckOptions& options, host::Catalog& catalog) {
  return FileJudge(file, options, catalog).judge();
}

}  // namespace hapticd::diagnostics
