// SPDX-License-Identifier: MIT
/// Which functions a piece of work runs: a breakpoint at the entry of each, taken away when it is reached. So a test
/// can prove that something is not computed, in the very code that ships, without a clock.
#pragma once
#include <set>
#include <string>

namespace hapticd::test {

/// Where it cannot look (another processor, a sanitizer), kPossible is false and everything is empty.
class Census {
 public:
#if defined(__x86_64__) && !defined(HAPTICD_SANITIZED)
  static constexpr bool kPossible = true;
#else
  static constexpr bool kPossible = false;
#endif

  /// Runs the work in this thread and notes the functions of namespace hapticd that it enters, inlined ones excepted.
  template <class Work>
  static Census of(Work&& work) {
    begin();
    work();
    return end();
  }

  /// A function of an object (part of its file name) was entered that has `part` in its name.
  bool ran(const std::string& object, const std::string& part) const { return !text(object, part).empty(); }
  /// For messages: "object function", a line each.
  std::string text(const std::string& object = "", const std::string& part = "") const;

 private:
  static void begin();
  static Census end();
  std::set<std::string> functions_;  ///< "object function"
};

}  // namespace hapticd::test
