// SPDX-License-Identifier: MIT
/// The models of a recording, built again to be drawn: answers `list` and `geometry` as the daemon would, on a socket
/// of its own in a folder of its own.
#pragma once
#include <memory>
#include <string>

#include "base/result.hpp"

namespace hapticd::cli {

class RecordedModels {
 public:
  /// [main] Builds what can be built. A model whose plugin or files no longer exist here is answered with the reason.
  static Result<std::unique_ptr<RecordedModels>> serve(const std::string& recording);
  virtual ~RecordedModels() = default;  ///< the folder is removed too
  RecordedModels() = default;
  RecordedModels(const RecordedModels&) = delete;
  RecordedModels& operator=(const RecordedModels&) = delete;

  virtual const std::string& socket() const = 0;
};

}  // namespace hapticd::cli
