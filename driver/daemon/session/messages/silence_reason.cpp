// SPDX-License-Identifier: MIT
#include "session/messages/silence_reason.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/shell_word.hpp"
#include "servo/core/core.hpp"

namespace hapticd::servo {

namespace {

/// Describes a pull, such as ", at 1.234 s with 0.42 N at a depth of 0.525 mm", as far as it is known.
std::string placeOf(const Breach& pull) {
  if (pull.t < 0) return "";
  std::string text = fmt::format(", at {:.3f} s with {:.3g} N", pull.t, pull.force);
  if (pull.depth >= 0) text += fmt::format(" at a depth of {:.3g} mm", pull.depth * 1e3);
  return text;
}

/// Describes a jump, such as "; the largest jump was 5.85 N at 2.134 s at a depth of 3.9 mm", as far as it is known.
std::string sizeOf(const Breach& jump) {
  if (!(jump.force > 0)) return "";
  std::string text = fmt::format("; the largest jump was {:.3g} N", jump.force);
  if (jump.t >= 0) text += fmt::format(" at {:.3f} s", jump.t);
  if (jump.depth >= 0) text += fmt::format(" at a depth of {:.3g} mm", jump.depth * 1e3);
  return text;
}

/// Returns the cure if the jumps are intended: the call of reportJumps() with the largest jump, rounded up.
std::string onPurpose(const Breach& jump) {
  if (!(jump.force > 0)) return "";
  const double unit = std::pow(10, std::floor(std::log10(jump.force)) - 1);
  return fmt::format("if on purpose, call reportJumps(report, {:.6g}) in its activate(); if not, ",
                     unit * std::ceil(jump.force / unit));
}

/// Returns what may be wrong with a shape that pulled. If its depth was zero, the author may have forgotten to set it.
std::string causeOf(const Breach& pull) {
  const std::string sign = "its force has the wrong sign";
  return pull.depth == 0 ? "its depth_m was left at 0 inside, or " + sign : sign;
}

/// Returns a file for a command; the words of fileOfPlugin() stay as they are.
std::string wordOf(const std::string& file) {
  return file.starts_with("FILE.so ") ? file : shellWord(file);
}

/// Returns what the plugin of a silenced model did; "" if its model is not silenced for it.
std::string whatItDid(ShapeFault fault, int32_t failed_status, const Breach& breach) {
  switch (fault) {
    case ShapeFault::kNone:
    case ShapeFault::kLost:
      return "";
    case ShapeFault::kNotFinite:
      return "gave a force, pose or foot point that is not finite";
    case ShapeFault::kBadStatus:
      return "returned status " + std::to_string(failed_status) + ", which a step may not return";
    case ShapeFault::kOverrun:
      return "took longer than the budget of a tick, several times";
    case ShapeFault::kJump:
      return "gave forces that jumped by more than its claimed stiffness allows" + sizeOf(breach);
    case ShapeFault::kTwists:
      return "gave torques that jumped by more than its claimed stiffness allows";
    case ShapeFault::kRunsAway:
      return "moved its body at more than 20 m/s against the hand: it runs away, by a wrong sign of what moves it "
             "(the force on the body is the opposite of the force on the probe), by a spring that is too stiff for its "
             "integrator, or because the scene gives it too little mass or drag for its spring";
    case ShapeFault::kGives:
      return "gave the hand energy from nowhere: its surface turned round by itself, "
             "or pushed more on the way out than on the way in, as a damping does that is too large for the rate, "
             "or its force went along with the hand; "
             "a shape that gives energy on purpose reports HSP_R_JUMPS, and may give more";
    case ShapeFault::kNotUnit:
      return "gave a pose whose quaternion does not have length 1";
    case ShapeFault::kPulls:
      return "pulled the probe into its surface" + placeOf(breach) + ": " + causeOf(breach) +
             ", although it reports to push only (HSP_R_PUSHES)";
  }
  return "";
}

/// Returns what the command after it does about a fault.
std::string adviceFor(ShapeFault fault) {
  if (fault == ShapeFault::kOverrun) return "measure it with";
  const bool in_one_step =
      fault == ShapeFault::kNotFinite || fault == ShapeFault::kBadStatus || fault == ShapeFault::kNotUnit;
  return in_one_step ? "find the step with" : "test it with";
}

}  // namespace

std::string fileOfPlugin(const std::string& plugin) {
  return "FILE.so (`hapticd plugin info " + plugin + "` names the file)";
}

std::string silenceReason(const ModelState& model) {
  if (model.shape == nullptr) return "";
  return silenceReason(model.shape->name(), model.shape->file().string(), model.guard.fault(), model.failed_status,
                       model.breach);
}

std::string silenceReason(const hapticd_event& event, const std::string& model, const std::string& file) {
  const auto fault = static_cast<ShapeFault>(event.code);
  if (fault == ShapeFault::kJump) return silenceReason(model, file, fault, 0, {-1, -1, event.value});
  if (fault != ShapeFault::kPulls) return silenceReason(model, file, fault, static_cast<int32_t>(event.value));
  return silenceReason(model, file, fault, 0, {event.t, -1, event.value});
}

std::string silenceReason(const std::string& model, const std::string& file, ShapeFault fault, int32_t failed_status) {
  return silenceReason(model, file, fault, failed_status, Breach());
}

std::string silenceReason(const std::string& model, const std::string& file, ShapeFault fault, int32_t failed_status,
                          const Breach& breach) {
  const std::string what = whatItDid(fault, failed_status, breach);
  if (what.empty()) return "";
  return "model " + model + ": its plugin " + what + "; it was silenced; " +
         (fault == ShapeFault::kJump ? onPurpose(breach) : "") + adviceFor(fault) + ": hapticd plugin check " +
         wordOf(file) + (fault == ShapeFault::kPulls ? ", which also says where" : "");
}

}  // namespace hapticd::servo
