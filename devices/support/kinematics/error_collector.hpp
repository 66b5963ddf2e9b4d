// SPDX-License-Identifier: MIT
/// Collects all problems in the parameters of an arm, so that the user sees them at once.
#pragma once
#include <stdexcept>
#include <string>

namespace hapticd::kinematics {

class ErrorCollector {
 public:
  /// [main] Calls `part`, and notes the message of a std::invalid_argument that it throws.
  template <class Part>
  void attempt(const Part& part) {
    try {
      part();
    } catch (const std::invalid_argument& e) {
      add(e.what());
    }
  }
  void add(const std::string& what) { all_ += (all_.empty() ? "" : "\n") + what; }
  bool empty() const { return all_.empty(); }
  /// [main] Throws std::invalid_argument with all messages, one per line, if there are any.
  void check() const {
    if (!all_.empty()) throw std::invalid_argument(all_);
  }

 private:
  std::string all_;
};

}  // namespace hapticd::kinematics
