#include "emulators/emulated_arm.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "emulators/board.hpp"
#include "mechanisms.hpp"

namespace hapticd::emulator {
namespace {

using Eigen::Vector3d;
using simulated::Drive;
using simulated::Hand;
using simulated::HandTarget;
using simulated::JointSettings;
using simulated::Plant;
using simulated::PlantOf;
using simulated::Pull;

constexpr double kWatchdog = 0.02;  ///< [s] without a command: motors off
constexpr double kStep = 2e-4;      ///< [s] of the integration

/// Counts and milliamperes against radians and newton metres, as the two makers wire it.
struct Drives {
  Vector3d counts;  ///< a radian
  Vector3d torque;  ///< N m a milliampere
  double most;      ///< mA
};

Drives boardDrives() {
  const Vector3d gear(13.3, 11.2, 11.2);
  return {4096 * gear / (2 * M_PI), 0.0234e-3 * gear, 5500};
}

Drives woodenDrives() {  // joints 1 and 3 turn against their motors
  const Vector3d ratio(-16, 12, -12);
  return {2000 * ratio / (2 * M_PI), 0.0259e-3 * ratio, 2000};
}

kinematics::PhantomGeometry woodenGeometry() {
  kinematics::PhantomGeometry g;
  g.l1 = 0.205, g.l2 = 0.245, g.l3 = g.l5 = g.l6 = 0;
  return g;
}

}  // namespace

struct EmulatedArm::Inside {
  bool board = true;
  About about;
  Drives drives;
  simulated::Parameters parameters;
  std::unique_ptr<kinematics::Phantom> arm;
  std::unique_ptr<Plant> plant;
  std::unique_ptr<Hand> hand;
  Drive drive;
  BoardState state;
  Vector3d zero = Vector3d::Zero();  ///< rad where the counters stood at power-on
  Fault fault = Fault::kNone;
  double time = 0, heard = -1;
  uint64_t commands = 0, reports = 0;

  void build() {
    JointSettings joints = simulated::jointsOf(parameters, 3);
    kinematics::PhantomInertia inertia;
    inertia.rotor = joints.rotor;
    const Vector3d gravity(0, -9.81, 0);
    plant = std::make_unique<PlantOf<simulated::PhantomMechanism>>(
        joints, simulated::PhantomMechanism(*arm, inertia, parameters.mass, gravity));
    hand = std::make_unique<Hand>(simulated::handOf(parameters), simulated::HandPath());
    kinematics::JointVector q = arm->neutral();
    if (!arm->inverse(hand->at(0).position, q))
      throw std::invalid_argument("the emulated hand starts out of the arm's reach");
    plant->reset(q);
    drive.torque = drive.reference = drive.reference_rate = kinematics::JointVector::Zero(3);
    if (!board) zero = q;  // incremental encoders
  }

  std::array<int32_t, 3> counts() const {
    std::array<int32_t, 3> out{};
    const kinematics::JointVector q = plant->position();
    for (int i = 0; i < 3; ++i)
      out[static_cast<size_t>(i)] = static_cast<int32_t>(std::lround((q[i] - zero[i]) * drives.counts[i]));
    return out;
  }

  void setCurrents(const std::array<int16_t, 3>& current) {
    for (int i = 0; i < 3; ++i)
      drive.torque[i] =
          drives.torque[i] * std::clamp<double>(current[static_cast<size_t>(i)], -drives.most, drives.most);
  }

