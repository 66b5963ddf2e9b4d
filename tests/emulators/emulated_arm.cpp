// SPDX-License-Identifier: MIT
#include "emulators/emulated_arm.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "emulators/delta_mechanism.hpp"
#include "simulated/mechanisms.hpp"

namespace hapticd::emulator {
namespace {

using Eigen::Vector3d;
using simulated::Drive;
using simulated::Hand;
using simulated::HandCoupling;
using simulated::HandTarget;
using simulated::JointSettings;
using simulated::Plant;
using simulated::PlantOf;

constexpr double kWatchdog = 0.02;  ///< [s] without a command: motors off
constexpr double kStep = 5e-4;      ///< [s] of the integration

/// Counts and milliamperes against radians and newton metres, as the makers wire it.
struct Drives {
  Vector3d counts;   ///< a radian
  Vector3d torque;   ///< N m a milliampere
  double most;       ///< mA
  double offset;     ///< [rad] where an absolute encoder counts 0
  bool incremental;  ///< counts begin where it was switched on
};

Drives boardDrives() {
  const Vector3d gear(13.3, 11.2, 11.2);
  return {4096 * gear / (2 * M_PI), 0.0234e-3 * gear, 5500, 0, false};
}

Drives woodenDrives() {  // joints 1 and 3 turn against their motors
  const Vector3d ratio(-16, 12, -12);
  return {2000 * ratio / (2 * M_PI), 0.0259e-3 * ratio, 2000, 0, true};
}

/// libnifalcon: 320 lines of four edges a motor turn, capstan of 14.25 mm diameter on a wheel of 110 mm diameter.
Drives falconDrives() {
  const double counts_per_degree = 4 * 320 * (0.110 * M_PI / 360) / (0.01425 * M_PI);
  return {Vector3d::Constant(counts_per_degree * 180 / M_PI), Vector3d::Constant(-1e-4), 4096, 35 * M_PI / 180, false};
}

kinematics::PhantomGeometry woodenGeometry() {
  kinematics::PhantomGeometry g;
  g.l1 = 0.205, g.l2 = 0.245, g.l3 = g.l5 = g.l6 = 0;
  return g;
}

enum class Body { kPremium, kWooden, kDelta };

struct Kind {
  const char* name;
  About about;
  Body body;
};

const Kind kKinds[] = {
    {"premium15", {0x1209, 0x0005, "hapticd interface board", 32, 16, true, Bus::kHid}, Body::kPremium},
    {"premium15-bulk", {0x1209, 0x0006, "hapticd interface board", 32, 16, true, Bus::kBulk}, Body::kPremium},
    {"woodenhaptics", {0x1234, 0x0006, "WoodenHaptics", 14, 14, false, Bus::kHid}, Body::kWooden},
    {"polhem", {0x16c0, 0x0486, "Polhem", 64, 64, false, Bus::kHid}, Body::kWooden},
    {"falcon", {0x0403, 0xcb48, "FALCON HAPTIC", 16, 16, false, Bus::kFtdi}, Body::kDelta},
};

const Kind& kindOf(const std::string& name) {
  for (const Kind& kind : kKinds)
    if (name == kind.name) return kind;
  std::string all;
  for (const Kind& kind : kKinds) all += std::string(" ") + kind.name;
  throw std::invalid_argument("no emulated arm \"" + name + "\", expected one of" + all);
}

}  // namespace

struct EmulatedArm::Inside {
  About about;
  Drives drives;
  simulated::Parameters parameters;
  std::unique_ptr<Firmware> firmware;
  std::unique_ptr<Plant> plant;
  std::unique_ptr<Hand> hand;
  Drive drive;
  Vector3d zero = Vector3d::Zero();  ///< rad where the counters stood at power-on
  Fault fault = Fault::kNone;
  StepMeter meter{0, 0};
  std::vector<uint8_t> last_report;
  double time = 0, hand_time = 0, heard = -1;
  bool still = false;
  uint64_t commands = 0, reports = 0;

  void buildPhantom(const kinematics::PhantomGeometry& geometry, const Vector3d& gravity) {
    const kinematics::Phantom arm(geometry);
    const JointSettings joints = simulated::jointsOf(parameters, 3);
    kinematics::PhantomInertia inertia;
    inertia.rotor = joints.rotor;
    plant = std::make_unique<PlantOf<simulated::PhantomMechanism>>(
        joints, simulated::PhantomMechanism(arm, inertia, parameters.mass, gravity));
    begin(arm);
  }

  void buildDelta() {
    const kinematics::DeltaGeometry geometry;
    const kinematics::Delta arm(geometry);
    plant = std::make_unique<PlantOf<DeltaMechanism>>(simulated::jointsOf(parameters, 3),
                                                      DeltaMechanism(arm, geometry, parameters.mass));
    begin(arm);
  }

  void begin(const kinematics::Arm& arm) {
    hand = std::make_unique<Hand>(simulated::handOf(parameters), simulated::HandPath());
    kinematics::JointVector q = arm.neutral();
    if (!arm.inverse(hand->at(0).position, q))
      throw std::invalid_argument("the emulated hand starts out of the arm's reach");
    plant->reset(q);
    drive.torque = drive.reference = drive.reference_rate = kinematics::JointVector::Zero(3);
    zero = drives.incremental ? Vector3d(q) : Vector3d::Constant(drives.offset);
  }

  Counts counts() {
    Counts out{};
    const double step = meter.report(monotonicNow());
    const kinematics::JointVector q = plant->position() + kinematics::JointVector::Constant(3, step);
    for (int i = 0; i < 3; ++i)
      out[static_cast<size_t>(i)] = static_cast<int32_t>(std::lround((q[i] - zero[i]) * drives.counts[i]));
    return out;
  }

