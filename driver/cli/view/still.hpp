// SPDX-License-Identifier: MIT
/// Models that are looked at without a run: of a part, a model file, a scene, or a CAD file, mesh or
/// patches.
#pragma once
#include <memory>
#include <string>

#include "cli/support/scratch_folder.hpp"

namespace hapticd::cli {

class Still {
 public:
  /// [main] True if the file is shown at rest: by its name, anything but a recording.
  static bool is(const std::string& file);

  /// [main] Reads the file and writes a recording of it that has no arm and no tick. Prints what is wrong.
  /// @param scale factor on the lengths of a file that has to be imported, as in `hapticd import`
  /// @param exit_code receives the exit code if the result is nullptr
  static std::unique_ptr<Still> of(const std::string& file, double scale, int& exit_code);

  /// Returns the file of the recording, which is removed with this object.
  std::string recording() const { return folder_.path() + "/still.h5"; }
  /// Returns the command with which the file is felt.
  const std::string& command() const { return command_; }

 private:
  explicit Still(ScratchFolder folder) : folder_(std::move(folder)) {}
  int read(const std::string& file, double scale);

  ScratchFolder folder_;
  std::string command_;
};

}  // namespace hapticd::cli
