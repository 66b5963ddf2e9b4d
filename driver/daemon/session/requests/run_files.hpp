// SPDX-License-Identifier: MIT
/// The files by which other programs find a run: status page, black box and control socket, in one folder under one
/// name.
#pragma once
#include <memory>
#include <string>

#include "control/server.hpp"
#include "host/catalog.hpp"
#include "session/requests/request_handler.hpp"
#include "session/run/runner.hpp"

namespace hapticd::servo {

class RunFiles {
 public:
  /// [main] Chooses folder and name, saves a black box that a crash left, and fills in the options of the run. If there
  /// is no folder, it logs a warning, and the run has no such files. @param name of the run; "" means "hapticd", or, if
  /// another run has this name, "hapticd-" and the number of the process. If another run has any other given name, that
  /// is an error.
  static Result<std::unique_ptr<RunFiles>> open(const std::string& name, RunOptions& how);
  ~RunFiles();  ///< [main] frees the name
  RunFiles(const RunFiles&) = delete;
  RunFiles& operator=(const RunFiles&) = delete;

  /// [main] Opens the socket and serves it. If that fails, it logs a warning, and the run continues.
  /// @param load loads the scenes that programs name during the run
  /// @param catalog finds the plugins of these scenes
  /// @param advise gives warnings about models that are added
  void serve(Runner& runner, const RequestHandler::LoadScene& load, host::Catalog& catalog,
             RequestHandler::Advise advise, const host::Services::Log& log);

  /// [main] Called a few times per second: dumps the black box once after each new fault.
  void look();

  const std::string& name() const { return name_; }  ///< [main] name of the run; "" if it has no files

  void end();  ///< [main] called after the run: ends requests and removes files

 private:
  RunFiles() = default;
  Result<bool> take(const std::string& name);
  Result<bool> takeOrWait(const std::string& name);
  bool faulty() const;
  std::string folder_, name_, lock_file_;
  int lock_ = -1;  ///< descriptor of the file lock on the name, held until the end
  Runner* runner_ = nullptr;
  std::unique_ptr<RequestHandler> handler_;
  std::unique_ptr<control::Server> server_;
  bool dumped_ = false, ended_ = false;
};

}  // namespace hapticd::servo
