// SPDX-License-Identifier: MIT
/// A controller board and the host's end of its mailbox over a plain file, in virtual time. The board writes 1500
/// blocks a second, the host looks twice as often.
#pragma once
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <functional>

#include "emulators/vme/vme_board.hpp"
#include "emulators/wire_file.hpp"
#include "vme/mailbox.hpp"
#include "wire_arm/mechanism.hpp"
#include "wire_arm/session.hpp"

namespace hapticd::vme {

inline const std::string kSarcos = HAPTICD_SOURCE_DIR "/config/devices/sarcos.yaml";
inline const std::string kSimulated = HAPTICD_SOURCE_DIR "/config/devices/simulated-sarcos.yaml";

inline host::Catalog builtModules() {
  host::SearchPath path;
  path.devices = {HAPTICD_BINARY_DIR "/lib/hapticd/devices"};
  return host::Catalog(path);
}

/// The mechanism that a device file with a chain describes. The shipped Sarcos file carries no weight, since no mass of
/// it was published; here it weighs what the simulated arm behind the board does.
inline std::unique_ptr<kinematics::Arm> mechanismOf(const std::string& file) {
  const YAML::Node arm = YAML::LoadFile(file)["parameters"]["arm"];
  const auto flat = [&](const char* key) {
    std::vector<double> out;
    for (const auto& row : arm[key])
      if (row.IsScalar())
        out.push_back(row.as<double>());
      else
        for (const auto& value : row) out.push_back(value.as<double>());
    return out;
  };
  wire_arm::MechanismParameters p;
  p.kind = static_cast<int>(wire_arm::Kind::kChain);
  p.dh = flat("dh"), p.limits = flat("limits"), p.masses = flat("masses"), p.centers = flat("centers");
  p.base_orientation = flat("base_orientation");
  if (file == kSarcos) p.masses = YAML::LoadFile(kSimulated)["parameters"]["arm"]["masses"].as<std::vector<double>>();
  p.others = arm["others"].as<int>(0);
  for (size_t i = 0; i < 3; ++i) {
    p.origin[i] = arm[arm["origin"] ? "origin" : "base_position"][i].as<double>();
    p.tool_position[i] = arm["tool_position"][i].as<double>();
  }
  return wire_arm::makeMechanism(p);
}

/// A file of one window's size, removed at the end.
class WindowFile {
 public:
  explicit WindowFile(const std::string& name)
      : path_(::testing::TempDir() + "hapticd-vme-" + name + "-" + std::to_string(getpid())) {
    fd_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    resize(0x10000);
  }
  ~WindowFile() {
    ::close(fd_);
    std::filesystem::remove(path_);
  }
  WindowFile(const WindowFile&) = delete;
  WindowFile& operator=(const WindowFile&) = delete;
  void resize(off_t bytes) { EXPECT_EQ(ftruncate(fd_, bytes), 0); }
  template <class Bytes>
  void write(off_t at, const Bytes& bytes) {
    EXPECT_EQ(pwrite(fd_, bytes.data(), bytes.size(), at), static_cast<ssize_t>(bytes.size()));
  }
  emulator::VmeBlock read(off_t at) const {
    emulator::VmeBlock block{};
    (void)!pread(fd_, block.data(), block.size(), at);
    return block;
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  int fd_ = -1;
};

class Rig {
 public:
  static constexpr Nanoseconds kStep = 333'333;  ///< half a period of the board
  using Torque = std::function<void(const wire_arm::Sample&, wire_arm::ArmCommand&)>;

  explicit Rig(const std::string& name)
      : file(name),
        catalog_(builtModules()),
        board(kSimulated, catalog_),
        mailbox_(place()),
        session(wire, settings()) {
    beat();
    attach();
  }

  MailboxPlace place() const {
    MailboxPlace p;
    p.window.node = file.path();
    p.window.address = 0x100000;
    return p;
  }
  static wire_arm::SessionSettings settings() {
    wire_arm::SessionSettings s;
    s.joints = 10;
    s.calibration = wire_arm::Calibration::kDevice;
    s.health.max_speed = 60;
    return s;
  }

  /// Some time of board and host; the host wants what `want` says, or a small torque in the last arm joint.
  void run(double seconds) {
    const Nanoseconds until = now + static_cast<Nanoseconds>(seconds * 1e9);
    while (now < until) {
      now += kStep;
      if (++steps_ % 2 == 0 && powered) beat();
      host();
    }
  }
  /// Time from `since` to the last block that had the valves open [s].
  double openFor(Nanoseconds since) const { return open_at > since ? static_cast<double>(open_at - since) * 1e-9 : 0; }
  bool open() const { return now - open_at < 4 * kStep; }

  WindowFile file;

 private:
  host::Catalog catalog_;

 public:
  emulator::VmeBoard board;
  codec::Wire wire = codec::readWire(emulator::wireOf(kSarcos), 10);

 private:
  Mailbox mailbox_;

 public:
  wire_arm::Session session;
  Torque want = [](const wire_arm::Sample&, wire_arm::ArmCommand& wanted) { wanted.torque[6] = 0.5; };
  bool powered = true, attached = false;
  Nanoseconds now = 1'000'000'000, open_at = 0;
  double torque = 0;  ///< [N m] of joint 7 in the newest command block
  std::string refusal;

 private:
  void beat() {
    emulator::VmeBlock state{};
    if (!board.cycle(file.read(0x100), state, 2e-9 * static_cast<double>(kStep))) return;
    file.write(0, state);
  }
  void attach() {
    auto opened = mailbox_.open({}, wire);
    attached = static_cast<bool>(opened);
    refusal = attached ? "" : opened.error();
    if (attached) session.attach(now, {}, false);
  }
  void host() {
    if (!attached && (now / kStep) % 300 == 0) attach();  // ten times a second
    size_t size = 0;
    std::array<uint8_t, codec::kMaxReportBytes> bytes{};
    const wire_arm::Status status = attached ? mailbox_.receive(bytes, size, 0) : wire_arm::Status::kNothing;
    if (status == wire_arm::Status::kOk) session.receive(now, {bytes.data(), size});
    if (status != wire_arm::Status::kOk && status != wire_arm::Status::kNothing) {
      session.lose(now,
                   status == wire_arm::Status::kAbsent ? wire_arm::Trouble::kAbsent : wire_arm::Trouble::kBusError);
      attached = false;
    }
    session.watch(now);
    command_.time = now, ++command_.sequence, command_.on = true;
    want(session.sample(), command_);
    const size_t out = session.command(now, command_, bytes);
    if (attached) (void)mailbox_.send({bytes.data(), out});
    if ((bytes[9] & 1) != 0) open_at = now;
    torque = (bytes[9] & 1) != 0 ? 0.005 * static_cast<int16_t>(bytes[24] << 8 | bytes[25]) : 0;
  }

  wire_arm::ArmCommand command_;
  int steps_ = 0;
};

}  // namespace hapticd::vme
