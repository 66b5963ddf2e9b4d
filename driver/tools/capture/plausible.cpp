// SPDX-License-Identifier: MIT
#include "capture/plausible.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hapticd::capture {
namespace {

/// The positions of one joint in all good reports.
struct Course {
  std::vector<double> at;
  double least = HUGE_VAL, most = -HUGE_VAL;

  void add(double q) {
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
  char text[24];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Beyond its stops, or, where its zero is not known yet, over a longer way than between them.
std::string beyondStops(const Course& course, const ArmFacts& arm, size_t joint) {
  constexpr double kTurns = 4 * M_PI;  // no joint with stops makes two turns
  const bool given = arm.limits.size() == 2 * arm.joints;
  const double low = given ? arm.limits[2 * joint] : 0, high = given ? arm.limits[2 * joint + 1] : kTurns;
  const double room = 0.05 * (high - low);  // a stop gives way
  const bool placed = given && !arm.zeroed;
  const bool beyond = placed ? course.least < low - room || course.most > high + room
                             : course.most - course.least > high - low + 2 * room;
  if (!beyond) return "";
  return "from " + number(course.least) + " to " + number(course.most) + " rad, " +
         (placed  ? "and arm.limits are " + number(low) + " to " + number(high) + " rad"
          : given ? "a way of more than the " + number(high - low) + " rad between its arm.limits"
                  : "more than two turns") +
         ": is scale in rad (for degrees: scale_degrees), with the turns of the motor in one turn of the joint?";
}

std::string jumps(const Course& course, const codec::Wire& wire, const ArmFacts& arm) {
  constexpr double kLarge = 0.5;                                                       // [rad]
  const double most = std::max(kLarge, 5 * arm.max_speed / std::max(wire.rate, 1.0));  // a few may be missing between
  double largest = 0;
  const size_t count = course.count([&](double from, double to) {
    largest = std::max(largest, std::abs(to - from));
    return std::abs(to - from) > most;
  });
  if (count < 3 || count * 50 < course.at.size()) return "";
  // A scale that is too large makes small jumps large, on a way that is larger still.
  if (4 * largest < course.most - course.least) return "";
  return "jumps by up to " + number(largest) + " rad from one report to the next, " + std::to_string(count) +
         " times: look at its byte order (endian), its first byte (at), and the sign and width of its type";
}

}  // namespace

std::string implausible(const codec::Wire& wire, const ArmFacts& arm, const Decoded& decoded) {
  std::string text;
  for (const codec::Field& field : wire.input.fields) {
    if (field.role != codec::Role::kPosition || field.wraps || field.index >= arm.joints) continue;
    Course course;
    for (const DecodedReport& report : decoded.reports)
      if (report.verdict == codec::Verdict::kGood) course.add(report.state.position[field.index]);
    std::string wrong = jumps(course, wire, arm);
    if (wrong.empty()) wrong = beyondStops(course, arm, field.index);
    if (!wrong.empty()) text += "joint " + std::to_string(field.index + 1) + ": " + wrong + "\n";
  }
  return text;
}

}  // namespace hapticd::capture
