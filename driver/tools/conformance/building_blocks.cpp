// SPDX-License-Identifier: MIT
#include "conformance/building_blocks.hpp"

#include <cmath>

#include "base/short_number.hpp"

namespace hapticd::conformance {

using Eigen::Vector3d;

Made::Made(const Recipe& recipe, uint32_t probes, Time time) {
  auto made = Subject::make(recipe);
  if (!made) {
    error = made.error();
    return;
  }
  subject = std::move(*made);
  if (auto active = subject->activate(probes); !active) error = active.error();
  if (time == Time::kStands && subject->moves()) subject->stopTime();
}

std::string text(double value) {
  return withDigits(value, 6);
}

std::string roughly(double value) {
  return withDigits(value, 2);
}

std::string text(const Vector3d& p) {
  const auto rounded = [](double v) { return text(std::abs(v) < 1e-9 ? 0 : v); };
  return rounded(p.x()) + ", " + rounded(p.y()) + ", " + rounded(p.z()) + " m";
}

std::string placed(const std::string& objection, const Vector3d& p) {
  return "at " + text(p) + ": " + objection;
}

Vector3d onPath(const Subject& subject, double part, double phase) {
  const auto [low, high] = subject.bounds();
  const Vector3d half = 0.65 * (high - low).cwiseMax(1e-3), middle = (low + high) / 2;
  const double angle = 2 * M_PI * part;
  return middle +
         half.cwiseProduct(Vector3d(std::cos(angle + phase), std::cos(2 * angle + phase), std::cos(3 * angle - phase)));
}

std::string along(Subject& subject, const std::function<std::string(const Answer&, const Vector3d&)>& look, int steps) {
  for (int i = 0; i <= steps; ++i) {
    const Vector3d p = onPath(subject, static_cast<double>(i) / steps);
    const Answer& answer = subject.step({p}, kConformanceDt);
    if (std::string objection = look(answer, p); !objection.empty()) return placed(objection, p);
  }
  for (const Place& place : subject.places())
    if (std::string objection =
            press(subject, place, [&](const Answer& answer, const PressStep& step) { return look(answer, step.p); });
        !objection.empty())
      return objection;
  return "";
}

std::string alongAndDeep(Subject& subject, const std::function<std::string(const Answer&, const Vector3d&)>& look) {
  constexpr int kIn = 100;
  if (std::string objection = along(subject, look); !objection.empty()) return objection;
  for (const Place& place : subject.places())
    for (int i = 0; i <= 2 * kIn; ++i) {
      const Vector3d p = place.foot - place.out * (deepestPress(subject, place) * (kIn - std::abs(i - kIn)) / kIn);
      const Answer& answer = subject.step({p}, kConformanceDt, i == 0 ? uint32_t{HSP_IN_JUMP} : 0);
      if (std::string objection = look(answer, p); !objection.empty()) return placed(objection, p);
    }
  return "";
}

Verdict atEachPlace(const Recipe& recipe, const std::function<std::string(Subject&, const Place&)>& test, Time time) {
  const Made made(recipe, 1, time);
  if (!made.error.empty()) return made.error;
  if (recipe.touch.places.empty())
    return recipe.touch.traced || !recipe.touch.felt ? skipped("no contact was found to test, see contact-found")
                                                     : fieldOnly();
  for (const Place& place : recipe.touch.places)
    if (std::string wrong = test(*made.subject, place); !wrong.empty()) return wrong;
  return "";
}

hsp_contact answerAtRest(Subject& subject, const Vector3d& p) {
  subject.step({p}, kConformanceDt, HSP_IN_JUMP);
  const Answer& answer = subject.step({p}, kConformanceDt);
  return answer.status >= HSP_OK && finite(answer) ? answer.contacts[0] : hsp_contact{};
}

std::string wrongStatus(const Answer& answer) {
  const bool known = answer.status == HSP_OK || answer.status == HSP_DEGRADED || answer.status == HSP_E_NUMERIC;
  if (!known)
    return "step() returned status " + std::to_string(answer.status) +
           "; expected HSP_OK, HSP_DEGRADED or HSP_E_NUMERIC, because any other status silences the model";
  return notFinite(answer);
}

Verdict warningOfParams(const Recipe& recipe, const std::function<std::string(const hsp_param&)>& objection,
                        const std::string& between, const std::string& advice) {
  auto made = Subject::make(recipe);
  if (!made) return made.error();
  const hsp_class& c = (*made)->description();
  std::string found;
  for (uint32_t i = 0; i < c.param_count; ++i)
    if (const std::string one = objection(paramAt(c, i)); !one.empty()) found += (found.empty() ? "" : between) + one;
  return found.empty() ? Verdict("") : warned(found + advice);
}

}  // namespace hapticd::conformance
