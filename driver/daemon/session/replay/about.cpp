// SPDX-License-Identifier: MIT
#include "session/replay/about.hpp"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "base/regular_file.hpp"
#include "document/json_text.hpp"
#include "document/node.hpp"
#include "host/class_params.hpp"
#include "record/scene_json.hpp"
#include "session/replay/former_defaults.hpp"
#include "session/telemetry/event_finder.hpp"
#include "world/instructions.hpp"

namespace hapticd::servo {

namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMostJoints = HDV_MAX_JOINTS;

std::string utcNow() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  return std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts) > 0 ? text : "";
}

std::string machine() {
  utsname name{};
  return uname(&name) == 0 ? std::string(name.sysname) + " " + name.release + " " + name.machine : "";
}

/// Returns the folder to which paths are relative, in the scene and in models that are added during the run.
std::string folderOf(const std::filesystem::path& file) {
  std::error_code unknown;
  return std::filesystem::absolute(file, unknown).parent_path().string();
}

Json infoJson(const hdv_info& info) {
  Json torque = Json::array(), low = Json::array(), high = Json::array();
  const auto text = [](double value) { return std::isfinite(value) ? Json(value) : Json(value < 0 ? "-inf" : "inf"); };
  for (size_t i = 0; i < kMostJoints; ++i) {
    torque.push_back(text(info.max_torque[i]));
    low.push_back(text(info.position_min[i]));
    high.push_back(text(info.position_max[i]));
  }
  return {{"joint_count", info.joint_count},
          {"capabilities", info.capabilities},
          {"buttons", info.buttons},
          {"rate_hz", info.rate_hz},
          {"max_force", info.max_force},
          {"continuous_force", info.continuous_force},
          {"max_stiffness", info.max_stiffness},
          {"resolution_m", info.resolution_m},
          {"damping", info.damping},
          {"mass_kg", info.mass_kg},
          {"max_torque", torque},
          {"position_min", low},
          {"position_max", high},
          {"serial", std::string(info.serial, strnlen(info.serial, sizeof info.serial))},
          {"firmware", std::string(info.firmware, strnlen(info.firmware, sizeof info.firmware))},
          {"product", std::string(info.product, strnlen(info.product, sizeof info.product))}};
}

/// Describes how the links of an arm are connected, for programs that draw it.
Json linksJson(Arm& arm) {
  const hdv_ext_links* links = arm.device().links();
  if (links == nullptr) return Json();
  const Eigen::Vector3d base = arm.mount() * Eigen::Map<const Eigen::Vector3d>(links->base) + arm.origin();
  return {{"parent", std::vector<int32_t>(links->parent, links->parent + links->link_count)},
          {"base", {base.x(), base.y(), base.z()}}};
}

hdv_info toInfo(const Json& json) {
  hdv_info info{};
  info.struct_size = sizeof info;
  info.joint_count = json.at("joint_count");
  info.capabilities = json.at("capabilities");
  info.buttons = json.at("buttons");
  info.rate_hz = json.at("rate_hz");
  info.max_force = json.at("max_force");
  info.continuous_force = json.at("continuous_force");
  info.max_stiffness = json.at("max_stiffness");
  info.resolution_m = json.at("resolution_m");
  info.damping = json.at("damping");
  info.mass_kg = json.at("mass_kg");
  const auto real = [](const Json& value) {
    return value.is_string() ? (value == "-inf" ? -HUGE_VAL : HUGE_VAL) : value.get<double>();
  };
  for (size_t i = 0; i < kMostJoints; ++i) {
    info.max_torque[i] = real(json.at("max_torque").at(i));
    info.position_min[i] = real(json.at("position_min").at(i));
    info.position_max[i] = real(json.at("position_max").at(i));
  }
  return info;
}

/// Lists names and indices of the parameters that may change in a run: its orders have the indices.
Json liveJson(const hsp_class& shape) {
  Json list = Json::array();
  for (uint32_t i = 0; i < shape.param_count; ++i)
    if (const hsp_param& param = host::paramAt(shape, i); (param.flags & HSP_P_LIVE) != 0)
      list.push_back({{"id", param.id}, {"index", i}});
  return list;
}

Json modelsJson(const World& world) {
  Json list = Json::array();
  for (const auto& shape : world.shapes()) {
    if (!shape) continue;
    const hsp_class& c = shape->description();
    list.push_back(
        {{"name", shape->name()}, {"plugin", c.name}, {"id", c.id}, {"version", c.version}, {"live", liveJson(c)}});
  }
  return list;
}

/// Lists every file on which the forces of the scene depend.
Json filesJson(const scene::Scene& scene) {
  std::set<std::string> files;
  for (const scene::Model& model : scene.models)
    for (std::string& file : filesOf(model)) files.insert(std::move(file));
  for (const scene::Device& device : scene.devices) files.insert(device.library.string());
  Json list = Json::array();
  for (const std::string& file : files) list.push_back({{"path", file}, {"hash", fingerprint(file)}});
  return list;
}

