// SPDX-License-Identifier: MIT
/// Finds parameters that have no effect, because another parameter of the model switches them off.
#include <fmt/format.h>

#include <string>
#include <string_view>

#include "diagnostics/scene/given_model.hpp"
#include "diagnostics/scene/value_plausibility.hpp"

namespace hapticd::diagnostics {
namespace {

/// A parameter that is used only with one word of a choice.
struct OfChoice {
  std::string_view id, choice, word;
};
constexpr OfChoice kOfChoice[] = {
    {"iterations", "method", "dpt"}, {"tolerance", "method", "newton"}, {"tolerance", "search", "newton"},
    {"depth", "search", "binary"},   {"profile", "law", "profile"},     {"profile_file", "law", "profile"},
};

/// A parameter that is used only if another is above zero.
struct OfNumber {
  std::string_view id, number;
};
constexpr OfNumber kOfNumber[] = {{"texture.wavelength", "texture.amplitude"}, {"relaxation.time", "relaxation.share"}};

/// Warns of parameters that only another word of a choice would use.
void checkChoices(const GivenModel& given) {
  for (const OfChoice& one : kOfChoice) {
    given.begin();
    const std::string word = given.choice(one.choice);
    if (word.empty() || word == one.word || given.find(one.id) == nullptr) continue;
    given.warn({one.id},
               fmt::format("has no effect with {0}: {1}; remove it, or set {0}: {2}", one.choice, word, one.word));
  }
}

/// Warns of parameters of an effect that is switched off by a zero.
void checkNumbers(const GivenModel& given) {
  for (const OfNumber& one : kOfNumber) {
    given.begin();
    if (given.plugin().indexOf(std::string(one.number)) < 0 || given.find(one.id) == nullptr) continue;
    if (given.number(one.number) > 0) continue;
    given.warn({one.id}, fmt::format("has no effect while {0} is 0; give {0}, too, or remove this", one.number));
  }
}

/// Warns of a scale of the depth where the contact law has none: a linear wall without damping.
void checkDepthScale(const GivenModel& given) {
  const char* damping = given.plugin().indexOf("contact_damping") >= 0 ? "contact_damping" : "damping";
  if (given.find("depth_scale") == nullptr || given.plugin().indexOf("exponent") < 0) return;
  if (given.number("exponent") != 1 || given.number(damping) > 0) return;
  given.warn({"depth_scale"}, fmt::format("has no effect on a linear wall without damping, whose force is stiffness "
                                          "times depth; give exponent or {}, or remove this",
                                          damping));
}

/// Warns of values of a rotation where the body does not turn.
void checkSlider(const GivenModel& given) {
  if (given.choice("motion") != "dynamic" || given.choice("joint") != "slider") return;
  for (const char* id : {"angular_drag", "spin", "inertia"})
    if (given.find(id) != nullptr)
      given.warn({id}, "has no effect: a slider does not turn; remove it, or set joint: hinge or free");
}

/// Warns of a spring, or of its rest, that the joint of the body does not use.
void checkJointSpring(const GivenModel& given) {
  if (given.choice("motion") != "dynamic") return;
  const std::string joint = given.choice("joint");
  if (joint.empty()) return;
  if (joint != "hinge" && given.number("angular_tether") > 0)
    given.warn({"angular_tether"},
               fmt::format("has no effect: it turns a hinge back, and the joint is {}; {}", joint,
                           joint == "slider" ? "give tether, in N/m" : "set joint: hinge, or remove this"));
  given.begin();
  const char* spring = joint == "hinge" ? "angular_tether" : "tether";
  if (given.find("rest") == nullptr || (joint != "free" && given.number(spring) > 0)) return;
  given.warn({"rest"}, joint == "free"
                           ? std::string("has no effect: the tether of a free body ends where the body starts; set "
                                         "joint: hinge or slider, or remove this")
                           : fmt::format("has no effect, because the {0} has no spring; give {1}, too, or remove this",
                                         joint, spring));
}

/// Warns of parameters of a soft body that have no effect: contact_ratio unless dynamics is `felt`, and shear_offset
/// beside shear_distance.
void checkSoftBody(const GivenModel& given) {
  const std::string dynamics = given.choice("dynamics");
  if ((dynamics == "off" || dynamics == "seen" || dynamics == "on") && given.find("contact_ratio") != nullptr)
    given.warn({"contact_ratio"},
               fmt::format("has no effect with dynamics: {}; remove it, or set dynamics: felt", dynamics));
  if (given.number("shear_distance") > 0 && given.find("shear_offset") != nullptr)
    given.warn({"shear_offset"}, "has no effect beside shear_distance; remove one of them");
}

}  // namespace

void checkIdleParameters(const GivenModel& given) {
  checkChoices(given);
  checkNumbers(given);
  for (const auto& judge : {&checkDepthScale, &checkSlider, &checkJointSpring, &checkSoftBody}) {
    given.begin();
    judge(given);
  }
}

}  // namespace hapticd::diagnostics
