// SPDX-License-Identifier: MIT
/// Finds mistakes in kinematics that cause no fault in a run.
#include <cstdio>

#include "base/short_number.hpp"
#include "host/class_table.hpp"
#include "host/kinematics_calls.hpp"
#include "host/kinematics_check.hpp"
#include "host/kinematics_places.hpp"

namespace hapticd::host {
namespace {

std::string metres(const Eigen::Vector3d& p) {
  char text[80];
  std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g) m", p.x(), p.y(), p.z());
  return text;
}

/// Checks that inverse(forward(q)) gives joints with the same tip (the joints may differ), and that inverse() refuses a
/// tip which no arm reaches.
class InverseCheck {
 public:
  explicit InverseCheck(const KinematicsCalls& calls) : calls_(calls) {}

  void look(const Joints& q, const Tip& tip) {
    KinematicsCalls::JointRoom found(static_cast<size_t>(calls_.joints()));
    const Joints elsewhere = 0.8 * q;  // a start away from q, so that an inverse() that changes nothing is found out
    std::copy_n(elsewhere.data(), calls_.joints(), found.data());
    ++asked_;
    const hsp_status status = calls_.inverse(tip.position, found);
    if (found.overrun()) return keep("writes beyond the joint_count numbers of q");
    if (status < 0) return ++refused_, status_ = status, void();
    if (!found.finite())
      return keep("gives joints that are not finite for " + metres(tip.position) + ", and says HSP_OK");
    Joints back = Joints::Zero();
    std::copy_n(found.data(), calls_.joints(), back.data());
    Tip again;
    if (calls_.forward(back, again) < 0) return;
    const double off = (again.position - tip.position).norm();
    constexpr double kOff = 1e-3;  // [m] more than the error of an iteration that stops early
    if (!(off <= kOff))
      keep("gives joints " + placeText(back, calls_.joints()) + " for " + metres(tip.position) +
           ", where forward() puts the tip at " + metres(again.position));
  }
  bool refusedAll() const { return refused_ == asked_; }
  void lookFarAway() {
    const Eigen::Vector3d far(700, 500, 500);  // [m]
    KinematicsCalls::JointRoom found(static_cast<size_t>(calls_.joints()));
    if (calls_.inverse(far, found) < 0 || !found.finite()) return;
    Joints back = Joints::Zero();
    std::copy_n(found.data(), calls_.joints(), back.data());
    Tip tip;
    if (calls_.forward(back, tip) >= 0 && !((tip.position - far).norm() <= 1)) keep("says HSP_OK for " + metres(far));
  }
  /// Returns what is wrong: first what a user notices, then the function that the author of the module must fix.
  std::string said() const {
    if (wrong_.empty() && (asked_ == 0 || refused_ < asked_)) return "";
    const std::string effect =
        "the module cannot tell which joint positions bring the tip to a place, so a simulated hand and `hapticd "
        "device encode` go wrong: its inverse() ";
    if (!wrong_.empty())
      return effect + wrong_ + "; expected forward(inverse(p)) to be p, or HSP_E_NUMERIC out of reach";
    return effect + "finds no joint positions (" + statusName(status_) + ") for any of " + std::to_string(asked_) +
           " places at which its own forward() puts the tip, although the search starts nearby; expected HSP_OK within "
           "the joint limits";
  }

