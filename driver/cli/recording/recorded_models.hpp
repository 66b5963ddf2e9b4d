// SPDX-License-Identifier: MIT
/// Builds the models of a recording again, so that they can be drawn. It answers `list` and `geometry` as the daemon
/// would, on a control socket in a temporary folder.
#pragma once
#include <memory>
#include <string>

#include "base/result.hpp"

namespace hapticd::cli {

class RecordedModels {
 public:
  /// [main] Builds all models that can be built. Requests for a model whose plugin or files no longer exist are
  /// answered with the reason.
  static Result<std::unique_ptr<RecordedModels>> serve(const std::string& recording);
  virtual ~RecordedModels() = default;  ///< also removes the folder
  RecordedModels() = default;
  RecordedModels(const RecordedModels&) = delete;
  RecordedModels& operator=(const RecordedModels&) = delete;

  virtual const std::string& socket() const = 0;
};

}  // namespace hapticd::cli
