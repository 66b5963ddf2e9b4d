// SPDX-License-Identifier: MIT
/// Shows the progress of an import on a terminal, and limits the time of its single steps.
#pragma once
#include <Message_ProgressIndicator.hxx>
#include <chrono>
#include <string>

namespace hapticd::cad {

/// Open CASCADE calls this object while it works. The object shows the progress, and stops the work after a given time.
class Progress : public Message_ProgressIndicator {
 public:
  /// @param what name of the step, for the terminal @param seconds time after which the step is stopped; 0 means no
  /// limit
  explicit Progress(std::string what, double seconds = 0);
  ~Progress() override;
  Standard_Boolean UserBreak() override;
  /// True if the time limit ended the step.
  bool late() const { return late_; }

 protected:
  void Show(const Message_ProgressScope& scope, const Standard_Boolean force) override;

 private:
  std::string what_;
  std::chrono::steady_clock::time_point end_, shown_;
  bool limited_ = false, late_ = false, terminal_ = false, drawn_ = false;
};

}  // namespace hapticd::cad