 private:
  void keep(const std::string& wrong) {
    if (wrong_.empty()) wrong_ = wrong;
  }
  const KinematicsCalls& calls_;
  int asked_ = 0, refused_ = 0;
  hsp_status status_ = HSP_OK;
  std::string wrong_;
};

/// True if moving a joint turns the tip by forward(), although the angular rows of the Jacobian are zero.
bool turnsWithoutRows(const KinematicsCalls& calls, const Joints& q, const Tip& tip) {
  KinematicsCalls::JacobianRoom J(static_cast<size_t>(6 * calls.joints()));
  if (calls.jacobian(q, J) < 0) return false;
  const double* rows = J.data() + 3 * calls.joints();
  if (!std::all_of(rows, rows + 3 * calls.joints(), [](double value) { return value == 0; })) return false;
  constexpr double kMoved = 1e-3, kTurns = 0.1;  // [rad or m] step of a joint; least turn per step
  for (Eigen::Index joint = 0; joint < calls.joints(); ++joint) {
    Joints moved = q;
    moved[joint] += kMoved;
    Tip after;
    if (calls.forward(moved, after) >= 0 && after.orientation.angularDistance(tip.orientation) > kTurns * kMoved)
      return true;
  }
  return false;
}

/// Returns the force [N] that the torques of gravity() exert at the tip.
Eigen::Vector3d weightForceAt(const KinematicsCalls& calls, const Joints& q, const Eigen::Vector3d& down) {
  constexpr double kRoom = 1e-6;  // [m^2] regularises directions in which no joint moves the tip
  const Eigen::Index n = calls.joints();
  KinematicsCalls::JacobianRoom room(static_cast<size_t>(6 * n));
  KinematicsCalls::JointRoom torque(static_cast<size_t>(n));
  if (calls.jacobian(q, room) < 0 || calls.gravity(q, down, torque) < 0 || !torque.finite())
    return Eigen::Vector3d::Zero();
  const Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>> J(room.data(), 3, n);
  const Eigen::Map<const Eigen::VectorXd> tau(torque.data(), n);
  Eigen::Matrix3d square = J.lazyProduct(J.transpose());
  square.diagonal().array() += kRoom;
  return square.inverse() * J.lazyProduct(tau);
}

constexpr double kFelt = 0.05;  ///< [N] a hand does not feel a smaller weight

/// True if the torques of gravity() pull the arm down at nearly all places, so that they have the wrong sign.
/// Counterweights may cause that only at some places.
bool pullsDown(const KinematicsCalls& calls) {
  int felt = 0, down = 0;
  for (int i = 0; i < kPlaces; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const double lift = -weightForceAt(calls, anyPlace(i), 9.81 * Eigen::Vector3d::Unit(axis))[axis];
      felt += std::abs(lift) > kFelt ? 1 : 0;
      down += lift < -kFelt ? 1 : 0;
    }
  return felt >= kPlaces && 10 * down >= 9 * felt;
}

/// Returns the name of an axis of gravity whose weight the torques of gravity() push aside at all places, and never
/// lift, because components of gravity are exchanged; 0 if there is none.
char pushesAside(const KinematicsCalls& calls) {
  constexpr double kShare = 0.05;  // share of the force; a smaller one is a rounding error near a singular pose
  for (int axis = 0; axis < 3; ++axis) {
    int felt = 0, lifts = 0;
    for (int i = 0; i < kPlaces; ++i) {
      const Eigen::Vector3d force = weightForceAt(calls, anyPlace(i), 9.81 * Eigen::Vector3d::Unit(axis));
      felt += force.norm() > kFelt ? 1 : 0;
      lifts += std::abs(force[axis]) > kShare * force.norm() ? 1 : 0;
    }
    if (felt == kPlaces && lifts == 0) return "xyz"[axis];
  }
  return 0;
}

/// Finds places at which forward() says HSP_OK and gives numbers that are not finite. The stops are unknown before the
/// arm is opened, so such a place is not an error yet.
std::string placesWithoutNumbers(const KinematicsCalls& calls) {
  int without = 0;
  Joints first = Joints::Zero();
  for (int i = 0; i < kPlaces; ++i) {
    Tip tip;
    if (calls.forward(anyPlace(i), tip) < 0 || tip.position.allFinite()) continue;
    if (without++ == 0) first = anyPlace(i);
  }
  if (without == 0) return "";
  return "its forward() gives numbers that are not finite at " + std::to_string(without) + " of " +
         std::to_string(kPlaces) + " places within 0.9 rad (or m) of zero, first at " +
         placeText(first, calls.joints()) +
         ", and says HSP_OK; expected finite numbers, or HSP_E_NUMERIC beyond its stops";
}

}  // namespace

std::string wrongInverse(const hdv_ext_kinematics& kinematics, const hdv_device* device) {
  const KinematicsCalls calls(kinematics, device);
  InverseCheck inverse(calls);
  bool any = false;
  // If the arm moves by less than a radian or a metre, its inverse() is right to refuse the outer places.
  for (const double part : {1.0, 0.1}) {
    if (!inverse.refusedAll()) break;
    for (int i = 0; i < kPlaces; ++i) {
      const Joints q = part * anyPlace(i);
      Tip tip;
      if (calls.forward(q, tip) < 0 || !tip.position.allFinite()) continue;
      any = true;
      inverse.look(q, tip);
    }
  }
  if (any) inverse.lookFarAway();
  return inverse.said();
}

