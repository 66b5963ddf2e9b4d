// SPDX-License-Identifier: MIT
/// What the device file of an arm behind a wire may say.
#pragma once
#include <array>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "codec/wire_schema.hpp"
#include "hapticd/parameters.hpp"
#include "wire_arm/mechanism.hpp"
#include "wire_arm/transport.hpp"

namespace hapticd::wire_arm {

inline constexpr const char* kKinds[] = {"phantom", "delta", "chain"};
inline constexpr const char* kMethods[] = {"none", "device", "pose"};
inline constexpr const char* kLoaders[] = {"none", "falcon"};

/// The values of the parameters; every arm with a wire derives from them.
struct Parameters : MechanismParameters {
  std::string id, serial, wire, instructions, firmware;  // those from id to interface, firmware and loader: USB alone
  int interface = -1, method = 0, loader = 0;
  std::vector<double> pose, max_torque;
  double max_force = 0, continuous_force = 0, max_stiffness = 0, mass = 0, damping = 0;
  double stale = 0, least_rate = 0, recovery = 0, ramp = 0, max_speed = 0;
  bool verified = false;
};

template <class T>
struct ParameterTable {
  using F = Fields<T>;
  static constexpr Field<T> withSchema(Field<T> field, const char* const* schema) {
    field.param.choices = schema;
    field.param.choice_count = 1;
    return field;
  }
  static constexpr auto usb() {
    return std::array{
        F::text("usb.id", &T::id, "", "Vendor and product id, hexadecimal, \"1234:0006\".", HSP_P_REQUIRED),
        F::text("usb.serial", &T::serial, "", "Serial number; left out: the first such device that is free."),
        F::integer("usb.interface", &T::interface, "", -1, 255, -1, "USB interface; -1: any (HID), 0 (bulk)."),
        F::choice("loader", &T::loader, kLoaders, 0, "How firmware gets into the device; falcon: Novint's protocol."),
        F::path("firmware", &T::firmware, "Firmware image for the loader; not shipped.")};
  }
  static constexpr auto device() {
    return std::array{
        withSchema(F::data("wire", &T::wire, nullptr, "Reports, framing, start-up and timing: see devices.md.",
                           HSP_P_REQUIRED),
                   codec::kWireSchema),
        F::choice("calibration.method", &T::method, kMethods, 0,
                  "none: absolute encoders; device: it finds its zero and says so; pose: held in a known pose."),
        F::array("calibration.pose", &T::pose, "rad", 1, 0, 16, -100, 100, "[]", "pose: joint positions there."),
        F::text("calibration.instructions", &T::instructions, "Hold the arm as its manual says.",
                "What the user must do with the arm before it is calibrated."),
        F::boolean("device.verified", &T::verified, false, "This description was tried on hardware."),
        F::real("device.max_force", &T::max_force, "N", 0, 1000, 0, "Largest force at the tip; 0: unknown."),
        F::real("device.continuous_force", &T::continuous_force, "N", 0, 1000, 0, "Force for any length of time."),
        F::real("device.max_stiffness", &T::max_stiffness, "N/m", 0, 1e6, 0, "Stiffness found stable; 0: unknown."),
        F::real("device.mass", &T::mass, "kg", 0, 100, 0, "Mass felt at the tip; 0: unknown."),
        F::real("device.damping", &T::damping, "N s/m", 0, 1000, 0, "Damping felt at the tip; 0: unknown.")};
  }
  static constexpr auto arm() {
    return std::array{
        F::choice("arm.kind", &T::kind, kKinds, 0, "The mechanism."),
        F::vector3("arm.origin", &T::origin, "m", -10, 10, "[0, 0, 0]",
                   "phantom: the tip of the neutral pose; delta, chain: the base, in the device frame."),
        F::array("arm.base_orientation", &T::base_orientation, "", 4, 0, 4, -1.001, 1.001, "[]",
                 "delta, chain: how the base is turned in the device frame, a unit quaternion w, x, y, z."),
        F::array("arm.lengths", &T::lengths, "m", 1, 0, 8, -10, 10, "[]",
                 "phantom: l1 l2 l3 l5 l6; delta: a b c d e f r s; left out: Premium 1.5, Falcon."),
        F::array("arm.masses", &T::masses, "kg", 1, 0, 16, 0, 100, "[]",
                 "phantom: ma mc mbe mdf; delta: arm, rod, platform; chain: one per link."),
        F::array("arm.angles", &T::angles, "rad", 1, 0, 3, -10, 10, "[]", "delta: where the three arms stand."),
        F::array("arm.dh", &T::dh, "m, rad, m, rad", 4, 0, 64, -10, 10, "[]",
                 "chain: one row a, alpha, d, theta per joint (standard Denavit-Hartenberg)."),
        F::array("arm.centers", &T::centers, "m", 3, 0, 48, -10, 10, "[]",
                 "chain: centre of mass of each link, in the frame after its joint."),
        F::vector3("arm.tool_position", &T::tool_position, "m", -10, 10, "[0, 0, 0]",
                   "chain: the tip in the frame of the last link."),
        F::integer("arm.others", &T::others, "", 0, 8, 0,
                   "chain: joints after those of arm.dh that do not carry the tip, such as a thumb's."),
        F::array("arm.limits", &T::limits, "rad", 2, 0, 32, -100, 100, "[]",
                 "One row per joint: least, greatest position; left out: the mechanism's own."),
        F::array("arm.max_torque", &T::max_torque, "N m", 1, 1, 16, 0, 1000, "", "Largest torque of each joint.",
                 HSP_P_REQUIRED),
        F::real("health.stale", &T::stale, "s", 0.001, 0.018, 0.015, "No good report for so long: motors off."),
        F::real("health.least_rate", &T::least_rate, "", 0, 0.95, 0.57,
                "Fewer reports than this part of wire.rate: motors off; 0: not watched."),
        F::real("health.recovery", &T::recovery, "s", 0.02, 10, 0.2, "So long well before a trouble counts as over."),
        F::real("health.ramp", &T::ramp, "s", 0, 10, 0.25, "From no torque to all of it after that."),
        F::real("health.max_speed", &T::max_speed, "rad/s", 1, 1e4, 100,
                "A joint faster than that: its encoder jumped.")};
  }
};

/// Reads "1234:0006" as two numbers. Throws std::invalid_argument.
inline Address addressOf(const Parameters& p) {
  Address address;
  unsigned vendor = 0, product = 0;
  int used = 0;
  if (std::sscanf(p.id.c_str(), "%4x:%4x%n", &vendor, &product, &used) != 2 || static_cast<size_t>(used) != p.id.size())
    throw std::invalid_argument("usb.id: \"" + p.id + "\", expected vendor:product such as \"1234:0006\"");
  address.vendor = static_cast<uint16_t>(vendor);
  address.product = static_cast<uint16_t>(product);
  address.interface = p.interface;
  address.serial = p.serial;
  return address;
}

}  // namespace hapticd::wire_arm
