// SPDX-License-Identifier: MIT
#include "servo/core/load_shedding.hpp"

#include <algorithm>

namespace hapticd::servo {

namespace {

/// a tick that was too long counts as much as four good ones: one in five may be too long
constexpr uint32_t kWeight = 4;

bool lowers(const Load& load) noexcept HSP_RT {
  return load.step_ns > 0 && load.level < Accuracy::kCoarsest;
}

}  // namespace

std::span<const LoadShedding::Change> LoadShedding::findChanges(std::span<const Load> loads,
                                                                uint64_t budget_ns) noexcept HSP_RT {
  count_ = 0;
  uint64_t spent = 0;
  for (const Load& load : loads) spent += load.step_ns;
  if (since_raise_ < kLongest) ++since_raise_;
  if (spent > budget_ns) {
    // The last raise of accuracy was too much: the next attempt waits longer, so that accuracy does not alternate.
    patience_ = since_raise_ < patience_ ? std::min(2 * patience_, kLongest) : patience_;
    calm_ = 0;
    over_ = std::min(over_ + kWeight, 2 * kWeight * kLasting);
    lower(loads, spent, budget_ns);
    return {changes_.data(), count_};
  }
  if (over_ > 0) --over_;
  if (static_cast<double>(spent) > kComfort * static_cast<double>(budget_ns)) {
    calm_ = 0;
  } else if (++calm_ >= kPatience) {
    raise(loads, spent, budget_ns);
  }
  return {changes_.data(), count_};
}

/// True if the accuracy of a shape may be lowered now; in contact only after a lasting overload, because a short one
/// may be an interruption.
bool LoadShedding::mayLower(const Load& load) const noexcept HSP_RT {
  return lowers(load) && (load.importance <= 0 || over_ >= kWeight * kLasting);
}

/// True if a shape takes too long by itself, without interruptions, and the overload is not the first: its accuracy is
/// then lowered without waiting, even in contact.
bool LoadShedding::isProven(const Load& load) const noexcept HSP_RT {
  return load.proven && lowers(load) && over_ >= 2 * kWeight;
}

bool LoadShedding::changed(uint32_t model) const noexcept HSP_RT {
  return std::any_of(changes_.begin(), changes_.begin() + static_cast<long>(count_),
                     [&](const Change& c) { return c.model == model; });
}

/// Lowers the accuracy of the least important shape first. A shape that alone takes more than the whole budget goes to
/// the coarsest level at once.
void LoadShedding::lower(std::span<const Load> loads, uint64_t spent, uint64_t budget_ns) noexcept HSP_RT {
  for (const Load& load : loads)
    if (load.step_ns > budget_ns && (mayLower(load) || isProven(load)) && count_ < kMostChanges)
      changes_[count_++] = {load.model, Accuracy::kCoarsest};
  while (count_ < kMostChanges && spent > budget_ns) {
    const Load* least = nullptr;
    for (const Load& load : loads)
      if (mayLower(load) && !changed(load.model) && (least == nullptr || load.importance < least->importance))
        least = &load;
    if (least == nullptr) return;  // no accuracy can be lowered further: ticks will be late, and are counted
    changes_[count_++] = {least->model, least->level + 1};
    spent -= std::min(spent, least->step_ns / 2);  // estimated saving of one level
  }
}

/// Raises the accuracy of the most important shape, if its former cost fits into the budget, or after a long time even
/// if it does not.
void LoadShedding::raise(std::span<const Load> loads, uint64_t spent, uint64_t budget_ns) noexcept HSP_RT {
  const Load* best = nullptr;
  for (const Load& load : loads)
    if (load.level > 0 && (best == nullptr || load.importance > best->importance)) best = &load;
  if (best == nullptr) return;
  const uint64_t with = spent - best->step_ns + std::max(best->finer_ns, best->step_ns);
  const bool fits = static_cast<double>(with) <= kComfort * static_cast<double>(budget_ns);
  if (calm_ < (fits ? patience_ : kLongest)) return;
  if (since_raise_ >= 2 * patience_) patience_ = kPatience;  // the last raise was not too much
  changes_[count_++] = {best->model, best->level - 1};
  calm_ = 0;
  since_raise_ = 0;
}

}  // namespace hapticd::servo