  void setCurrents(const Currents& current) {
    for (int i = 0; i < 3; ++i)
      drive.torque[i] =
          drives.torque[i] * std::clamp<double>(current[static_cast<size_t>(i)], -drives.most, drives.most);
  }
};

const std::vector<std::string>& emulatedKinds() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Kind& kind : kKinds) all.emplace_back(kind.name);
    return all;
  }();
  return names;
}

simulated::Parameters defaultHand(const std::string& kind) {
  simulated::Parameters p;
  p.script = static_cast<int>(simulated::Script::kPress);
  p.friction_speed = 0.1, p.motor_lag = 1.09e-4;
  p.mass = 0.2, p.hand_stiffness = 500, p.hand_damping = 5;
  p.radius = 0, p.rise = 0.03, p.hand_rate = 1, p.approach = 0, p.lead_in = 0.001;
  p.normal = {0, 0, 1}, p.axis = {0, 1, 0};
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  const Body body = kindOf(kind).body;
  if (body == Body::kWooden) {  // upper body upright, forearm level: where it is calibrated
    tip = kinematics::Phantom(woodenGeometry()).position({0, M_PI / 2, M_PI / 2});
  } else if (body == Body::kDelta) {
    const kinematics::Delta arm;
    kinematics::Pose pose;
    if (arm.forward(arm.neutral(), pose)) tip = pose.position + Eigen::Vector3d(0, 0, 0.015);
    p.gear = {1}, p.max_torque = {0.41}, p.rotor = {2e-5}, p.damping = {5e-4}, p.friction = {2e-3}, p.counts = {0};
  }
  p.center = {tip.x(), tip.y(), tip.z()};
  return p;
}

EmulatedArm::EmulatedArm(const std::string& name, const simulated::Parameters& hand) : inside_(new Inside) {
  Inside& in = *inside_;
  const Kind& kind = kindOf(name);
  in.parameters = hand;
  in.about = kind.about;
  switch (kind.body) {
    case Body::kPremium:
      in.drives = boardDrives();
      in.firmware = boardFirmware();
      in.buildPhantom({}, {0, -9.81, 0});
      break;
    case Body::kWooden:
      in.drives = woodenDrives();
      in.firmware = woodenFirmware(in.about.input_bytes);
      in.buildPhantom(woodenGeometry(), {0, 0, 0});  // its counterweights carry it
      break;
    case Body::kDelta:
      in.drives = falconDrives();
      in.firmware = falconFirmware();
      in.buildDelta();
      break;
  }
}

EmulatedArm::~EmulatedArm() = default;

const About& EmulatedArm::about() const {
  return inside_->about;
}

void EmulatedArm::advance(double seconds) {
  Inside& in = *inside_;
  const int steps = std::max(1, static_cast<int>(std::ceil(seconds / kStep)));
  const double h = seconds / steps;
  for (int i = 0; i < steps; ++i) {
    in.time += h;
    if (!in.still) in.hand_time += h;
    if (silence() > kWatchdog) in.drive.torque.setZero();
    const HandTarget target = in.hand->at(in.hand_time);
    HandCoupling pull;
    pull.target = target.position, pull.velocity = in.still ? Vector3d(0, 0, 0) : target.velocity;
    pull.force = target.force;
    pull.stiffness = in.parameters.hand_stiffness, pull.damping = in.parameters.hand_damping;
    in.plant->step(h, in.drive, pull);
  }
}

std::vector<uint8_t> EmulatedArm::report() {
  Inside& in = *inside_;
  ++in.reports;
  if (in.fault == Fault::kSilent || (in.fault == Fault::kHalfRate && in.reports % 2 == 0)) return {};
  Counts counts = in.counts();
  if (in.fault == Fault::kJump) counts[1] += 20000;
  std::vector<uint8_t> bytes = in.firmware->report(counts, in.fault);
  if (in.fault == Fault::kStale) return in.last_report;
  in.last_report = bytes;
  if (in.fault == Fault::kShort) bytes.resize(bytes.size() / 2);
  if (in.fault == Fault::kCorrupt) bytes[8] ^= 0x10;
  return bytes;
}

void EmulatedArm::command(std::span<const uint8_t> bytes) {
  Inside& in = *inside_;
  const std::optional<Currents> current = in.firmware->command(bytes);
  if (!current) return;
  in.meter.command(monotonicNow(), *current);
  in.setCurrents(*current);
  in.heard = in.time;
  ++in.commands;
}

void EmulatedArm::spoil(Fault fault) {
  inside_->fault = fault;
}
void EmulatedArm::measureLatency() {
  const bool delta = inside_->about.bus == Bus::kFtdi;  // short levers, and units of another size
  inside_->meter = delta ? StepMeter(0.01, 60) : StepMeter(0.004, 60);
}
const StepMeter& EmulatedArm::meter() const {
  return inside_->meter;
}
void EmulatedArm::holdStill(bool still) {
  inside_->still = still;
}
Eigen::Vector3d EmulatedArm::tip() const {
  return inside_->plant->tip();
}
Eigen::Vector3d EmulatedArm::start() const {
  return inside_->hand->at(0).position;
}
bool EmulatedArm::pushed() const {
  return inside_->drive.torque.norm() > 0;
}
double EmulatedArm::silence() const {
  return inside_->heard < 0 ? HUGE_VAL : inside_->time - inside_->heard;
}
int EmulatedArm::searches() const {
  return inside_->firmware->searches();
}
int EmulatedArm::zeros() const {
  return inside_->firmware->zeros();
}
uint64_t EmulatedArm::commands() const {
  return inside_->commands;
}

}  // namespace hapticd::emulator
