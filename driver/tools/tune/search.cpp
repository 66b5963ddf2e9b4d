// SPDX-License-Identifier: MIT
#include "tune/search.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <set>

#include "base/clock.hpp"

namespace hapticd::tune {
namespace {

constexpr int kPasses = 3;            ///< how often the motion is repeated to measure the time of one setting
constexpr size_t kFewTogether = 256;  ///< if there are at most so many combinations of values, all are tried
constexpr double kMargin = 0.5;       ///< share of a tolerance to use, because other motions may have larger errors

double geometryErrorOf(const Candidate& c) {
  return std::max(c.error.geometry(), kErrorNoise);
}
double forceErrorOf(const Candidate& c) {
  return std::max(c.error.force_n, kForceNoise);
}

/// Returns true if a is better than b in at least one respect, and worse in none.
bool beats(const Candidate& a, const Candidate& b) {
  const bool cheaper = clearlyCheaper(a, b), no_dearer = a.cost.p50_ns <= b.cost.p50_ns;
  const bool no_worse = geometryErrorOf(a) <= geometryErrorOf(b) && forceErrorOf(a) <= forceErrorOf(b);
  const bool better = geometryErrorOf(a) < geometryErrorOf(b) || forceErrorOf(a) < forceErrorOf(b);
  return no_worse && (cheaper || (no_dearer && better));
}

bool meets(const Candidate& c, const Goal& goal) {
  if (goal.budget_ns) return c.cost.p99_ns <= *goal.budget_ns;
  return c.error.geometry() <= kMargin * goal.tolerance_m && c.error.force_n <= kMargin * goal.force_tolerance_n;
}

/// Returns true if a is preferred to b. Either both meet the goal (`met`), or neither does.
bool preferred(const Candidate& a, const Candidate& b, const Goal& goal, bool met) {
  const bool by_cost = goal.budget_ns ? !met : met;
  if (by_cost) return clearlyCheaper(a, b);
  const auto badness = [&](const Candidate& c) {
    return std::max(geometryErrorOf(c) / goal.tolerance_m, forceErrorOf(c) / goal.force_tolerance_n);
  };
  return badness(a) < badness(b) || (badness(a) == badness(b) && clearlyCheaper(a, b));
}

class Search {
 public:
  Search(const scene::Scene& scene, const Motion& motion, const std::vector<Knob>& knobs, const SearchOptions& options)
      : scene_(scene), motion_(motion), knobs_(knobs), options_(options), begun_(monotonicNow()) {}

  Result<Tuning> run() {
    auto reference = answer(applied(scene_, knobs_, finestOf(knobs_)), motion_, VelocityFrom::kMotion, options_.log);
    if (!reference) return Error{reference.error()};
    reference_ = std::move(*reference);
    const bool met = std::any_of(reference_.answers.begin(), reference_.answers.end(),
                                 [](const Answer& answer) { return answer.traced; });
    if (!met)
      return Error{
          "the motion comes near no model, so there is no error to measure\n"
          "  expected: a tip that touches the models of the scene\n"
          "  fix: give such a motion with --probe FILE, or a recorded one with --motion RECORDING"};
    plan();
    for (size_t i = 0; i < planned_.size() && going_; ++i)
      if (auto tried = attempt(planned_[i]); !tried) return Error{tried.error()};
    if (combinations() > kFewTogether)
      if (auto done = descend(); !done) return Error{done.error()};
    if (auto again = measureAgain(); !again) return Error{again.error()};
    Tuning tuning;
    tuning.candidates = std::move(candidates_);
    tuning.touches = touchesOf(scene_, reference_);
    tuning.complete = going_;
    tuning.out_of_time = out_of_time_;
    tuning.planned = std::max(distinct(), tuning.candidates.size());
    markFront(tuning.candidates);
    std::tie(tuning.chosen, tuning.reached) = choose(tuning.candidates, options_.goal);
    return tuning;
  }

 private:
  size_t combinations() const {
    size_t count = 1;
    for (const Knob& knob : knobs_) count = std::min<size_t>(count * knob.values.size(), 1'000'000);
    return count;
  }

  void plan() {
    const Choice current = currentOf(knobs_);
    planned_ = {current, finestOf(knobs_)};
    for (size_t i = 0; i < knobs_.size(); ++i)
      for (size_t value = 0; value < knobs_[i].values.size(); ++value) planned_.push_back(with(current, i, value));
    if (combinations() > kFewTogether) return;
    Choice choice(knobs_.size(), 0);
    for (size_t n = combinations(); n > 0; --n) {
      planned_.push_back(choice);
      for (size_t i = 0; i < choice.size(); ++i) {
        if (++choice[i] < knobs_[i].values.size()) break;
        choice[i] = 0;
      }
    }
  }

  static Choice with(Choice choice, size_t knob, size_t value) {
    choice[knob] = value;
    return choice;
  }

