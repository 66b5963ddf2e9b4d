// SPDX-License-Identifier: MIT
/// The verdict of a conformance test.
#pragma once
#include <cstdint>
#include <string>
#include <utility>

namespace hapticd::conformance {

/// What a test found. A text converts to a verdict: an objection fails the test, and no text passes it.
struct Verdict {
  enum class Kind : uint8_t {
    kPassed,   ///< passed; a text then says what was measured
    kSkipped,  ///< the test does not apply, and the text says why
    kWarned,   ///< passed with a remark
    kFailed    ///< the text says what is wrong
  };

  Kind kind = Kind::kPassed;
  std::string text;

  Verdict(std::string objection)  // NOLINT(google-explicit-constructor): most tests end with their objection
      : kind(objection.empty() ? Kind::kPassed : Kind::kFailed), text(std::move(objection)) {}
  Verdict(const char* objection) : Verdict(std::string(objection)) {}  // NOLINT(google-explicit-constructor): see above
  Verdict(Kind of, std::string words) : kind(of), text(std::move(words)) {}

  bool failed() const { return kind == Kind::kFailed; }
  /// True if the test passed and there is nothing to say.
  bool clean() const { return kind == Kind::kPassed && text.empty(); }
};

inline Verdict skipped(std::string why) {
  return {Verdict::Kind::kSkipped, std::move(why)};
}
inline Verdict warned(std::string what) {
  return {Verdict::Kind::kWarned, std::move(what)};
}
/// The test passed, and `what` was measured.
inline Verdict noted(std::string what) {
  return {Verdict::Kind::kPassed, std::move(what)};
}

/// Writes a verdict as text, to pass it from a child process to its parent, and reads it back.
inline std::string toText(const Verdict& verdict) {
  return static_cast<char>('0' + static_cast<int>(verdict.kind)) + verdict.text;
}
inline Verdict verdictFromText(const std::string& text) {
  const int kind = text.empty() ? -1 : text.front() - '0';
  if (kind < 0 || kind > static_cast<int>(Verdict::Kind::kFailed)) return "the test gave no verdict";
  return {static_cast<Verdict::Kind>(kind), text.substr(1)};
}

}  // namespace hapticd::conformance
