// SPDX-License-Identifier: MIT
#include "servo/arm/arm.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/code_owner.hpp"
#include "base/shell_word.hpp"
#include "servo/arm/velocity_use.hpp"
#include "servo/safety/held_command.hpp"
#include "servo/velocity/estimator_delay.hpp"

namespace hapticd::servo {

namespace {

constexpr double kFastestTip = 5;  ///< [m/s] speed limit of a real arm if limits.velocity is not given

/// The Jacobian, in the memory layout that the kinematics extension of a device writes.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor, 6, HDV_MAX_JOINTS>;

/// [kg] mass of a light arm, used if the arm's mass is unknown: the passivity controller then adds only little damping
constexpr double kAssumedMass = 0.05;

constexpr hdv_command kMotorsOff = {sizeof(hdv_command), HDV_OFF, {}, {}};

/// True if this arm may use its full force at any rate: a simulated arm hurts nobody, and a replay must repeat the
/// forces that were felt.
bool pushesInFull(const hdv_info& info, const ArmOptions& options) {
  return options.full_when_slow || (info.capabilities & HDV_C_SIMULATED) != 0;
}

/// Returns the limits of the device file, made stricter for this arm: an arm with at most three joints can only push,
/// and a slow real arm pushes less.
scene::Limits limitsOf(const scene::Limits& described, const hdv_info& info, const ArmOptions& options) {
  scene::Limits limits = described;
  if (info.joint_count <= 3) limits.torque_slew = 0;
  if (pushesInFull(info, options)) return limits;
  const double most = mostForceAt(options.rate, info.rate_hz, info.max_force);
  if (most == HUGE_VAL) return limits;
  limits.force = limits.force > 0 ? std::min(limits.force, most) : most;
  limits.torque *= shareHeld(longestHeld(options.rate, info.rate_hz));
  return limits;
}

/// Returns the largest force [N] that the device and its file allow, before a slow rate reduces it; 0 if it is unknown.
double fullForce(const scene::Limits& limits, const hdv_info& info) {
  return Limiter(limits, info.max_force).maxForce();
}

/// Returns an error if the settings for HDAPI programs name something that the device does not have; "" if all exists.
std::string refusalOf(const std::optional<scene::HdArm>& hd, const hdv_info& info) {
  const auto missing = [](const std::string& key, uint32_t wrong, uint32_t count, const char* things) {
    return key + " is " + std::to_string(wrong) + ", but the device has " + std::to_string(count) + " " + things +
           "; expected one of them, counted from 0";
  };
  for (size_t i = 0; hd && i < hd->joints.size(); ++i)
    if (hd->joints[i].joint >= info.joint_count)
      return missing("hd.joints[" + std::to_string(i) + "][0]", hd->joints[i].joint, info.joint_count, "joints");
  for (size_t i = 0; hd && i < hd->buttons.size(); ++i)
    if (hd->buttons[i] >= info.buttons)
      return missing("hd.buttons[" + std::to_string(i) + "]", hd->buttons[i], info.buttons, "buttons");
  return "";
}

/// Returns why the device cannot be used as its file describes it; "" if it can. A replay has the device of a
/// recording, whose buttons may be unknown.
std::string refusalOf(const scene::Device& described, const hdv_info& info, bool replayed) {
  if (described.admittance)
    if (std::string no = Admittance::refusal(info); !no.empty()) return no;
  if (replayed) return "";
  if (std::string no = refusalOf(described.hd, info); !no.empty()) return no;
  const auto& button = described.limits.enable.button;
  if (!button || static_cast<uint32_t>(*button) < info.buttons) return "";
  return "limits.enable.button is " + std::to_string(*button) + ", but the device has " + std::to_string(info.buttons) +
         " buttons; forces could never be enabled; expected a button of the device, counted from 0";
}

}  // namespace

Arm::Arm(std::unique_ptr<host::DeviceInstance> device, const scene::Device& described, Limiter limiter,
         const ArmOptions& options)
    : device_(std::move(device)),
      R_world_device_(described.mount.orientation.toRotationMatrix()),
      q_world_device_(described.mount.orientation),
      origin_world_(described.mount.position),
      hand_(device_->hand(), device_->handle(), R_world_device_, origin_world_),
      clients_(options.clients, limiter.maxForce(), limiter.maxTorque(), 1 / options.rate),
      limiter_(std::move(limiter)),
      heat_(described.limits.motors),
      weight_(described.limits, fullForce(described.limits, device_->info())),
      name_(described.name),
      stuck_words_(
          "a tick did not end, as its module did not return, and the watchdog cut the motors; find the cause "
          "with: hapticd device check " +
          shellWord(described.file.string())),
      former_passivity_(options.former_passivity) {}

Result<std::unique_ptr<Arm>> Arm::open(const scene::Device& described, const scene::Servo& servo,
                                       const ArmOptions& options, const host::Services::Log& log) {
  auto device = host::DeviceInstance::create(described, log);
  if (!device) return Error{device.error()};
  (*device)->playBack(options.playback);
  if (auto opened = (*device)->open(); !opened) return Error{opened.error(), opened.kind()};
  if (const std::string no = refusalOf(described, (*device)->info(), options.playback != nullptr); !no.empty())
    return Error{"device '" + described.name + "': " + no};
  const Limiter limiter(limitsOf(described.limits, (*device)->info(), options), (*device)->info().max_force);
  std::unique_ptr<Arm> arm(new Arm(std::move(*device), described, limiter, options));
  arm->as_found_ = options.found_pressed;
  if (!pushesInFull(arm->info(), options))
    arm->slowness_ = describeSlow(options.rate, arm->info().rate_hz, arm->info().max_force,
                                  fullForce(described.limits, arm->info()));
  if (options.found_pressed) arm->limiter_.enableByFoundPressed();
  arm->watchSamples(described.limits);
  const double mass = arm->info().mass_kg > 0 ? arm->info().mass_kg : kAssumedMass;
  arm->limiter_.expectPeriod(std::max(1 / options.rate, arm->sample_period_));
  arm->limiter_.expectMotion(estimatorDelay(servo.velocity, options.rate), mass);
  if (described.admittance) arm->admittance_.emplace(*described.admittance, *arm->device_);
  const bool unknown = (arm->info().capabilities & HDV_C_UNVERIFIED) != 0 || arm->clients_.possible();
  if (described.limits.passivity.value_or(unknown)) {
    arm->passivity_.emplace(passivity::stableDamping(mass, 1 / options.rate), arm->info().damping,
                            arm->info().resolution_m);
  }
  if (usesVelocity(described, options.clients, options.needs_velocity)) {
    auto estimator = makeEstimator(servo.velocity, options.rate, arm->info().resolution_m);
    if (!estimator) return Error{estimator.error()};
    arm->velocity_.emplace(*estimator);
  }
  return arm;
}

Result<void> Arm::start(Nanoseconds now, const Eigen::Vector3d& gravity_world) {
  gravity_device_ = R_world_device_.transpose() * gravity_world;
  hdv_start how{};
  how.struct_size = sizeof how;
  how.rate_hz = device_->info().rate_hz;
  how.time_ns = now;
  Eigen::Map<Eigen::Vector3d>(how.gravity) = gravity_device_;
  fresh_at_ = now;
  return device_->start(how);
}

void Arm::watchSamples(const scene::Limits& limits) {
  watches_jumps_ = !simulated() || limits.velocity.value_or(0) > 0;
  fastest_ = limits.velocity.value_or(simulated() ? 0 : kFastestTip);
  sample_period_ = info().rate_hz > 0 ? 1 / info().rate_hz : 0;
  sample_speed_ = SampleSpeed(info().rate_hz, info().resolution_m);
}

void Arm::exchangeDry(Nanoseconds now) noexcept HSP_RT {
  if (taken_.exchange(true)) return;
  hdv_sample sample{};
  (void)device_->read(now, sample);  // the first tick finds the same error, if there is one
  (void)device_->write(now, kMotorsOff);
  fresh_at_ = now;
  taken_.store(false);
}

std::optional<Eigen::Vector3d> Arm::handForce() const noexcept HSP_RT {
  if ((sample_.flags & HDV_S_TORQUE) == 0) return std::nullopt;
  const auto joints = static_cast<Eigen::Index>(device_->info().joint_count);
  const hdv_ext_kinematics& kinematics = device_->kinematics();
  Jacobian J(6, joints);
  JointVector weight(joints);
  if (kinematics.jacobian(device_->handle(), sample_.position, J.data()) != HSP_OK) return std::nullopt;
  if (kinematics.gravity(device_->handle(), sample_.position, gravity_device_.data(), weight.data()) != HSP_OK)
    return std::nullopt;
  const JointVector torque = Eigen::Map<const Eigen::VectorXd>(sample_.torque, joints) - weight;
  const Eigen::Vector3d force_device = -TipInverse(J.topRows<3>()).force(torque);
  if (!force_device.allFinite()) return std::nullopt;
  return R_world_device_ * force_device;
}

bool Arm::jacobian(double (&rows)[6][HDV_MAX_JOINTS]) const noexcept HSP_RT {
  const auto joints = static_cast<Eigen::Index>(device_->info().joint_count);
  Jacobian J(6, joints);
  if (!probe_.valid || device_->kinematics().jacobian(device_->handle(), sample_.position, J.data()) != HSP_OK ||
      !J.allFinite())
    return false;
  Eigen::Map<Eigen::Matrix<double, 6, HDV_MAX_JOINTS, Eigen::RowMajor>> world(&rows[0][0]);
  world.setZero();
  world.topLeftCorner(3, joints).noalias() = R_world_device_ * J.topRows<3>();
  world.bottomLeftCorner(3, joints).noalias() = R_world_device_ * J.bottomRows<3>();
  return true;
}

uint32_t Arm::links(std::array<LinkEnd, HDV_MAX_LINKS>& ends) const noexcept HSP_RT {
  const hdv_ext_links* links = device_->links();
  if (links == nullptr || !probe_.valid) return 0;
  std::array<double, 3 * HDV_MAX_LINKS> positions;
  std::array<double, 4 * HDV_MAX_LINKS> orientations;
  if (links->frames(device_->handle(), sample_.position, positions.data(), orientations.data()) != HSP_OK) return 0;
  for (uint32_t i = 0; i < links->link_count; ++i) {
    const Eigen::Vector3d p = R_world_device_ * Eigen::Map<const Eigen::Vector3d>(&positions[3 * i]) + origin_world_;
    const Eigen::Quaterniond turn = q_world_device_ * quaternionOf(&orientations[4 * i]);
    ends[i] = {{p.x(), p.y(), p.z()}, {turn.w(), turn.x(), turn.y(), turn.z()}};
  }
  return links->link_count;
}

/// Under compliance control, shapes meet the virtual mass and not the arm that follows it.
void Arm::takeVirtualProbe(Admittance& mass) noexcept HSP_RT {
  if (limiter_.fault() != Fault::kNone) return mass.stop();  // now driven by force, which can be faded
  if (!mass.started() && !mass.start(sample_.position)) return;
  probe_.position = R_world_device_ * mass.position() + origin_world_;
  probe_.orientation = q_world_device_ * quaternionOf(mass.orientation().data());
  probe_.velocity = R_world_device_ * mass.velocity();
}

/// Compliance control: `force` of the contacts and the push of the hand move the virtual mass, and the arm follows the
/// mass. Returns false if that is impossible now; the force then goes to the motors.
bool Arm::comply(double dt, const Eigen::Vector3d& force, const Weight::Torques& weight) noexcept HSP_RT {
  if (!admittance_ || !admittance_->started()) return false;
  const auto hand = handForce();
  Eigen::Vector3d tip;
  std::array<double, 4> turn{};
  const bool measured =
      device_->kinematics().forward(device_->handle(), sample_.position, tip.data(), turn.data()) >= 0;
  if (!hand || !measured) return false;
  admittance_->step(R_world_device_.transpose() * (force + *hand), tip, dt);
  command_.mode = HDV_POSITION;
  for (uint32_t i = 0; i < device_->info().joint_count; ++i) command_.position[i] = admittance_->joints()[i];
  // The arm adds these torques to its own position loop, which otherwise sags under the weight.
  std::copy(weight.begin(), weight.end(), command_.torque);
  return true;
}

void Arm::write(Nanoseconds now, double dt, Eigen::Vector3d force, Eigen::Vector3d torque,
                passivity::Exchange exchange) noexcept HSP_RT {
  if (endsByItself(limiter_.fault())) recover(dt, !force.isZero(0) || !torque.isZero(0));
  limiter_.trustSample(trustIn(now - fresh_at_));
  exchange.pushed &= !former_passivity_;
  if (passivity_ && probe_.valid) force = passivity_->update(probe_.position, force, dt, exchange);
  limiter_.apply(force, torque, probe_.position - origin_world_, dt);
  if (passivity_) passivity_->applied(force);
  force_ = force;
  const uint32_t joints = device_->info().joint_count;
  const hdv_ext_kinematics& kinematics = device_->kinematics();
  Jacobian J(6, joints);
  command_ = kMotorsOff;
  const bool located = std::isfinite(sample_.position[0]) &&
                       kinematics.jacobian(device_->handle(), sample_.position, J.data()) == HSP_OK && J.allFinite();
  if (!located) sendsNothing();
  const Weight::Torques weight = located ? weightTorques(J.topRows<3>(), dt) : Weight::Torques{};
  if (located && !limiter_.silent() && !comply(dt, force, weight)) {
    command_.mode = HDV_TORQUE;
    Eigen::Map<Eigen::VectorXd> tau(command_.torque, joints);
    const Eigen::Vector3d force_device = R_world_device_.transpose() * force;
    tau.noalias() = J.topRows<3>().transpose() * force_device;  // Thompson et al. 1999, Eq. 9
    if (turns()) tau.noalias() += J.bottomRows<3>().transpose() * (R_world_device_.transpose() * torque);
    scaleToMotors(weight);
  }
  if (!heat_.empty()) heatMotors(dt);
  const bool wrote = write_status_ >= 0;
  send(now);
  if (write_status_ >= 0) return;
  // If a command could not be written, the motors keep the last one, and a ramp is impossible.
  if (wrote) device_->cut();
  trip(Fault::kDeviceLost);
  limiter_.cut(Fault::kDeviceLost, 0);
}

/// Sends no force, because the torques for it are unknown. If the tip is known but its Jacobian is not, the device
/// module is at fault.
void Arm::sendsNothing() noexcept HSP_RT {
  limiter_.sentNothing();
  if (!probe_.valid) return;
  limiter_.trip(Fault::kNotFinite);
  force_.setZero();
}

void Arm::send(Nanoseconds now) noexcept HSP_RT {
  if (taken_.exchange(true)) return;  // the watchdog is writing a zero force
  if (cut_in_write_) cut_.store(true);
  cut_in_write_ = false;
  if (cut_.load()) {  // the motors are off until this tick has acknowledged the cut
    findCut(CutFound::kInWrite);
    command_ = kMotorsOff;
  }
  write_status_ = device_->write(now, command_);
  taken_.store(false);
}

void Arm::heatMotors(double dt) noexcept HSP_RT {
  static constexpr std::array<double, HDV_MAX_JOINTS> kNone{};
  heat_.heat(command_.mode == HDV_OFF ? kNone.data() : command_.torque, dt);
  limiter_.spareMotors(heat_.factor());
  if (heat_.overheated()) limiter_.trip(Fault::kOverheated, heat_.hottest());
}

void Arm::cut(double after) noexcept {
  if (cut_.exchange(true)) return;
  const Owner* in = ownerOfWorker(Worker::kServo);
  stuck_here_.store(in != nullptr && in->device && in->name == name_, std::memory_order_release);
  cut_after_.store(after);
  if (device_->cut()) return;
  // A module without hdv.cut/1 may be called by one thread at a time: if the servo is inside the module now, only the
  // hardware's own watchdog can help.
  if (taken_.exchange(true)) return;
  device_->write(monotonicNow(), kMotorsOff);
  taken_.store(false);
}

void Arm::findCut(CutFound when) noexcept HSP_RT {
  if (!cut_known_) cut_found_ = when;
  cut_known_ = true;
}

void Arm::cutAsThen(CutFound when, double after) noexcept HSP_RT {
  cut_known_ = true;  // the recording contains this cut already
  cut_after_.store(after);
  cut_in_write_ = when == CutFound::kInWrite;
  if (when == CutFound::kInRead) cut_.store(true);
}

void Arm::clear() noexcept HSP_RT {
  cut_.store(false);
  cut_known_ = cut_in_write_ = false;
  limiter_.clear();
}

Weight::Torques Arm::weightTorques(const TipJacobian& J, double dt) noexcept HSP_RT {
  Weight::Torques gravity{};
  const bool known = device_->kinematics().gravity(device_->handle(), sample_.position, gravity_device_.data(),
                                                   gravity.data()) == HSP_OK;
  const bool finite = std::all_of(gravity.begin(), gravity.end(), [](double torque) { return std::isfinite(torque); });
  if (known && !finite) limiter_.trip(Fault::kNotFinite);
  if (!known || !finite) return {};
  if (weight_.bound(gravity, J, limiter_.allowed(), dt)) limiter_.clippedWeight();
  return gravity;
}

void Arm::scaleToMotors(const Weight::Torques& gravity) noexcept HSP_RT {
  // Scales all joints by one factor, so that the force on the hand keeps its direction when a motor is at its limit.
  // The torques that carry the arm's weight are not scaled, or the arm would fall on the hand.
  double factor = 1;
  for (uint32_t i = 0; i < device_->info().joint_count; ++i) {
    const double most = device_->info().max_torque[i], asked = command_.torque[i];
    if (most <= 0 || asked == 0) continue;
    const double held = std::clamp(gravity[i], -most, most);
    const double room = asked > 0 ? most - held : most + held;
    if (std::abs(asked) > room) factor = std::min(factor, room / std::abs(asked));
  }
  if (factor < 1) limiter_.clippedByMotors();
  for (uint32_t i = 0; i < device_->info().joint_count; ++i) {
    const double most = device_->info().max_torque[i], sum = gravity[i] + factor * command_.torque[i];
    command_.torque[i] = most > 0 ? std::clamp(sum, -most, most) : sum;
  }
}

bool onlySimulated(const Arms& arms) noexcept HSP_RT {
  return std::all_of(arms.begin(), arms.end(), [](const auto& arm) { return arm->simulated(); });
}

}  // namespace hapticd::servo
