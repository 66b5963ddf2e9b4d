// SPDX-License-Identifier: MIT
/// Truth cases: a family of cases is a function that computes each with the production kernels and checks the answers.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace hapticd::verify {

using Json = nlohmann::json;

/// One case of a file: {id, family, desc, input, expect, tol, truth}.
struct Case {
  std::string id, family;
  Json input, expect, tol;
};

/// An expected number: a decimal string of up to 30 digits, or a plain number. Kept in long double, so that rounding
/// the string costs nothing against the tolerances.
inline long double truth(const Json& value) {
  if (!value.is_string()) return static_cast<long double>(value.get<double>());
  const std::string text = value.get<std::string>();
  char* end = nullptr;
  const long double number = std::strtold(text.c_str(), &end);  // unlike stold it takes subnormal numbers
  if (end == text.c_str() || *end != '\0') throw std::invalid_argument("\"" + text + "\" is not a number");
  return number;
}

/// A tolerance or other number that may be written as a string.
inline double number(const Json& value) {
  return static_cast<double>(truth(value));
}

inline Eigen::Vector3d vector(const Json& value) {
  return {number(value[0]), number(value[1]), number(value[2])};
}

/// Gathers the comparisons of one case.
class Check {
 public:
  /// |got - expected| <= tolerance; not-a-number fails.
  void near(const std::string& name, double got, const Json& expected, double tolerance) {
    compare(name, std::fabs(static_cast<long double>(got) - truth(expected)), tolerance);
  }
  /// The same relative to |expected|; for expected 0 the tolerance is absolute.
  void relative(const std::string& name, double got, const Json& expected, double tolerance) {
    const long double scale = std::fabs(truth(expected));
    near(name, got, expected, tolerance * static_cast<double>(scale > 0 ? scale : 1));
  }
  /// Every component of a vector; `got` has operator[].
  template <class Vector>
  void nearVector(const std::string& name, const Vector& got, const Json& expected, double tolerance) {
    for (size_t i = 0; i < expected.size(); ++i)
      near(name + "[" + std::to_string(i) + "]", got[static_cast<int>(i)], expected[i], tolerance);
  }
  void isTrue(const std::string& name, bool holds) {
    if (!holds) fail(name);
  }
  void fail(const std::string& why) {
    if (failure_.empty()) failure_ = why;
    worst_ = HUGE_VALL;
  }

  bool passed() const { return failure_.empty(); }
  const std::string& failure() const { return failure_; }
  long double worst() const { return worst_; }  ///< largest error divided by its tolerance
  size_t comparisons() const { return comparisons_; }

 private:
  void compare(const std::string& name, long double error, double tolerance) {
    ++comparisons_;
    const long double ratio = error == 0 ? 0 : error / static_cast<long double>(tolerance);
    if (!(ratio <= 1)) {
      char text[96];
      std::snprintf(text, sizeof text, ": error %.3Lg, tolerance %.3g", error, tolerance);
      if (failure_.empty()) failure_ = name + text;
    }
    if (!(ratio <= worst_)) worst_ = ratio;
  }
  std::string failure_;
  long double worst_ = 0;
  size_t comparisons_ = 0;
};

using Family = void (*)(const Case&, Check&);

/// Families by name; filled by HAPTICD_VERIFY before main().
inline std::map<std::string, Family>& families() {
  static std::map<std::string, Family> all;
  return all;
}

struct Registration {
  Registration(const char* name, Family family) { families()[name] = family; }
};

}  // namespace hapticd::verify

/// HAPTICD_VERIFY(family, function): `function(const Case&, Check&)` answers the cases of that family.
#define HAPTICD_VERIFY(family, function) \
  static const ::hapticd::verify::Registration registration_##family(#family, function);
