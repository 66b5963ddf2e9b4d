// SPDX-License-Identifier: MIT
/// The device module `vme`: an arm behind a controller board on a VME bus, such as the Sarcos Dextrous Arm Master,
/// through Linux' vme_user. The board runs the torque loop. The device file describes the content of the mailbox.
#include "vme/mailbox.hpp"
#include "vme/vme_user.hpp"
#include "wire_arm/arm.hpp"

namespace hapticd::vme {
namespace {

constexpr const char* kSpaces[] = {"a16", "a24", "a32"};
constexpr const char* kWidths[] = {"d16", "d32"};
constexpr const char* kCycles[] = {"user_data", "super_data", "user_program", "super_program"};

class VmeArm final : public wire_arm::Arm<VmeArm> {
 public:
  static constexpr DeviceInfo kInfo = {
      "org.hapticd.device.vme", "vme", "0.1.0", "MIT",
      "An arm behind a controller board on a VME bus, which its device file describes."};
  static constexpr auto bus() {
    using F = Fields<VmeArm>;
    return std::array{
        F::path("vme.window", &VmeArm::node,
                "Device node of the vme_user master window, /dev/bus/vme/m0 to m3, or a plain file for tests.",
                HSP_P_REQUIRED),
        F::text("vme.address", &VmeArm::base, "",
                "First address of the window on the bus, a multiple of 64 KiB, such as \"0x100000\".", HSP_P_REQUIRED),
        F::text("vme.size", &VmeArm::extent, "0x10000", "Size of the window in bytes, a multiple of 64 KiB."),
        F::choice("vme.space", &VmeArm::space, kSpaces, 1, "Address space of the board on the bus."),
        F::choice("vme.width", &VmeArm::width, kWidths, 0, "Number of bits of one transfer."),
        F::choice("vme.cycle", &VmeArm::cycle, kCycles, 0, "Kind of single bus cycles that the board answers."),
        F::text("vme.state", &VmeArm::state, "0x0", "Offset, within the window, of the block that the board writes."),
        F::text("vme.command", &VmeArm::command, "0x100",
                "Offset, within the window, of the block that the host writes."),
        F::real("vme.poll", &VmeArm::poll, "s", 1e-5, 0.005, 1e-4, "Time between two reads of the board's block.",
                HSP_P_ACCURACY)};
  }
  static constexpr auto fields() {
    return join(bus(), wire_arm::ParameterTable<VmeArm>::device(), wire_arm::ParameterTable<VmeArm>::arm());
  }

  /// Checks the numbers of the window. Returns an empty address, because the window identifies the device; the USB keys
  /// are not used. Throws std::invalid_argument if a number is wrong.
  wire_arm::Address address() const {
    if (auto fits = check(place(), format()); !fits) throw std::invalid_argument(fits.error());
    return {};
  }
  std::unique_ptr<wire_arm::Transport> makeTransport() const { return std::make_unique<Mailbox>(place()); }

  std::string node, base, extent, state, command;
  int space = 1, width = 0, cycle = 0;
  double poll = 1e-4;

 private:
  static uint64_t number(const char* id, const std::string& text) {
    char* end = nullptr;
    const unsigned long long value = std::strtoull(text.c_str(), &end, 0);
    if (end == text.c_str() || *end != '\0' || text[0] == '-')
      throw std::invalid_argument(std::string(id) + ": \"" + text + "\", expected a number such as 0x100000");
    return value;
  }
  MailboxPlace place() const {
    constexpr uint32_t kCycleBits[] = {kUser | kData, kSuper | kData, kUser | kProgram, kSuper | kProgram};
    MailboxPlace p;
    p.window.node = node;
    p.window.address = number("vme.address", base), p.window.size = number("vme.size", extent);
    p.window.space = uint32_t{1} << space;
    p.window.width = width == 0 ? kD16 : kD32;
    p.window.cycle = kSingle | kCycleBits[cycle];
    p.state = number("vme.state", state), p.command = number("vme.command", command);
    p.poll = static_cast<Nanoseconds>(poll * 1e9);
    return p;
  }
};

}  // namespace
}  // namespace hapticd::vme

HAPTICD_DEVICES(hapticd::vme::VmeArm)
