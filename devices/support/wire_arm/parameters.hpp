// SPDX-License-Identifier: MIT
/// The parameters in the device file of an arm that exchanges reports over a bus.
#pragma once
#include <array>
#include <cstdint>
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

/// The values of the parameters. The device class of each such arm derives from this class. Only USB has id, serial,
/// port, interface, firmware and loader.
struct Parameters : MechanismParameters {
  std::string id, serial, port, wire, instructions, firmware;
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
        F::text("usb.id", &T::id, "", "Vendor id and product id in hexadecimal, such as \"1234:0006\".",
                HSP_P_REQUIRED),
        F::text("usb.serial", &T::serial, "",
                "Serial number of the device. Without it, the first such device that is free is used."),
        F::text("usb.port", &T::port, "",
                "Port at which the device is plugged in, such as 1-2.3, as hapticd device list prints it. "
                "It distinguishes two devices without serial numbers."),
        F::integer("usb.interface", &T::interface, "", -1, 255, -1,
                   "Number of the USB interface; -1 means any interface for HID, and interface 0 for bulk."),
        F::choice(
            "loader", &T::loader, kLoaders, 0,
            "How the firmware is loaded into the device. none: it is not loaded. falcon: with Novint's protocol."),
        F::path("firmware", &T::firmware, "File with the firmware for the loader. hapticd does not include it.")};
  }
  static constexpr auto device() {
    return std::array{
        withSchema(F::data("wire", &T::wire, nullptr,
                           "The arm's reports, framing, start-up sequence and timing: see devices.md.", HSP_P_REQUIRED),
                   codec::kWireSchema),
        F::choice("calibration.method", &T::method, kMethods, 0,
                  "none: the encoders are absolute. device: the device finds its zero by itself and reports it. pose: "
                  "the user holds the arm in a known pose."),
        F::array("calibration.pose", &T::pose, "rad", 1, 0, 16, -100, 100, "[]",
                 "Joint positions in the known pose, for calibration.method: pose."),
        F::text("calibration.instructions", &T::instructions, "Hold the arm as its manual says.",
                "What the user must do with the arm before it is calibrated."),
        F::boolean("device.verified", &T::verified, false, "True if this device file was tried on hardware."),
        F::real("device.max_force", &T::max_force, "N", 0, 1000, 0, "Largest force at the tip; 0 means unknown."),
        F::real("device.continuous_force", &T::continuous_force, "N", 0, 1000, 0,
                "Largest force that the arm can exert for any length of time; 0 means unknown."),
        F::real("device.max_stiffness", &T::max_stiffness, "N/m", 0, 1e6, 0,
                "Largest stiffness that was found stable; 0 means unknown."),
        F::real("device.mass", &T::mass, "kg", 0, 100, 0, "Mass felt at the tip; 0 means unknown."),
        F::real("device.damping", &T::damping, "N s/m", 0, 1000, 0, "Damping felt at the tip; 0 means unknown.")};
  }
  static constexpr auto arm() {
    return std::array{
        F::choice("arm.kind", &T::kind, kKinds, 0, "The mechanism."),
        F::vector3("arm.origin", &T::origin, "m", -10, 10, "[0, 0, 0]",
                   "Position in the device frame: for phantom, of the tip in the neutral pose; "
                   "for delta and chain, of the base."),
        F::array("arm.base_orientation", &T::base_orientation, "", 4, 0, 4, -1.001, 1.001, "[]",
                 "delta, chain: orientation of the base in the device frame, a unit quaternion w, x, y, z."),
        F::array("arm.lengths", &T::lengths, "m", 1, 0, 8, -10, 10, "[]",
                 "phantom: l1 l2 l3 l5 l6 (default: Premium 1.5). delta: a b c d e f r s (default: Falcon)."),
        F::array("arm.masses", &T::masses, "kg", 1, 0, 16, 0, 100, "[]",
                 "phantom: ma mc mbe mdf. delta: arm, rod pair, platform. chain: one mass for each link."),
        F::array("arm.angles", &T::angles, "rad", 1, 0, 3, -10, 10, "[]",
                 "delta: angles about its axis at which the three arms are mounted."),
        F::array("arm.dh", &T::dh, "m, rad, m, rad", 4, 0, 64, -10, 10, "[]",
                 "chain: one row a, alpha, d, theta for each joint (standard Denavit-Hartenberg)."),
        F::array("arm.centers", &T::centers, "m", 3, 0, 48, -10, 10, "[]",
                 "chain: centre of mass of each link, in the frame after its joint."),
        F::vector3("arm.tool_position", &T::tool_position, "m", -10, 10, "[0, 0, 0]",
                   "chain: position of the tip in the frame of the last link."),
        F::integer(
            "arm.others", &T::others, "", 0, 8, 0,
            "chain: number of joints after those of arm.dh that do not carry the tip, such as those of a thumb."),
        F::array("arm.limits", &T::limits, "rad", 2, 0, 32, -100, 100, "[]",
                 "One row [least, greatest position] for each joint. Default: the limits of the mechanism."),
        F::array("arm.max_torque", &T::max_torque, "N m", 1, 1, 16, 0, 1000, "", "Largest torque of each joint.",
                 HSP_P_REQUIRED),
        F::real("health.stale", &T::stale, "s", 0.001, 0.018, 0.015,
                "The motors are switched off if no good report comes for this time."),
        F::real("health.least_rate", &T::least_rate, "", 0, 0.95, 0.57,
                "The motors are switched off if reports come more slowly than this fraction of wire.rate; "
                "0 means no check."),
        F::real("health.recovery", &T::recovery, "s", 0.02, 10, 0.2,
                "Time without an error after which a trouble is over."),
        F::real("health.ramp", &T::ramp, "s", 0, 10, 0.25,
                "Time in which the torque rises from zero to its full value after a trouble is over."),
        F::real("health.max_speed", &T::max_speed, "rad/s", 1, 1e4, 100,
                "Largest speed of a joint; a faster change counts as a jump of its encoder.")};
  }
};

/// Returns the address that the usb keys give; usb.id, such as "1234:0006", gives two numbers. Throws
/// std::invalid_argument.
inline Address addressOf(const Parameters& p) {
  Address address;
  unsigned vendor = 0, product = 0;
  if (!isUsbId(p.id) || std::sscanf(p.id.c_str(), "%4x:%4x", &vendor, &product) != 2)
    throw std::invalid_argument("usb.id: \"" + p.id +
                                "\", expected vendor:product such as \"1234:0006\", of four digits each");
  address.vendor = static_cast<uint16_t>(vendor);
  address.product = static_cast<uint16_t>(product);
  address.interface = p.interface;
  address.serial = p.serial;
  address.port = p.port;
  if (!p.port.empty() && !isUsbPort(p.port))
    throw std::invalid_argument("usb.port: \"" + p.port +
                                "\", expected bus and ports such as \"1-2.3\": hapticd device list prints them");
  return address;
}

}  // namespace hapticd::wire_arm
