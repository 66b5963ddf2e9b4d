// SPDX-License-Identifier: MIT
/// `hapticd device info`: prints the facts of one arm.
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "base/shell_word.hpp"
#include "cli/device/file.hpp"
#include "cli/device/joint_angles.hpp"
#include "cli/support/class_info.hpp"
#include "cli/support/command.hpp"
#include "diagnostics/device/arm_reach.hpp"
#include "diagnostics/device/device_trial.hpp"
#include "diagnostics/device/enable_button.hpp"
#include "document/reader.hpp"
#include "host/device_instance.hpp"
#include "world/arm_force.hpp"

namespace hapticd::cli {

using namespace diagnostics;
namespace {

using Json = nlohmann::ordered_json;

/// Prints the limits of an arm. @param most [N] device.max_force of the device file; 0 if it is not given
void printLimits(const scene::Limits& limits, double most) {
  const auto text = [](double value, const char* unit, const char* none) {
    return value == 0 ? std::string(none) : document::numberText(value) + " " + unit;
  };
  std::printf("limits\n  force      %s\n  torque     %s\n  slew       %s\n  velocity   %s\n  workspace  %s\n",
              text(limits.force > 0 ? limits.force : most, "N", "none known: only the motors bound it").c_str(),
              text(limits.torque, "N m", "none: only the motors bound it").c_str(),
              text(limits.slew, "N/s", "none").c_str(),
              (limits.velocity ? text(*limits.velocity, "m/s", "none") : std::string("5 m/s on real hardware")).c_str(),
              text(limits.workspace, "m", "none").c_str());
  std::printf("  enable     %s\n",
              !limits.enable.button ? "none: no button must be held"
                                    : ((limits.enable.mode == scene::EnableMode::kHold ? "while " : "on and off by ") +
                                       diagnostics::enableButtonText(*limits.enable.button))
                                          .c_str());
  std::printf("  ramps      %g s to full force, %g s to zero\n  passivity  %s\n", limits.ramp_in, limits.ramp_out,
              !limits.passivity   ? "on for an arm that was never tried on hardware, and where programs may push"
              : *limits.passivity ? "on: a damper takes up energy that the loop creates"
                                  : "off");
}

void printCapabilities(uint32_t flags) {
  static constexpr struct {
    uint32_t flag;
    const char* text;
  } kTexts[] = {{HDV_C_VELOCITY, "measures joint velocities"},
                {HDV_C_TORQUE, "measures joint torques"},
                {HDV_C_POSITION, "takes position references"},
                {HDV_C_PACING, "can pace the servo loop"},
                {HDV_C_WATCHDOG, "hardware watchdog cuts its motors"},
                {HDV_C_SIMULATED, "simulated"},
                {HDV_C_CALIBRATION, "must be calibrated: hapticd device calibrate FILE"},
                {HDV_C_UNVERIFIED, "description not tried on hardware"},
                {HDV_C_FORCE_ASSUMED, "continuous force is not stated for this arm"}};
  for (const auto& capability : kTexts)
    if ((flags & capability.flag) != 0) std::printf("  %s\n", capability.text);
}

/// Prints where the tip can be, within the limits of the joints.
void printReach(const host::DeviceInstance& device) {
  if (const auto box = diagnostics::boxOfReach(device))
    std::printf("  reach of the tip in the device frame: x %.3f to %.3f, y %.3f to %.3f, z %.3f to %.3f m\n",
                box->min().x(), box->max().x(), box->min().y(), box->max().y(), box->min().z(), box->max().z());
}

void printJoints(const host::DeviceInstance& device) {
  const hdv_info& info = device.info();
  for (uint32_t i = 0; i < info.joint_count; ++i) {
    const bool sliding = slides(device, i);
    const char *position = sliding ? "m" : "rad", *force = sliding ? "N" : "N m";
    std::printf("  joint %u: ", i + 1);
    if (info.position_min[i] == 0 && info.position_max[i] == 0)
      std::printf("range unknown, ");
    else
      std::printf("%g to %g %s, ", info.position_min[i], info.position_max[i], position);
    if (info.max_torque[i] > 0)
      std::printf("its motor up to %g %s\n", info.max_torque[i], force);
    else
      std::printf("no bound of its motor is known\n");
  }
}

void printHardware(host::DeviceInstance& device) {
  auto opened = device.open();
  if (!opened) return (void)std::printf("hardware: not available\n  %s\n", opened.error().c_str());
  const hdv_info& info = device.info();
  std::printf("hardware: %s serial \"%s\" firmware \"%s\"\n", info.product, info.serial, info.firmware);
  std::printf("  rate %g Hz, force %g N (%g N continuous), stiffness up to %g N/m\n", info.rate_hz, info.max_force,
              info.continuous_force, info.max_stiffness);
  std::printf("  resolution %g m, felt mass %g kg, damping %g N s/m, %u buttons\n", info.resolution_m, info.mass_kg,
              info.damping, info.buttons);
  printCapabilities(info.capabilities);
  printJoints(device);
  printReach(device);
}

bool hasParameter(const hdv_class& module, const std::string& id) {
  const auto* table = reinterpret_cast<const char*>(module.params);
  for (uint32_t i = 0; i < module.param_count; ++i)
    if (id == reinterpret_cast<const hsp_param*>(table + size_t{i} * module.params->struct_size)->id) return true;
  return false;
}

/// Prints what a user must know before the arm is opened: whether its description was tried on hardware, and whether
/// its weight is compensated.
void printDoubts(const scene::Device& description, const host::DeviceInstance& device) {
  constexpr const char* kVerified = "device.verified";
  const bool tried = numberIn(description.parameters, kVerified) != 0;
  if (hasParameter(device.description(), kVerified) && !tried) std::printf("  description not tried on hardware\n");
  const hdv_ext_kinematics& kinematics = device.kinematics();
  std::array<double, HDV_MAX_JOINTS> q, torque{};
  q.fill(0.5);  // not a special pose, in which an arm may be balanced
  constexpr double kAnyway[3] = {4, -8, 3};
  if (kinematics.gravity(device.handle(), q.data(), kAnyway, torque.data()) < 0) return;
  if (std::all_of(torque.begin(), torque.end(), [](double t) { return t == 0; }))
    std::printf("  %s: gravity is not compensated\n", hasParameter(device.description(), "arm.masses")
                                                          ? "no masses in its description"
                                                          : "its module carries no weight (a vendor's library may)");
}

/// Prints a message, unless it is an error: errors are also returned as results, and the caller prints them.
void logButNoErrors(int level, const std::string& who, const std::string& text) {
  if (level != HSP_LOG_ERROR) logToTerminal(level, who, text);
}

/// Returns the box that the tip can reach, in m in the device frame; null if it is unknown.
Json reachJson(const host::DeviceInstance& device) {
  const auto box = diagnostics::boxOfReach(device);
  if (!box) return {};
  return {{"min", {box->min().x(), box->min().y(), box->min().z()}},
          {"max", {box->max().x(), box->max().y(), box->max().z()}}};
}

/// Returns the facts for programs. Opens the arm if it is plugged in.
Json infoJson(const scene::Device& description, host::DeviceInstance& device) {
  const Eigen::Vector3d& p = description.mount.position;
  const Eigen::Quaterniond& q = description.mount.orientation;
  const auto opened = device.open();
  Json json{{"name", description.name},
            {"file", description.file.string()},
            {"module", description.module},
            {"joints", device.kinematics().joint_count},
            {"mount", {{"position", {p.x(), p.y(), p.z()}}, {"orientation", {q.w(), q.x(), q.y(), q.z()}}}},
            {"limits",
             {{"force", description.limits.force},
              {"torque", description.limits.torque},
              {"slew", description.limits.slew},
              {"velocity", description.limits.velocity ? Json(*description.limits.velocity) : Json()},
              {"workspace", description.limits.workspace}}},
            {"available", static_cast<bool>(opened)}};
  if (!opened) return json["why"] = opened.error(), json;
  const hdv_info& info = device.info();
  json["hardware"] = {{"product", info.product},
                      {"serial", info.serial},
                      {"firmware", info.firmware},
                      {"rate_hz", info.rate_hz},
                      {"max_force", info.max_force},
                      {"continuous_force", info.continuous_force},
                      {"max_stiffness", info.max_stiffness},
                      {"resolution_m", info.resolution_m},
                      {"mass_kg", info.mass_kg},
                      {"damping", info.damping},
                      {"buttons", info.buttons},
                      {"reach_m", reachJson(device)},
                      {"simulated", (info.capabilities & HDV_C_SIMULATED) != 0},
                      {"verified", (info.capabilities & HDV_C_UNVERIFIED) == 0}};
  return json;
}

int info(const std::string& file, bool with_parameters, bool as_json) {
  const auto loaded = loadDeviceOrReport(file);
  if (!loaded) return kBadInput;
  const scene::Device& description = *loaded;
  auto device = host::DeviceInstance::create(description, logButNoErrors);
  if (!device) return fail(kFailed, device.error());
  if (as_json) return printJson(infoJson(description, **device));
  const hdv_class& module = (*device)->description();
  std::printf("%s\n  file    %s\n  module  %s %s (%s)\n  %s\n  joints  %u\n", description.name.c_str(),
              description.file.c_str(), module.name, module.version, description.library.c_str(), module.doc,
              (*device)->kinematics().joint_count);
  const Eigen::Vector3d& p = description.mount.position;
  const Eigen::Quaterniond& q = description.mount.orientation;
  std::printf("  mount   position [%g, %g, %g] m, orientation [%g, %g, %g, %g]\n", p.x(), p.y(), p.z(), q.w(), q.x(),
              q.y(), q.z());
  printDoubts(description, **device);
  scene::Scene alone;
  alone.devices.push_back(description);
  printLimits(description.limits, servo::maxForceOf(alone));
  printHardware(**device);
  if (with_parameters)
    if (auto about = catalog().device(description.module)) printClass(**about, description.parameters);
  return kWorked;
}

}  // namespace

void addDevice(const Command& app, int& exit_code) {
  const Command command = app.addSubcommand("device", "Show, calibrate and check arms.");
  command.requireSubcommand();
  command.footer("Example:\n  hapticd device info config/devices/simulated-premium15.yaml");

  auto file = std::make_shared<std::string>();
  const Command info_command =
      command.addSubcommand("info", "Show the facts of one arm. Opens the arm if it is plugged in, but moves nothing.");
  info_command.addOption("file", *file, "device file (YAML)").required();
  info_command.footer("Example:\n  hapticd device info config/devices/simulated-premium15.yaml");
  auto parameters = std::make_shared<bool>(false), json = std::make_shared<bool>(false);
  info_command.addFlag("--parameters", *parameters, "also print every parameter of the module");
  info_command.addFlag("--json", *json, "print JSON");
  info_command.callback([file, parameters, json, &exit_code] { exit_code = info(*file, *parameters, *json); });
}

}  // namespace hapticd::cli
