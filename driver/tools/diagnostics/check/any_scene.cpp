// SPDX-License-Identifier: MIT
#include "diagnostics/check/any_scene.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "diagnostics/hand/hand_given_twice.hpp"
#include "diagnostics/reading/number_slips.hpp"
#include "diagnostics/scene/setting_plausibility.hpp"
#include "diagnostics/scene/value_plausibility.hpp"
#include "document/node.hpp"
#include "host/device_instance.hpp"
#include "scene/load.hpp"

namespace hapticd::diagnostics {

scene::Scene withArm(scene::Scene scene, host::Catalog& catalog) {
  if (const auto file = host::shippedFile(scene::kDefaultDevice); scene.devices.empty() && file)
    if (auto loaded = scene::loadDevice(*file, catalog); loaded.device) {
      scene.devices.push_back(*loaded.device);
      scene.devices.back().chosen_by_default = true;
    }
  return scene;
}

void warnOfSlips(const std::filesystem::path& file, document::Problems& warnings) {
  document::Problems unread;  // is reported by those who load the scene
  const auto root = document::readFileOn(file, unread);
  if (!root) return;
  warnOfZeros(*root, file.string(), warnings);
  warnOfTurns(*root, file.string(), warnings);
  warnOfMounts(*root, file.string(), warnings);
  warnOfHandGivenTwice(*root, file.string(), warnings);
}

void addImplausible(const scene::Scene& scene, const ModelBoxes& boxes, host::Catalog& catalog,
                    const UnreadKeys& unread, document::Problems& warnings) {
  document::Problems more = implausibleValues(scene, boxes, catalog, unread);
  for (const document::Problem& one : implausibleSettings(scene, boxes))
    // Warnings about arms can be trusted, because judgeDraftScene() leaves out arms with problems.
    if ((one.key.starts_with("devices[") || !unread.has(one.key)) &&
        !(one.key == "clients.answer_time" && unread.has("servo.rate")) &&
        !(one.what.find("no program may push") != std::string::npos && unread.has("clients.mode")))
      more.push_back(one);
  const size_t before = warnings.size();
  for (const document::Problem& one : more)
    if (std::none_of(warnings.begin(), warnings.begin() + static_cast<std::ptrdiff_t>(before),
                     [&one](const document::Problem& told) {
                       return told.key == one.key && told.place.line == one.place.line &&
                              told.place.column == one.place.column && !told.key.ends_with(".pose");
                     }))
      warnings.push_back(one);
}

}  // namespace hapticd::diagnostics