/// Lists the streams in the order of their numbers, with name and size of a row.
Json streamsJson(const std::vector<record::StreamSpec>& streams) {
  Json list = Json::array();
  for (size_t i = 0; i < streams.size(); ++i)
    list.push_back({{"number", i}, {"name", streams[i].name}, {"row_bytes", streams[i].layout.rowBytes()}});
  return list;
}

std::string textOf(const std::filesystem::path& file) {
  auto text = readRegular(file.string(), document::kMaxFileBytes);
  return text ? *std::move(text) : std::string();
}

}  // namespace

record::About aboutRun(const scene::Scene& scene, const World& world, const Arms& arms, const RunFacts& facts,
                       const std::vector<record::StreamSpec>& streams) {
  Json devices = Json::array();
  for (const auto& arm : arms) {
    const hdv_class& c = arm->device().description();
    devices.push_back({{"name", arm->device().name()},
                       {"module", c.name},
                       {"id", c.id},
                       {"version", c.version},
                       {"info", infoJson(arm->info())}});
    if (const Json links = linksJson(*arm); !links.is_null()) devices.back()["links"] = links;
  }
  Json json = {{"format", record::kRecordingFormat},
               {"hapticd", HAPTICD_VERSION},
               {"abi", fmt::format("{}.{}", HSP_ABI_MAJOR, HSP_ABI_MINOR)},
               {"compiler", __VERSION__},
               {"machine", machine()},
               {"instructions", takenInstructions(scene.servo)},
               {"started", utcNow()},
               {"folder", folderOf(scene.file)},
               {"rate_hz", facts.rate},
               {"period_ns", facts.period_ns},
               {"ticks", facts.ticks},
               {"virtual_time", facts.virtual_time},
               {"enable_released_first", !facts.found_pressed},
               {"claims_hold_torques", !facts.former_claims},
               {"slow_arms_push_less", !facts.full_when_slow},
               {"depth_of_felt_models", !facts.counts_unfelt},
               {"spares_steady_pushes", !facts.former_passivity},
               {"gaps_are_jumps", !facts.follows_gaps},
               {"models", modelsJson(world)},
               {"devices", std::move(devices)},
               {"files", filesJson(scene)}};
  json["streams"] = streamsJson(streams);
  json["events"] = Json::array();
  for (uint32_t kind = 0; kind < HAPTICD_EVENT_KINDS; ++kind) json["events"].push_back(nameOfEvent(kind));
  json["columns"] = document::parseJsonOrThrow(record::columnsJson(streams));
  json["scene"] = document::parseJsonOrThrow(record::sceneToJson(scene));
  return {document::jsonLine(json), textOf(scene.file)};
}

Result<RecordedRun> readAbout(const std::string& json_text) {
  try {
    const Json json = document::parseJsonOrThrow(json_text);
    RecordedRun run;
    run.facts.rate = json.at("rate_hz");
    run.facts.period_ns = json.at("period_ns");
    run.facts.ticks = json.at("ticks");
    run.facts.virtual_time = json.at("virtual_time");
    run.facts.found_pressed = !json.value("enable_released_first", false);
    run.facts.former_claims = !json.value("claims_hold_torques", false);
    run.facts.full_when_slow = !json.value("slow_arms_push_less", false);
    run.facts.counts_unfelt = !json.value("depth_of_felt_models", false);
    run.facts.former_passivity = !json.value("spares_steady_pushes", false);
    run.facts.follows_gaps = !json.value("gaps_are_jumps", false);
    run.version = json.at("hapticd");
    run.started = json.at("started");
    run.instructions = json.value("instructions", "");
    for (const Json& device : json.at("devices")) run.devices.push_back(toInfo(device.at("info")));
    for (const Json& file : json.at("files")) run.files.push_back({file.at("path"), file.at("hash")});
    auto scene = record::sceneFromJson(json.at("scene").dump());
    if (!scene) return Error{scene.error()};
    run.scene = std::move(*scene);
    for (const Json& model : json.at("models"))
      for (scene::Model& other : run.scene.models)
        if (model.at("name") == other.name) useFormerDefaults(other, model.at("id"), model.at("version"));
    for (const Json& model : json.at("models"))
      for (const Json& live : model.value("live", Json::array()))
        run.live[model.at("name")][live.at("index").get<uint32_t>()] = live.at("id");
    const bool possible = std::isfinite(run.facts.rate) && run.facts.rate > 0 && run.facts.period_ns > 0;
    if (!possible || run.devices.size() != run.scene.devices.size())
      return Error{"the recording is damaged: its description has an impossible rate or impossible devices"};
    for (const hdv_info& info : run.devices)
      if (info.joint_count > HDV_MAX_JOINTS)
        return Error{"the recording is damaged: its description has a device with too many joints"};
    return run;
  } catch (const std::exception& error) {
    return Error{std::string("the description in the recording cannot be read: ") + error.what()};
  }
}

}  // namespace hapticd::servo
