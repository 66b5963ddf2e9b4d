// SPDX-License-Identifier: MIT
#include "capture/plausible.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/short_number.hpp"
#include "capture/alternative_decoding.hpp"
#include "capture/byte_order_hint.hpp"

namespace hapticd::capture {
namespace {

/// The positions of one joint in all good reports.
struct JointSeries {
  std::vector<double> at;
  double least = HUGE_VAL, most = -HUGE_VAL;
  double count_size = 0;  ///< [rad] one count of a whole-number type; 0 for other types

  /// @param round [rad] range after which the number starts again; 0 if it never does
  void add(double q, double round) {
    if (round > 0 && !at.empty()) q += std::round((at.back() - q) / round) * round;
    at.push_back(q);
    least = std::min(least, q), most = std::max(most, q);
  }
  template <class Test>
  size_t count(const Test& test) const {
    size_t found = 0;
    for (size_t i = 1; i < at.size(); ++i) found += test(at[i - 1], at[i]) ? 1 : 0;
    return found;
  }
};

std::string number(double value) {
  return withDigits(value, 3);
}

Stops stopsOf(const ArmFacts& arm, size_t joint) {
  if (arm.limits.size() != 2 * arm.joints) return {};
  return {true, !arm.zeroed, arm.limits[2 * joint], arm.limits[2 * joint + 1]};
}

/// Returns a text if the joint goes beyond its stops. If its zero is not known yet, returns a text if its positions
/// span more than the range between them. @param has_offset true if the file gives an offset
std::string beyondStops(const JointSeries& course, const Stops& stops, bool has_offset) {
  constexpr double kTurns = 4 * M_PI;  // a joint with stops cannot make two turns
  const double way = course.most - course.least;
  if (stops.given ? !leavesStops(course.at, stops) : way <= kTurns * 1.1) return "";
  if (stops.placed && way <= stops.high - stops.low)
    return "from " + number(course.least) + " to " + number(course.most) + " rad, and arm.limits are " +
           number(stops.low) + " to " + number(stops.high) + " rad: its range of " + number(way) +
           " rad fits between them, but it is shifted: " +
           (has_offset ? "is offset in rad (for degrees: offset_degrees), with the right sign?"
                       : "expected an offset, or the other signedness of its type");
  return "from " + number(course.least) + " to " + number(course.most) + " rad, " +
         (stops.placed  ? "and arm.limits are " + number(stops.low) + " to " + number(stops.high) + " rad"
          : stops.given ? "farther than the " + number(stops.high - stops.low) + " rad between its arm.limits"
                        : "more than two turns") +
         ": is scale in rad (for degrees: scale_degrees), with the turns of the motor in one turn of the joint?";
}

std::string jumps(const JointSeries& course, const codec::Wire& wire, const ArmFacts& arm) {
  constexpr double kLarge = 0.5;  // [rad] a smaller step is never called a jump
  // a few reports may be missing in between
  const double most = std::max(kLarge, 5 * arm.max_speed / std::max(wire.rate, 1.0));
  double largest = 0;
  const size_t count = course.count([&](double from, double to) {
    largest = std::max(largest, std::abs(to - from));
    return std::abs(to - from) > most;
  });
  if (count < 3 || count * 50 < course.at.size()) return "";
  // If only the scale is too large, the whole span is much larger than these steps.
  if (4 * largest < course.most - course.least) return "";
  return "jumps by up to " + number(largest) + " rad from one report to the next, " + std::to_string(count) +
         " times: look at its byte order (endian), its first byte (at), and the sign and width of its type";
}

/// Returns a text if positions that wrap span more than the range between the stops. Their zero is unknown.
std::string tooLongAWay(const JointSeries& course, Stops stops) {
  stops.placed = false;
  if (!stops.given || course.at.empty() || !leavesStops(course.at, stops)) return "";
  const double way = course.most - course.least, room = stops.high - stops.low;
  return "moves over " + number(way) + " rad, but its arm.limits are only " + number(room) +
         " rad apart: scale is at least " + number(way / room) +
         " times too large: is it in rad (for degrees: scale_degrees), "
         "with the turns of the motor in one turn of the joint?";
}

/// [rad] The greatest motion of a joint that is called tiny although its number changed by many counts, where its stops
/// are unknown.
constexpr double kTiny = 0.02;

/// Returns true if the number of a joint changed by more counts than an encoder's noise makes.
bool countedFar(const JointSeries& course) {
  constexpr double kCounts = 500;
  return course.count_size > 0 && course.most - course.least > kCounts * course.count_size;
}

/// Returns a text if every joint's number changed by many counts, but no joint moved far, where the stops are unknown.
std::string tinyWays(const std::map<size_t, JointSeries>& courses) {
  double widest = 0;
  for (const auto& [joint, course] : courses) {
    if (!countedFar(course) || course.most - course.least > kTiny) return "";
    widest = std::max(widest, course.most - course.least);
  }
  if (courses.empty()) return "";
  return "the numbers of all joints changed by more than 500 counts, but no joint moved by more than " +
         number(widest) +
         " rad: if they were moved by hand, scale is far too small; "
         "it must be in rad: 2 pi / (counts of a motor turn * motor turns of one joint turn)\n";
}

/// Returns a text if all joints moved, but none of them far, because a scale that is too small has no other symptom.
std::string shortWays(const std::map<size_t, JointSeries>& courses, const ArmFacts& arm) {
  // shares of the range between the stops: kMoved tells whether a joint moved at all, kShort whether it moved far
  constexpr double kShort = 0.4, kMoved = 0.01;
  constexpr size_t kEnough = 100;  // [reports] least number to judge a joint
  std::string ways;
  double widest = 0;
  for (const auto& [joint, course] : courses) {
    const Stops stops = stopsOf(arm, joint);
    if (course.at.size() < kEnough) return "";
    if (!stops.given) return tinyWays(courses);
    const double part = (course.most - course.least) / (stops.high - stops.low);
    if (!(part > kMoved || countedFar(course)) || !(part < kShort)) return "";
    widest = std::max(widest, part);
    ways += (ways.empty() ? "" : ", ") + number(100 * part) + " %";
  }
  if (ways.empty()) return "";
  return "nothing is wrong if the joints were not moved from stop to stop: they moved over " + ways +
         " of the distance between their arm.limits; if they were moved from stop to stop, scale is about " +
         number(1 / widest) + " times too small (a turn of an encoder has 4 counts for each of its lines)\n";
}

/// Returns what is wrong with one joint; "" if nothing is.
std::string implausibleSeries(const codec::Wire& wire, const codec::Field& field, const ArmFacts& arm,
                              const JointSeries& course) {
  const Stops stops = stopsOf(arm, field.index);
  std::string wrong = alternativeDecoding(field, course.at, stops);
  if (wrong.empty()) wrong = jumps(course, wire, arm);
  return wrong.empty() ? beyondStops(course, stops, field.offset != 0) : wrong;
}

}  // namespace

std::string implausible(const codec::Wire& wire, const ArmFacts& arm, const Decoded& decoded) {
  std::string text;
  std::map<size_t, JointSeries> courses;
  for (const codec::Field& field : wire.input.fields) {
    if (field.role != codec::Role::kPosition || field.index >= arm.joints) continue;
    JointSeries& course = courses[field.index];
    const bool whole = field.type == codec::Type::kUnsigned || field.type == codec::Type::kSigned;
    course.count_size = whole ? std::abs(field.scale) : 0;
    const double round = field.wraps ? std::ldexp(std::abs(field.scale), field.bits) : 0;
    for (const DecodedReport& report : decoded.reports)
      if (report.verdict == codec::Verdict::kGood) course.add(report.state.position[field.index], round);
    std::string wrong = wrongByteOrder(field, course.at);
    if (wrong.empty())
      wrong =
          field.wraps ? tooLongAWay(course, stopsOf(arm, field.index)) : implausibleSeries(wire, field, arm, course);
    if (!wrong.empty()) text += "joint " + std::to_string(field.index + 1) + ": " + wrong + "\n";
  }
  return text.empty() ? shortWays(courses, arm) : text;
}

}  // namespace hapticd::capture
