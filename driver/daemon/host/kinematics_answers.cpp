// SPDX-License-Identifier: MIT
/// Checks the results of a module's kinematic functions: they must be finite, must fit the size of an arm, and must not
/// be written beyond the memory for them.
#include <functional>

#include "base/short_number.hpp"
#include "host/class_table.hpp"
#include "host/kinematics_calls.hpp"
#include "host/kinematics_check.hpp"
#include "host/kinematics_places.hpp"

namespace hapticd::host {
namespace {

constexpr double kFarthest = 100;  ///< [m] no arm reaches this far: such numbers are in mm, or were never set
constexpr double kUnit = 0.02;     ///< allowed error of a quaternion's length; rounding causes less

std::string wrongTable(const hdv_ext_kinematics& kinematics) {
  if (kinematics.joint_count == 0 || kinematics.joint_count > HDV_MAX_JOINTS)
    return "has kinematics of " + std::to_string(kinematics.joint_count) + " joints, expected 1 to " +
           std::to_string(HDV_MAX_JOINTS) + " in hdv_ext_kinematics.joint_count";
  const std::pair<bool, const char*> functions[] = {{kinematics.forward != nullptr, "forward"},
                                                    {kinematics.jacobian != nullptr, "jacobian"},
                                                    {kinematics.gravity != nullptr, "gravity"},
                                                    {kinematics.inverse != nullptr, "inverse"}};
  for (const auto& [there, name] : functions)
    if (!there)
      return std::string("has kinematics without a function ") + name + "; expected all four of hdv_ext_kinematics";
  return "";
}

/// The results of one function at the places where it was called.
struct Answers {
  const char* function;
  int asked = 0, refused = 0, no_numbers = 0;
  hsp_status status = HSP_OK;  ///< status of the last refusal
  Joints at = Joints::Zero();  ///< first place at which the result was not finite

  /// Counts a result. @return true if the result is finite, so that it can be checked further
  bool take(hsp_status answer, bool finite, const Joints& q) {
    ++asked;
    if (answer < 0) return ++refused, status = answer, false;
    if (!finite && no_numbers++ == 0) at = q;
    return finite;
  }
  /// Returns what is wrong with the results; "" if nothing is wrong. @param everywhere true: it is an error only if no
  /// accepted place has a finite result; false: it is an error if the result of any accepted place is not finite
  std::string wrong(Eigen::Index joints, bool everywhere, const char* where) const {
    const std::string name = std::string("has kinematics whose ") + function + "() ";
    if (asked > 0 && refused == asked)
      return name + "refuses every one of " + std::to_string(asked) + " places " + where + " (" + statusName(status) +
             "), so no force could be computed; expected HSP_OK wherever the arm can be";
    const bool too_many = everywhere ? no_numbers > 0 && no_numbers == asked - refused : no_numbers > 0;
    if (!too_many) return "";
    return name + "gives numbers that are not finite with the joints at " + placeText(at, joints) +
           ", and says HSP_OK; expected finite numbers, or HSP_E_NUMERIC if there is no result";
  }
};

/// Returns what is wrong with the tip at one place; "" if nothing is wrong.
std::string wrongTip(const Tip& tip, const Joints& q, Eigen::Index joints) {
  const std::string at = " with the joints at " + placeText(q, joints);
  if (!(std::abs(tip.length - 1) <= kUnit))
    return "has kinematics whose forward() gives an orientation of length " + withDigits(tip.length, 4) + at +
           "; expected a unit quaternion w, x, y, z: 1, 0, 0, 0 for an arm that does not turn its tip";
  if (!(tip.position.norm() <= kFarthest))
    return "has kinematics whose forward() puts the tip " + withDigits(tip.position.norm(), 4) + " m away" + at +
           ", farther than any arm reaches; the position must be in m";
  return "";
}

std::string overrun(const char* function, const char* room, Eigen::Index numbers) {
  return std::string("has kinematics whose ") + function + "() writes beyond the " + std::to_string(numbers) +
         " numbers of " + room + "; check hdv_ext_kinematics.joint_count and the order J[row * joint_count + joint]";
}

/// Calls the three functions that the servo thread uses at the places that `place` returns.
std::string wrongAnswers(const KinematicsCalls& calls, const std::function<Joints(int)>& place, bool known_stops) {
  const Eigen::Index n = calls.joints();
  Answers forward{"forward"}, jacobian{"jacobian"}, gravity{"gravity"};
  for (int i = 0; i < kPlaces; ++i) {
    const Joints q = place(i);
    Tip tip;
    tip.position.setConstant(std::nan(""));  // so that a number that forward() does not write is found
    const hsp_status status = calls.forward(q, tip);
    if (!forward.take(status, tip.position.allFinite() && std::isfinite(tip.length), q)) continue;
    if (std::string wrong = wrongTip(tip, q, n); !wrong.empty()) return wrong;
    KinematicsCalls::JacobianRoom J(static_cast<size_t>(6 * n));
    const hsp_status of_J = calls.jacobian(q, J);
    const bool has_J = jacobian.take(of_J, J.finite(), q);
    if (J.overrun()) return overrun("jacobian", "J (6 * joint_count)", 6 * n);
    KinematicsCalls::JointRoom torque(static_cast<size_t>(n));
    const hsp_status of_torque = has_J ? calls.gravity(q, {4, -8, 3}, torque) : HSP_OK;
    if (has_J) gravity.take(of_torque, torque.finite(), q);
    if (torque.overrun()) return overrun("gravity", "tau", n);
  }
  const char* where = known_stops ? "between its stops" : "within 0.9 rad (or m) of zero";
  for (const Answers* one : {&forward, &jacobian, &gravity}) {
    if (one == &forward && !known_stops && one->refused == one->asked)
      return "";  // the stops are unknown, and all places that were tried may lie beyond them
    if (one == &gravity && one->refused == one->asked)
      continue;  // allowed: the weight is unknown then, and is not carried
    if (std::string wrong = one->wrong(n, !known_stops, where); !wrong.empty()) return wrong;
  }
  return "";
}

}  // namespace

std::string wrongKinematics(const hdv_ext_kinematics& kinematics, const hdv_device* device) {
  if (std::string wrong = wrongTable(kinematics); !wrong.empty()) return wrong;
  const KinematicsCalls calls(kinematics, device);
  if (std::string wrong = wrongAnswers(calls, &anyPlace, false); !wrong.empty()) return wrong;
  return wrongJacobian(kinematics, device);
}

std::string wrongBetweenStops(const hdv_ext_kinematics& kinematics, const hdv_device* device, const hdv_info& info) {
  const KinematicsCalls calls(kinematics, device);
  return wrongAnswers(calls, [&info](int i) { return placeBetweenStops(i, info); }, true);
}

}  // namespace hapticd::host