std::vector<std::string> doubtsAboutKinematics(const hdv_ext_kinematics& kinematics, const hdv_device* device) {
  constexpr double kFar = 5;  // [m] no hand moves an arm this far
  const KinematicsCalls calls(kinematics, device);
  double farthest = 0;
  bool turns = true, any = false;
  for (int i = 0; i < kPlaces; ++i) {
    const Joints q = anyPlace(i);
    Tip tip;
    if (calls.forward(q, tip) < 0 || !tip.position.allFinite()) continue;
    any = true;
    farthest = std::max(farthest, tip.position.norm());
    turns = turns && turnsWithoutRows(calls, q, tip);
  }
  std::vector<std::string> doubts;
  if (std::string without = placesWithoutNumbers(calls); any && !without.empty()) doubts.push_back(std::move(without));
  if (any && pullsDown(calls))
    doubts.push_back(
        "the torques of its gravity() pull the tip down, so the arm would weigh twice as much on the hand; "
        "expected those that hold it up: tau = - sum of m J^T g");
  if (const char axis = any ? pushesAside(calls) : '\0'; axis != 0)
    doubts.push_back(std::string("the torques of its gravity() push the tip aside and never up, if gravity is along ") +
                     axis + ": are two of its components exchanged? Expected tau = - sum of m J^T g");
  if (any && turns)
    doubts.push_back(
        "its forward() turns the tip, but rows 3 to 5 of its Jacobian are 0 everywhere: no torque of a shape reaches "
        "the motors; expected angular rows, or an orientation that does not change");
  if (farthest > kFar)
    doubts.push_back("its forward() puts the tip " + withDigits(farthest, 4) +
                     " m away, farther than a hand can move an arm; the position must be in m");
  return doubts;
}

std::string weightBeyondMotors(const hdv_ext_kinematics& kinematics, const hdv_device* device, const hdv_info& info) {
  const KinematicsCalls calls(kinematics, device);
  Joints least = Joints::Constant(HUGE_VAL);
  for (int i = 0; i < kPlaces; ++i) {
    const Joints q = placeBetweenStops(i, info);
    // The arm may be mounted in any orientation, so this takes the smallest torque of six mountings.
    for (Eigen::Index joint = 0; joint < calls.joints(); ++joint) {
      double lightest = HUGE_VAL;
      for (int mounting = 0; mounting < 6; ++mounting) {
        Eigen::Vector3d down = Eigen::Vector3d::Zero();
        down[mounting / 2] = mounting % 2 == 0 ? 9.81 : -9.81;
        KinematicsCalls::JointRoom torque(static_cast<size_t>(calls.joints()));
        if (calls.gravity(q, down, torque) >= 0) lightest = std::min(lightest, std::abs(torque.data()[joint]));
      }
      least[joint] = std::min(least[joint], lightest);
    }
  }
  for (uint32_t i = 0; i < info.joint_count; ++i)
    if (info.max_torque[i] > 0 && least[i] < HUGE_VAL && least[i] > info.max_torque[i]) {
      char text[240];
      std::snprintf(
          text, sizeof text,
          "has a gravity() that asks joint %u for %.4g N m (or N) or more at every place and in every mounting, but "
          "its motor gives only %.4g; masses must be in kg, lengths in m",
          i + 1, least[i], info.max_torque[i]);
      return text;
    }
  return "";
}

std::string heavyForMotors(const hdv_ext_kinematics& kinematics, const hdv_device* device, const hdv_info& info) {
  const KinematicsCalls calls(kinematics, device);
  int asked = 0, beyond = 0;
  double worst = 0;
  uint32_t joint = 0;
  for (int i = 0; i < kPlaces; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      KinematicsCalls::JointRoom torque(static_cast<size_t>(calls.joints()));
      if (calls.gravity(placeBetweenStops(i, info), 9.81 * Eigen::Vector3d::Unit(axis), torque) < 0) continue;
      bool too_much = false;
      for (uint32_t k = 0; k < info.joint_count; ++k) {
        if (!(info.max_torque[k] > 0)) continue;
        const double times = std::abs(torque.data()[k]) / info.max_torque[k];
        too_much |= times > 1;
        if (times > worst) worst = times, joint = k;
      }
      ++asked;
      beyond += too_much ? 1 : 0;
    }
  if (asked == 0 || 2 * beyond < asked) return "";
  char text[280];
  std::snprintf(
      text, sizeof text,
      "the torques of gravity() are more than the motors give at %d of %d places and mountings, up to %.4g N m "
      "(or N) at joint %u, where hdv_info.max_torque is %.4g: the arm would fall on the hand; "
      "masses must be in kg",
      beyond, asked, worst * info.max_torque[joint], joint + 1, info.max_torque[joint]);
  return text;
}

}  // namespace hapticd::host
