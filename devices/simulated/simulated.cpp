/// The simulated PHANToM Premium 1.5 and the hand that holds it, at torque level.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include <Eigen/LU>

#include "hand.hpp"
#include "hapticd/device.hpp"
#include "premium15.hpp"

namespace hapticd::simulated {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Map = Eigen::Map<Vector3d>;
using ConstMap = Eigen::Map<const Vector3d>;

const Vector3d kGear(13.3, 11.2, 11.2);        ///< motor turns a joint turn
constexpr double kCountsPerTurn = 4096;         ///< HEDM-5500, 1024 lines, four edges each
constexpr double kStallTorque = 0.129;          ///< [N m] at the motor
constexpr double kJointDamping = 0.0005;        ///< [N m s/rad]
constexpr double kJointFriction = 0.01;         ///< [N m]

class SimulatedArm : public Device {
 public:
  static constexpr DeviceInfo kInfo{"org.hapticd.device.simulated", "simulated", "1.0.0", "MIT",
                                    "A PHANToM Premium 1.5 simulated at torque level, and the hand that holds it."};
  static constexpr const char* kScripts[] = {"hold", "stroke", "press", "tap", "circle"};
  static constexpr auto fields() {
    using F = Fields<SimulatedArm>;
    return std::array{
        F::integer("seed", &SimulatedArm::seed_, "", 0, 1000000000, 1, "Seed of the hand's tremor: same seed, same bits."),
        F::integer("substeps", &SimulatedArm::substeps_, "", 1, 100, 8, "Integration steps in a servo tick."),
        F::choice("hand.script", &SimulatedArm::script_, kScripts, 1, "What the hand does."),
        F::real("hand.mass", &SimulatedArm::mass_, "kg", 0.01, 10, 0.2, "Mass of the hand at the tip."),
        F::real("hand.stiffness", &SimulatedArm::stiffness_, "N/m", 0, 5000, 300, "Spring to the target."),
        F::real("hand.damping", &SimulatedArm::damping_, "N s/m", 0, 200, 6, "Damper to the target."),
        F::vector3("hand.center", &SimulatedArm::center_, "m", -1, 1, "[0, 0, 0]", "Centre of the script, device frame."),
        F::real("hand.radius", &SimulatedArm::radius_, "m", 0, 1, 0.05, "Radius of the arc or circle, or distance of a tap."),
        F::real("hand.sweep", &SimulatedArm::sweep_, "rad", 0, 3.2, 1.0, "Angle of the stroke to either side."),
        F::real("hand.rise", &SimulatedArm::rise_, "m", 0, 0.2, 0.01, "Rise and fall of a stroke; depth of a tap or press."),
        F::real("hand.rate", &SimulatedArm::rate_, "Hz", 0.001, 20, 0.3, "Rate of the script."),
        F::real("hand.tremor", &SimulatedArm::tremor_, "N", 0, 2, 0.05, "Tremor of the hand, rms.")};
  }

  void open(hdv_info& info) {
    info.joint_count = 3;
    info.capabilities = HDV_C_SIMULATED;
    info.rate_hz = 1000;
    info.max_force = 8.5;
    info.continuous_force = 1.5;
    info.max_stiffness = 3500;
    info.resolution_m = 0.00003;
    info.damping = 0.1;
    info.mass_kg = 0.075;
    for (int i = 0; i < 3; ++i) info.max_torque[i] = kStallTorque * kGear[i];
    const double low[] = {-90, -124, -29}, high[] = {90, 119, 214};
    for (int i = 0; i < 3; ++i) {
      info.position_min[i] = low[i] * M_PI / 180;
      info.position_max[i] = high[i] * M_PI / 180;
    }
    std::strcpy(info.product, "simulated PHANToM Premium 1.5");
  }

  void start(const hdv_start& how) {
    HandSettings settings;
    settings.mass = mass_, settings.stiffness = stiffness_, settings.damping = damping_;
    settings.script = static_cast<Script>(script_);
    settings.center = Vector3d(center_.data());
    settings.radius = radius_, settings.sweep = sweep_, settings.rise = rise_, settings.rate = rate_;
    settings.tremor = tremor_;
    hand_ = std::make_unique<Hand>(settings, static_cast<unsigned>(seed_));
    start_ns_ = now_ns_ = how.time_ns;
    gravity_ = -how.gravity[1];
    q_.setZero();
    qd_.setZero();
    torque_.setZero();
  }

  hsp_status read(uint64_t now_ns, hdv_sample& sample) noexcept HSP_RT {
    if (now_ns > now_ns_) advance(static_cast<double>(now_ns - now_ns_) * 1e-9);
    now_ns_ = now_ns;
    sample.time_ns = now_ns;
    sample.sequence = ++sequence_;
    sample.flags = HDV_S_CALIBRATED;
    for (int i = 0; i < 3; ++i) {
      const double counts = std::floor(q_[i] * kGear[i] * kCountsPerTurn / (2 * M_PI));
      sample.position[i] = counts * (2 * M_PI) / (kGear[i] * kCountsPerTurn);
    }
    return HSP_OK;
  }

