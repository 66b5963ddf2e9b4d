// SPDX-License-Identifier: MIT
#include "diagnostics/device/arm_controls.hpp"

#include <cmath>
#include <optional>

#include "codec/wire_overlap.hpp"
#include "diagnostics/device/device_trial.hpp"
#include "diagnostics/device/device_wire.hpp"
#include "diagnostics/device/enable_button.hpp"
#include "diagnostics/device/slow_arm.hpp"
#include "document/reader.hpp"
#include "scene/load.hpp"
#include "servo/safety/held_command.hpp"
#include "world/arm_force.hpp"

namespace hapticd::diagnostics {

namespace {

using document::numberText;

ControlState onIf(bool has) {
  return has ? ControlState::kOn : ControlState::kOff;
}

/// Returns the control (safety measure) for a limit of the device file. It is off if the limit is not given.
/// @param without text of the control if the limit is not given
Control bound(const char* hazards, const char* name, double value, const char* unit, const std::string& without) {
  return {hazards, name, onIf(value > 0), value > 0 ? numberText(value) + " " + unit : without};
}

/// Adds the controls about time: what the hardware does by itself when commands stop, and how long a sample is trusted.
/// These facts come from the open arm, or else from its wire format.
void addTimes(const host::DeviceInstance& device, bool opened, const std::optional<codec::Wire>& wire,
              std::vector<Control>& to) {
  const hdv_info& info = device.info();
  const bool known = opened || wire, isSimulated = opened && (info.capabilities & HDV_C_SIMULATED) != 0;
  const bool watchdog = opened ? (info.capabilities & HDV_C_WATCHDOG) != 0 : wire && wire->cutsSoon();
  const std::string after = wire && wire->watchdog > 0 ? numberText(wire->watchdog * 1e3) + " ms after the last command"
                                                       : std::string("when commands stop");
  to.push_back({"H30", "the hardware's own watchdog", known ? onIf(watchdog) : ControlState::kUnknown,
                !known     ? "only the arm itself can tell, and it is not plugged in"
                : watchdog ? "the arm cuts its motors " + after
                : isSimulated
                    ? "a simulated arm has none"
                    : "the arm holds the last force when the machine dies: keep a switch within reach; if it cuts "
                      "its motors by itself, give wire.watchdog"});
  const double rate = opened ? info.rate_hz : wire ? wire->rate : 0;
  to.push_back({"H3", "force of an old sample", known ? onIf(rate > 0) : ControlState::kUnknown,
                !known     ? "the arm itself says its rate"
                : rate > 0 ? "fades after " + numberText(2000 / rate) + " ms"
                           : "held for up to 50 ms: give the rate of the arm"});
  if (isSimulated) return;
  const double most = rate > 0 ? servo::mostForceAt(kFastServo, rate, info.max_force) : HUGE_VAL;
  to.push_back({"H21", "force that suits its rate", known ? onIf(rate > 0) : ControlState::kUnknown,
                !known      ? "the arm itself says its rate"
                : rate <= 0 ? "only the servo's rate counts: give the rate of the arm"
                : most < HUGE_VAL
                    ? "at most " + numberText(std::round(1e3 * most) * 1e-3) + " N, because it sends only " +
                          numberText(rate) + " samples a second; from 715 Hz on it may have its full force"
                    : "all of its force; less if the servo is slower than 358 Hz"});
}

/// Adds the controls that detect a wrong or old report.
void addReports(const std::optional<codec::Wire>& wire, std::vector<Control>& to) {
  if (!wire) return;
  const bool sum = wire->input.has(codec::Role::kChecksum), whole = codec::outsideChecksum(wire->input).empty(),
             counter = wire->input.has(codec::Role::kSequence);
  to.push_back({"H1", "a misread report is noticed", onIf(sum && whole),
                sum && !whole ? "its checksum leaves out positions: see from and to of the checksum"
                : sum ? "by its checksum"
                      : "wire.input has no checksum, so bad reports are found only by the checks of the bus, or when "
                        "the tip seems too fast"});
  const bool clock = wire->clockTells();
  to.push_back({"H3", "a repeated report is noticed", onIf(counter || clock),
                counter ? "by its counter"
                : clock ? "by the arm's clock (time)"
                        : "no counter in wire.input: firmware that hangs may send the last one for ever"});
}

/// Returns the control for limits.enable. @param buttons number of buttons of the arm
Control enableSwitch(const scene::Enable& enable, uint32_t buttons) {
  if (!enable.button)
    return {"H20", "enable switch", ControlState::kOff,
            "give limits: {enable: {button: 0}}: forces only while that button is held"};
  const std::string button = enableButtonText(*enable.button);
  if (static_cast<uint32_t>(*enable.button) >= buttons)
    return {"H20", "enable switch", ControlState::kOff, button + ", which the arm does not have: `run` refuses it"};
  return {"H20", "enable switch", ControlState::kOn,
          button + ", " + (enable.mode == scene::EnableMode::kHold ? "held" : "pressed")};
}

void addLimits(const scene::Limits& limits, double force, bool simulated, uint32_t buttons, std::vector<Control>& to) {
  to.push_back(bound("H16", "largest force", force, "N", "give limits.force"));
  to.push_back(bound("H18", "growth of the force", limits.slew, "N/s", "limits.slew is 0"));
  const double velocity = limits.velocity.value_or(simulated ? 0 : 5);
  to.push_back(bound("H1 H2", "speed between samples", velocity, "m/s",
                     simulated ? "a simulated arm has no encoders; give limits.velocity" : "limits.velocity is 0"));
  to.push_back(bound("H19", "impulse", limits.impulse, "N s within any 0.1 s", "give limits.impulse"));
  to.push_back(bound("H19", "power to the hand", limits.power, "W", "give limits.power"));
  to.push_back(bound("A3", "workspace", limits.workspace, "m", "give limits.workspace"));
  to.push_back({"A1", "heat of the motors", onIf(!limits.motors.empty()),
                limits.motors.empty()
                    ? "give limits.motors, from their data sheet (driver/docs/devices.md has an example)"
                    : std::to_string(limits.motors.size()) + " motors"});
  to.push_back(enableSwitch(limits.enable, buttons));
  const double weight = limits.weight.value_or(force);
  to.push_back({"H23", "bound of the arm's own weight", onIf(limits.weight || force > 0),
                weight > 0 ? numberText(weight) + " N at the tip" : "it is not carried at all"});
}

}  // namespace

const char* nameOf(ControlState state) {
  return state == ControlState::kOn ? "on" : state == ControlState::kOff ? "off" : "unknown";
}

std::vector<Control> controlsOf(const scene::Device& description, const host::DeviceInstance& device, bool opened) {
  const hdv_info& info = device.info();
  const bool simulated = opened && (info.capabilities & HDV_C_SIMULATED) != 0;
  scene::Scene alone;
  alone.devices.push_back(description);
  const double force = opened ? servo::maxForceOf(alone, {info}) : servo::maxForceOf(alone);
  std::vector<Control> controls{{"H4 H6 H8 H9 H13 H17 H21", "always", ControlState::kOn,
                                 "numbers are finite, orientations of unit length, forces explained by motion; "
                                 "a fault takes the force away within 2 ms"}};
  addLimits(description.limits, force, simulated, opened ? info.buttons : 32, controls);
  const auto has = [&](const char* name) { return device.description().extension(device.handle(), name) != nullptr; };
  controls.push_back({"H26 H33", "cut by a watchdog thread", onIf(has(HDV_EXT_CUT)),
                      has(HDV_EXT_CUT) ? "the module cuts its motors from any thread" : "the module has no hdv.cut"});
  controls.push_back({"H30 H32", "silenced by another process", onIf(has("hdv.silence/1")),
                      has("hdv.silence/1") ? "a guard switches the motors off once the daemon is gone"
                                           : "the module does not say how, so only the arm itself can do it"});
  const auto wire = wireOf(description, device.kinematics().joint_count);
  addTimes(device, opened, wire, controls);
  addReports(wire, controls);
  const bool guarded = description.limits.passivity.value_or(opened && (info.capabilities & HDV_C_UNVERIFIED) != 0);
  controls.push_back({"H22", "passivity controller",
                      opened || description.limits.passivity ? onIf(guarded) : ControlState::kUnknown,
                      guarded ? "takes away energy that the loop creates" : "give limits.passivity: true"});
  controls.push_back({"H5", "calibration", onIf(device.calibration() != nullptr),
                      device.calibration() != nullptr ? "no force before the arm has its zero"
                                                      : "none needed: its positions are absolute"});
  return controls;
}

/// Drops messages: an arm that is not plugged in is not an error here, and facts that only the arm can give stay
/// unknown.
static void logNothing(int, const std::string&, const std::string&) {}

std::optional<ArmControls> controlsOfFile(const std::string& file, host::Catalog& catalog,
                                          document::Problems& problems) {
  const scene::LoadedDevice loaded = scene::loadDevice(file, catalog);
  problems = loaded.problems;
  if (!loaded.device) return std::nullopt;
  document::Problems doubts;
  const document::Problems wrong = tryDevice(file, catalog, {}, &doubts);
  document::append(problems, wrong);
  if (!wrong.empty()) return std::nullopt;
  auto device = host::DeviceInstance::create(*loaded.device, logNothing);
  if (!device) return document::report(problems, file, 0, 0, "", device.error()), std::nullopt;
  const auto opened = (*device)->open();
  ArmControls found;
  for (const document::Problem& doubt : doubts) found.doubts.push_back(doubt.what);
  found.arm = loaded.device->name;
  found.opened = static_cast<bool>(opened);
  if (!opened) found.why = opened.error();
  if (const scene::Value* id = givenIn(loaded.device->parameters, "usb.id")) found.usb_id = id->text;
  found.controls = controlsOf(*loaded.device, **device, found.opened);
  const uint32_t capabilities = found.opened ? (*device)->info().capabilities : 0;
  const auto wire = wireOf(*loaded.device, (*device)->kinematics().joint_count);
  found.repeats_pass = wire && !wire->clockTells() && !wire->input.has(codec::Role::kSequence);
  found.slow = slownessOf(*loaded.device, kFastServo);
  found.simulated = (capabilities & HDV_C_SIMULATED) != 0;
  found.watchdog = (capabilities & HDV_C_WATCHDOG) != 0 || (!found.opened && wire && wire->cutsSoon());
  found.silenced_after_us = (*device)->silenceable() || found.watchdog || found.simulated;
  return found;
}

}  // namespace hapticd::diagnostics