  std::vector<uint8_t> wooden(const std::array<int32_t, 3>& c) const {
    std::vector<uint8_t> out(14, 0);
    for (size_t i = 0; i < 3; ++i) {
      out[2 * i] = static_cast<uint8_t>(c[i]);
      out[2 * i + 1] = static_cast<uint8_t>(static_cast<uint32_t>(c[i]) >> 8);
    }
    return out;
  }
};

simulated::Parameters defaultHand(const std::string& kind) {
  simulated::Parameters p;
  p.script = static_cast<int>(simulated::Script::kPress);
  p.friction_speed = 0.1, p.motor_lag = 1.09e-4;
  p.mass = 0.2, p.hand_stiffness = 500, p.hand_damping = 5;
  p.radius = 0, p.rise = 0.03, p.hand_rate = 1, p.approach = 0, p.lead_in = 0.001;
  p.normal = {0, 0, 1}, p.axis = {0, 1, 0};
  if (kind != "woodenhaptics") return p;
  kinematics::JointVector q(3);
  q << 0, 1.4, 1.5;
  const Eigen::Vector3d tip = kinematics::Phantom(woodenGeometry()).position(q);
  p.center = {tip.x(), tip.y(), tip.z()};
  return p;
}

EmulatedArm::EmulatedArm(const std::string& kind, const simulated::Parameters& hand) : inside_(new Inside) {
  Inside& in = *inside_;
  in.parameters = hand;
  if (kind == "premium15") {
    in.about = {0x1209, 0x0005, "hapticd interface board", 32, 16, true};
    in.drives = boardDrives();
    in.arm = std::make_unique<kinematics::Phantom>();
  } else if (kind == "woodenhaptics") {
    in.board = false;
    in.about = {0x1234, 0x0006, "WoodenHaptics", 14, 14, false};
    in.drives = woodenDrives();
    in.arm = std::make_unique<kinematics::Phantom>(woodenGeometry());
  } else {
    throw std::invalid_argument("no emulated arm \"" + kind + "\", expected premium15 or woodenhaptics");
  }
  in.build();
}

EmulatedArm::~EmulatedArm() = default;

const About& EmulatedArm::about() const {
  return inside_->about;
}

void EmulatedArm::advance(double seconds) {
  Inside& in = *inside_;
  const int steps = std::max(1, static_cast<int>(std::ceil(seconds / kStep)));
  for (int i = 0; i < steps; ++i) {
    in.time += seconds / steps;
    if (silence() > kWatchdog) in.drive.torque.setZero();
    const HandTarget target = in.hand->at(in.time);
    Pull pull;
    pull.target = target.position, pull.velocity = target.velocity, pull.force = target.force;
    pull.stiffness = in.parameters.hand_stiffness, pull.damping = in.parameters.hand_damping;
    in.plant->step(seconds / steps, in.drive, pull);
  }
}

std::vector<uint8_t> EmulatedArm::report() {
  Inside& in = *inside_;
  ++in.reports;
  if (in.fault == Fault::kSilent || (in.fault == Fault::kHalfRate && in.reports % 2 == 0)) return {};
  std::array<int32_t, 3> counts = in.counts();
  if (in.fault == Fault::kJump) counts[1] += 20000;
  in.state.counts = counts;
  ++in.state.sequence;
  in.state.version = in.fault == Fault::kFirmware ? 2 : 1;
  in.state.state = in.fault == Fault::kHardware ? 1 | 4 : 1;
  std::vector<uint8_t> bytes = in.board ? in.state.bytes() : in.wooden(counts);
  if (in.fault == Fault::kShort) bytes.resize(bytes.size() / 2);
  if (in.fault == Fault::kCorrupt) bytes[8] ^= 0x10;
  return bytes;
}

void EmulatedArm::command(std::span<const uint8_t> bytes) {
  Inside& in = *inside_;
  std::array<int16_t, 3> current{};
  if (in.board) {
    const BoardCommand command(bytes);
    if (!command.valid) return;
    if (command.enabled) current = command.current;
  } else {
    if (bytes.size() != 14) return;
    for (size_t i = 0; i < 3; ++i) current[i] = static_cast<int16_t>(bytes[2 * i] | bytes[2 * i + 1] << 8);
  }
  in.setCurrents(current);
  in.heard = in.time;
  ++in.commands;
}

void EmulatedArm::spoil(Fault fault) {
  inside_->fault = fault;
}
Eigen::Vector3d EmulatedArm::tip() const {
  return inside_->plant->tip();
}
bool EmulatedArm::pushed() const {
  return inside_->drive.torque.norm() > 0;
}
double EmulatedArm::silence() const {
  return inside_->heard < 0 ? HUGE_VAL : inside_->time - inside_->heard;
}
uint64_t EmulatedArm::commands() const {
  return inside_->commands;
}

}  // namespace hapticd::emulator
