// SPDX-License-Identifier: MIT
/// Finds out which functions a piece of work enters: it sets a breakpoint at the entry of each function and removes it
/// when it is reached. So a test can prove, without a clock, that the code that ships does not compute something.
#pragma once
#include <set>
#include <string>

namespace hapticd::test {

/// The functions that were entered. On processors other than x86-64, and with a sanitizer, this is not possible: then
/// kPossible is false and the set is empty.
class Census {
 public:
#if defined(__x86_64__) && !defined(HAPTICD_SANITIZED)
  static constexpr bool kPossible = true;
#else
  static constexpr bool kPossible = false;
#endif

  /// Runs the work in this thread, and records the functions of namespace hapticd that it enters. Inlined functions are
  /// not seen.
  template <class Work>
  static Census of(Work&& work) {
    begin();
    work();
    return end();
  }

  /// True if a function with `part` in its name was entered. @param object part of the file name of the program or
  /// library that contains the function
  bool ran(const std::string& object, const std::string& part) const { return !text(object, part).empty(); }
  /// Returns the functions for messages, one line "object function" each.
  std::string text(const std::string& object = "", const std::string& part = "") const;

 private:
  static void begin();
  static Census end();
  std::set<std::string> functions_;  ///< "object function"
};

}  // namespace hapticd::test