  /// Measures a choice, unless it was measured before. The first choice is the scene's own. A choice that a model
  /// refuses, such as a method that its geometry does not support, does not become a candidate.
  Result<void> attempt(const Choice& choice) {
    if (!going_ || !seen_.insert(choice).second) return {};
    const bool own = candidates_.empty();
    const host::Services::Log quiet = [this](int level, const std::string& who, const std::string& text) {
      if (level != HSP_LOG_ERROR && options_.log) options_.log(level, who, text);
    };
    auto run = measure(applied(scene_, knobs_, choice), motion_, kPasses, own ? options_.log : quiet);
    if (!run && own) return Error{run.error()};
    if (!run) {
      refused_.insert(choice);
      out_of_time_ = secondsSpent() >= options_.seconds;
      going_ = !out_of_time_;
      return {};
    }
    candidates_.push_back({choice, run->cost, compare(*run, reference_), false});
    const double spent = secondsSpent();
    Progress progress{candidates_.size(), std::max(distinct(), candidates_.size()), 0};
    const double each = spent / static_cast<double>(progress.done);
    const double left = each * static_cast<double>(progress.expected - progress.done);
    progress.seconds_left = std::max(0.0, std::min(left, options_.seconds - spent));
    out_of_time_ = spent >= options_.seconds;
    going_ = (!options_.go_on || options_.go_on(progress)) && !out_of_time_;
    return {};
  }

  /// Measures the first setting (the scene's own) and each setting of the front once more. All settings are compared
  /// with the first, so if the machine was busy or its processor slow at the start, all others would look cheaper. The
  /// difference between the two times of a setting is reported as noise.
  Result<void> measureAgain() {
    constexpr int kMost = 12;
    if (auto done = measureAgain(candidates_[0]); !done) return done;
    markFront(candidates_);
    int count = 0;
    for (size_t i = 1; i < candidates_.size() && count < kMost && going_; ++i) {
      if (!candidates_[i].on_front) continue;
      if (auto done = measureAgain(candidates_[i]); !done) return done;
      if (auto done = measureAgain(candidates_[0]); !done) return done;
      ++count;
    }
    return {};
  }

  Result<void> measureAgain(Candidate& candidate) {
    auto run = measure(applied(scene_, knobs_, candidate.choice), motion_, kPasses, options_.log);
    if (!run) return Error{run.error()};
    widen(candidate.cost, run->cost);
    return {};
  }

  double secondsSpent() const { return static_cast<double>(monotonicNow() - begun_) * kSecondsPerNanosecond; }

  /// Returns the number of settings to try, without those that a model has refused.
  size_t distinct() const {
    std::set<Choice> choices(planned_.begin(), planned_.end());
    for (const Choice& choice : refused_) choices.erase(choice);
    return choices.size();
  }

  /// Starts from the best so far and changes one knob at a time, until no knob helps.
  Result<void> descend() {
    constexpr int kRounds = 3;
    for (int round = 0; round < kRounds && going_; ++round) {
      const size_t before = choose(candidates_, options_.goal).first;
      for (size_t knob = 0; knob < knobs_.size() && going_; ++knob)
        for (size_t value = 0; value < knobs_[knob].values.size() && going_; ++value) {
          const Choice best = candidates_[choose(candidates_, options_.goal).first].choice;
          if (auto tried = attempt(with(best, knob, value)); !tried) return tried;
        }
      if (choose(candidates_, options_.goal).first == before) break;
    }
    return {};
  }

  const scene::Scene& scene_;
  const Motion& motion_;
  const std::vector<Knob>& knobs_;
  const SearchOptions& options_;
  Nanoseconds begun_;
  Run reference_;
  std::vector<Choice> planned_;
  std::set<Choice> seen_, refused_;
  std::vector<Candidate> candidates_;
  bool going_ = true, out_of_time_ = false;
};

}  // namespace

Result<Tuning> search(const scene::Scene& scene, const Motion& motion, const std::vector<Knob>& knobs,
                      const SearchOptions& options) {
  return Search(scene, motion, knobs, options).run();
}

bool clearlyCheaper(const Candidate& a, const Candidate& b) {
  return a.cost.p50_high_ns < b.cost.p50_low_ns;
}

void markFront(std::vector<Candidate>& candidates) {
  for (Candidate& candidate : candidates)
    candidate.on_front = std::none_of(candidates.begin(), candidates.end(),
                                      [&](const Candidate& other) { return beats(other, candidate); });
}

bool alike(const Candidate& a, const Candidate& b) {
  return !clearlyCheaper(a, b) && !clearlyCheaper(b, a) && geometryErrorOf(a) == geometryErrorOf(b) &&
         forceErrorOf(a) == forceErrorOf(b);
}

size_t simplest(const std::vector<Candidate>& candidates, size_t like) {
  const auto changes = [&](const Candidate& c) {
    const Choice &own = candidates[0].choice, &choice = c.choice;
    return std::inner_product(own.begin(), own.end(), choice.begin(), size_t{0}, std::plus<>(), std::not_equal_to<>());
  };
  size_t best = like;
  for (size_t i = 0; i < candidates.size(); ++i)
    if (alike(candidates[i], candidates[like]) && candidates[i].on_front >= candidates[like].on_front &&
        changes(candidates[i]) < changes(candidates[best]))
      best = i;
  return best;
}

std::pair<size_t, bool> choose(const std::vector<Candidate>& candidates, const Goal& goal) {
  size_t best = 0;
  bool met = meets(candidates[0], goal);
  for (size_t i = 1; i < candidates.size(); ++i) {
    const bool now = meets(candidates[i], goal);
    if ((now && !met) || (now == met && preferred(candidates[i], candidates[best], goal, met))) {
      best = i;
      met = now;
    }
  }
  const size_t plain = simplest(candidates, best);
  return {meets(candidates[plain], goal) == met ? plain : best, met};
}

}  // namespace hapticd::tune