  hsp_status write(uint64_t, const hdv_command& command) noexcept HSP_RT {
    torque_.setZero();
    if (command.mode != HDV_TORQUE) return HSP_OK;
    for (int i = 0; i < 3; ++i) {
      const double most = kStallTorque * kGear[i];
      torque_[i] = std::isfinite(command.torque[i]) ? std::clamp(command.torque[i], -most, most) : 0;
    }
    return HSP_OK;
  }

  const void* extension(const char* name) {
    return std::strcmp(name, HDV_EXT_KINEMATICS) == 0 ? &kKinematics : nullptr;
  }

 private:
  void advance(double dt) noexcept {
    constexpr double kMostStep = 2.5e-4;  // [s] stable with the stiffest hand whatever was missed
    const int steps = std::max(substeps_, static_cast<int>(std::ceil(dt / kMostStep)));
    const double h = dt / std::min(steps, 100000);
    hand_->drawTremor(dt);
    const double t = static_cast<double>(now_ns_ - start_ns_) * 1e-9;
    for (int i = 0; i < std::min(steps, 100000); ++i) integrate(t + (i + 1) * h, h);
  }

  /// Semi-implicit Euler of (M + m J^T J) q'' = tau + J^T F_hand - C - G - friction - m J^T (dJ/dt) q'.
  void integrate(double t, double h) noexcept {
    const Matrix3d J = arm_.jacobian(q_);
    const Vector3d tip = arm_.forward(q_), tip_velocity = J * qd_;
    const Vector3d pull = hand_->force(t, tip, tip_velocity) - hand_->mass() * arm_.velocityProduct(q_, qd_);
    const Vector3d friction = kJointDamping * qd_ + kJointFriction * (10 * qd_).array().tanh().matrix();
    const Vector3d tau = torque_ + J.transpose() * pull - inertia_.coriolis(q_, qd_) - inertia_.gravity(q_, gravity_) - friction;
    const Matrix3d M = inertia_.mass(q_) + hand_->mass() * J.transpose() * J;
    qd_ += h * M.inverse() * tau;
    q_ += h * qd_;
    for (int i = 0; i < 3; ++i) {  // end stops take the speed away
      const double low[] = {-1.57, -2.16, -0.5}, high[] = {1.57, 2.07, 3.73};
      if (q_[i] < low[i] || q_[i] > high[i]) qd_[i] = 0;
      q_[i] = std::clamp(q_[i], low[i], high[i]);
    }
  }

  static const SimulatedArm& self(const hdv_device* device) { return *reinterpret_cast<const SimulatedArm*>(device); }
  static hsp_status forward(const hdv_device* device, const double* q, double position[3], double orientation[4]) noexcept HSP_RT {
    Map tip(position);
    tip = self(device).arm_.forward(ConstMap(q));
    orientation[0] = 1, orientation[1] = orientation[2] = orientation[3] = 0;
    return HSP_OK;
  }
  static hsp_status jacobian(const hdv_device* device, const double* q, double* J) noexcept HSP_RT {
    Eigen::Map<Eigen::Matrix<double, 6, 3, Eigen::RowMajor>> all(J);
    all.setZero();
    all.topRows<3>() = self(device).arm_.jacobian(ConstMap(q));
    return HSP_OK;
  }
  static hsp_status gravity(const hdv_device* device, const double* q, const double g[3], double* tau) noexcept HSP_RT {
    Map torques(tau);
    torques = self(device).inertia_.gravity(ConstMap(q), -g[1]);
    return HSP_OK;
  }
  static hsp_status inverse(const hdv_device* device, const double position[3], double* q) noexcept HSP_RT {
    Vector3d joints;
    if (!self(device).arm_.inverse(ConstMap(position), joints)) return HSP_E_NUMERIC;
    Map out(q);
    out = joints;
    return HSP_OK;
  }
  static constexpr hdv_ext_kinematics kKinematics{sizeof(hdv_ext_kinematics), 3, &forward, &jacobian, &gravity, &inverse};

  int seed_, substeps_, script_;
  double mass_, stiffness_, damping_, radius_, sweep_, rise_, rate_, tremor_;
  std::array<double, 3> center_;
  Phantom arm_;
  PhantomInertia inertia_;
  std::unique_ptr<Hand> hand_;
  uint64_t start_ns_ = 0, now_ns_ = 0, sequence_ = 0;
  double gravity_ = 9.81;
  Vector3d q_ = Vector3d::Zero(), qd_ = Vector3d::Zero(), torque_ = Vector3d::Zero();
};

}  // namespace
}  // namespace hapticd::simulated

HAPTICD_DEVICES(hapticd::simulated::SimulatedArm)
