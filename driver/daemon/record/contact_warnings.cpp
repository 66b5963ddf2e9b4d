// SPDX-License-Identifier: MIT
#include "record/contact_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace hapticd::record {
namespace {

/// Warns of pushes in ticks that cannot count as contact.
std::string oddPushes(const ModelReport& model, const Pushes& pushes, const char* how) {
  if (pushes.ticks == 0) return "";
  return fmt::format("{} pushed in {} ticks {}, with up to {:.2f} N: these do not count as contact", model.name,
                     pushes.ticks, how, pushes.max_force);
}

/// Warns of a force that pulls during most of the contact: its sign is probably wrong. A detent or a magnet pulls only
/// during a part of a contact.
std::string pullText(const ModelReport& model) {
  const Pushes& pulls = model.contact.pulls();
  const uint64_t ticks = model.contact.contactTicks();
  if (2 * pulls.ticks <= ticks) return "";
  return fmt::format(
      "{} pulled the hand in during {:.0f} % of its contact, with up to {:.2f} N: its force may have the wrong sign; "
      "test it with {}",
      model.name, 100 * static_cast<double>(pulls.ticks) / static_cast<double>(ticks), pulls.max_force,
      checkCommand(model));
}

/// Warns of a model that does more work on the hand than the hand did on it, and so pushes the hand. Small differences
/// are not reported: contacts are sampled, and a model may be switched off and on. A hand that was inside at the start
/// may get the energy that was stored there.
std::string energyText(const ModelReport& model) {
  constexpr double kTold = 2e-3, kShare = 0.1;  // [J], and share of the hand's work: less is not reported
  const double net = model.given_j - model.taken_j - model.began_j;
  if (model.moves || !(net > std::max(kTold, kShare * model.taken_j))) return "";
  return fmt::format(
      "{} gave the hand {:.3g} mJ more than it took ({:.3g} mJ): a surface must not give back more work than was done "
      "on it; find the cause with {}",
      model.name, net * 1e3, model.taken_j * 1e3, checkCommand(model));
}

/// Warns of a depth that no arm reaches. Either the model itself is as large, so its lengths are in another unit, or
/// its plugin gives the depth in mm.
std::string deepText(const ModelReport& model) {
  constexpr double kDeep = 0.5;  // [m]
  const double deepest = model.contact.maxDepth();
  if (!(deepest > kDeep)) return "";
  if (model.size_m > deepest)
    return fmt::format(
        "{0} is {1:.3g} m large, and the hand was {2:.3g} m deep in it, deeper than an arm reaches: lengths must be in "
        "m ({1:.3g} mm is {3:.3g} m); check the unit of its geometry, and where it stands",
        model.name, model.size_m, deepest, model.size_m * 1e-3);
  if (deepest * 1e-3 > kDeep && model.moves)  // nor is it a depth in mm
    return fmt::format(
        "{} reports a depth of {:.3g} m: its body runs away, so its force grows without bound; look for a wrong sign "
        "of what moves it (the force on the body is the opposite of the force on the probe) and for a spring that is "
        "too stiff for its integrator; test it with {}",
        model.name, deepest, checkCommand(model));
  return fmt::format(
      "{} reports a depth of {:.3g} m, deeper than an arm reaches: depth_m must be in m (if it is in mm, the depth was "
      "{:.3g} m); test it with {}",
      model.name, deepest, deepest * 1e-3, checkCommand(model));
}

}  // namespace

std::vector<std::string> contactWarnings(const ModelReport& model) {
  const ContactStatistics& c = model.contact;
  std::vector<std::string> texts = {oddPushes(model, c.untraced(), "without HSP_OUT_TRACED")};
  // If there was contact, the shape sets depth_m.
  if (c.contactTicks() == 0) texts.push_back(oddPushes(model, c.depthless(), "with depth_m left at 0"));
  for (std::string text : {pullText(model), energyText(model), deepText(model)}) texts.push_back(std::move(text));
  std::erase(texts, "");
  return texts;
}

}  // namespace hapticd::record
