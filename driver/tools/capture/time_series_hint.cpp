// SPDX-License-Identifier: MIT
#include "capture/time_series_hint.hpp"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "base/short_number.hpp"

namespace hapticd::capture {
namespace {

using codec::Field;
using codec::Role;
using codec::Verdict;

constexpr size_t kFewestReports = 20;  ///< for fewer reports no hint is given

std::vector<const DecodedReport*> goodOnes(const Decoded& decoded) {
  std::vector<const DecodedReport*> good;
  for (const DecodedReport& report : decoded.reports)
    if (report.verdict == Verdict::kGood) good.push_back(&report);
  return good;
}

using DecodedReports = std::vector<const DecodedReport*>;

template <class Says>
size_t howMany(const DecodedReports& reports, const Says& says) {
  return static_cast<size_t>(
      std::count_if(reports.begin(), reports.end(), [&](const DecodedReport* one) { return says(one->state); }));
}

std::string flags(const codec::Wire& wire, const DecodedReports& reports) {
  const std::string all = "all " + std::to_string(reports.size()) + " reports";
  std::string text;
  const Field *fault = wire.input.find(Role::kFault), *calibrated = wire.input.find(Role::kCalibrated);
  if (fault != nullptr && howMany(reports, [](const codec::State& state) { return state.fault; }) == reports.size())
    text += "the field fault is set in " + all + ", so no torque would go out: " +
            (fault->inverted ? "if 0 means that all is well, remove inverted: true"
                             : "if 1 means that all is well, give inverted: true") +
            "\n";
  if (calibrated != nullptr && howMany(reports, [](const codec::State& state) { return state.calibrated; }) == 0)
    text += "the field calibrated is 0 in " + all + ": no torque goes out before it is 1" +
            (calibrated->inverted ? "; if 1 means that the arm knows its zero, remove inverted: true"
                                  : "; if 0 means that the arm knows its zero, give inverted: true") +
            "\n";
  return text;
}

/// Returns a hint if the field `starts` changes in many reports, as if the device restarted each time. The field then
/// probably counts reports (`counter`), or is a clock (`time`), and was described wrongly.
std::string starts(const codec::Wire& wire, const DecodedReports& reports) {
  if (!wire.input.has(Role::kStarts)) return "";
  size_t changes = 0;
  for (size_t i = 1; i < reports.size(); ++i)
    changes += reports[i]->state.starts != reports[i - 1]->state.starts ? 1 : 0;
  if (10 * changes < reports.size()) return "";
  return "the field starts has another number in " + std::to_string(changes) + " of " + std::to_string(reports.size()) +
         " reports, as if the device restarted each time; "
         "is the field a counter ({is: counter}) or a clock ({is: time})?\n";
}

/// Returns a hint if a counter does not count, but does so in the other byte order.
std::string counter(const codec::Wire& wire, const Decoded& decoded, const DecodedReports& reports) {
  const Field* field = wire.input.find(Role::kSequence);
  if (field == nullptr || field->bits % 8 != 0 || field->bits < 16 || field->bits > 32 || field->bit_skip != 0 ||
      codec::isText(field->type) || 2 * (decoded.gaps + decoded.repeats) < reports.size())
    return "";
  const auto swapped = [&](uint32_t value) {
    uint32_t other = 0;
    for (unsigned byte = 0; byte < field->bits; byte += 8) other = other << 8 | (value >> byte & 0xff);
    return other;
  };
  size_t counts = 0;
  for (size_t i = 1; i < reports.size(); ++i)
    counts += swapped(reports[i]->state.sequence) - swapped(reports[i - 1]->state.sequence) == 1 ? 1 : 0;
  if (10 * counts < 9 * (reports.size() - 1)) return "";
  return std::string("the counter counts with endian: ") + (field->big_endian ? "little" : "big") + "\n";
}

/// Returns the advice to give a rate, or why it cannot be given.
std::string rateToGive(double measured) {
  char text[160];
  if (measured < codec::kLeastRate || measured > codec::kMostRate)
    std::snprintf(text, sizeof text,
                  "a rate must be %g to %g Hz: are the times of the capture in s, and of every report?",
                  codec::kLeastRate, codec::kMostRate);
  else
    std::snprintf(text, sizeof text, "give rate: %.0f if this is how the arm sends", measured);
  return text;
}

/// Compares wire.rate with the times in the capture. The median counts, because a pause in a recording says nothing
/// about the arm.
std::string rate(const codec::Wire& wire, const DecodedReports& reports, double least_rate) {
  std::vector<double> between;
  for (size_t i = 1; i < reports.size(); ++i)
    if (reports[i - 1]->time >= 0 && reports[i]->time >= reports[i - 1]->time)
      between.push_back(reports[i]->time - reports[i - 1]->time);
  if (between.size() < kFewestReports || wire.exchange == codec::Exchange::kPoll) return "";
  std::nth_element(between.begin(), between.begin() + static_cast<long>(between.size() / 2), between.end());
  const double period = between[between.size() / 2];
  if (!(period > 0)) return "";  // several reports came together
  const double measured = 1 / period;
  if (measured > 0.75 * wire.rate && measured < 1.5 * wire.rate) return "";
  char text[400];
  std::snprintf(text, sizeof text,
                "the reports are %.3g s apart (median), which is a rate of %s Hz, and wire.rate is %g%s; %s\n", period,
                shortNumber(measured).c_str(), wire.rate,
                measured < least_rate * wire.rate ? ": at so low a rate (health.least_rate) no torque goes out" : "",
                rateToGive(measured).c_str());
  return text;
}

/// Compares the arm's own clock with wire.rate, because one of the two may be in other units.
std::string clock(const codec::Wire& wire, const DecodedReports& reports) {
  if (!wire.input.has(Role::kTime) || wire.exchange == codec::Exchange::kPoll || !(wire.rate > 0)) return "";
  std::vector<double> between;
  for (size_t i = 1; i < reports.size(); ++i)
    if (reports[i]->state.clock > reports[i - 1]->state.clock)  // a clock that restarts is left out
      between.push_back(reports[i]->state.clock - reports[i - 1]->state.clock);
  if (between.size() < kFewestReports) return "";
  std::nth_element(between.begin(), between.begin() + static_cast<long>(between.size() / 2), between.end());
  const double period = between[between.size() / 2], times = period * wire.rate;
  constexpr double kFast = 0.67, kSlow = 1.34;
  if (times > kFast && times < kSlow) return "";
  const bool allowed = 1 / period >= codec::kLeastRate && 1 / period <= codec::kMostRate;
  char give[48] = "", text[320];
  if (allowed) std::snprintf(give, sizeof give, "rate: %.0f, or ", 1 / period);
  std::snprintf(text, sizeof text,
                "the arm's clock grows by %.3g s from one report to the next (median), and wire.rate %g means one "
                "report each %.3g s; give %sa scale of the field time that is %.4g times %s\n",
                period, wire.rate, 1 / wire.rate, give, times > 1 ? times : 1 / times,
                times > 1 ? "smaller" : "larger");
  return text;
}

}  // namespace

std::string timeSeriesHints(const codec::Wire& wire, const Decoded& decoded, double least_rate) {
  const DecodedReports reports = goodOnes(decoded);
  if (reports.size() < kFewestReports) return "";
  return flags(wire, reports) + starts(wire, reports) + counter(wire, decoded, reports) +
         rate(wire, reports, least_rate) + clock(wire, reports);
}

}  // namespace hapticd::capture
