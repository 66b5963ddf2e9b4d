// SPDX-License-Identifier: MIT
/// What a run shows to the outside: status page, black box file and control socket, in one folder under one name.
#pragma once
#include <memory>
#include <string>

#include "control/server.hpp"
#include "host/catalog.hpp"
#include "session/request_handler.hpp"
#include "session/runner.hpp"

namespace hapticd::servo {

class RunFiles {
 public:
  /// [main] Chooses folder and name, keeps a black box that a crash left, and fills in the options of the run. Without
  /// a folder it only warns: the run goes on unseen. @param name "": "hapticd", or one with the process's number where
  /// that is taken; any other that is taken is an error
  static Result<std::unique_ptr<RunFiles>> open(const std::string& name, RunOptions& how);
  ~RunFiles();  ///< [main] the name is free again
  RunFiles(const RunFiles&) = delete;
  RunFiles& operator=(const RunFiles&) = delete;

  /// [main] Serves the socket. If that fails it only warns: the run goes on.
  /// @param device_file replaces the devices of scenes that are loaded meanwhile  @param catalog finds their plugins
  /// @param advise warnings about models that come
  void serve(Runner& runner, const std::string& device_file, host::Catalog& catalog, RequestHandler::Advise advise,
             const host::Services::Log& log);

  /// [main] Called now and then: writes the black box once after each new fault.
  void look();

  const std::string& name() const { return name_; }  ///< [main] path of the run's socket; "": it has none

  void end();  ///< [main] called after the run: ends requests and removes files

 private:
  RunFiles() = default;
  Result<bool> take(const std::string& name);
  Result<bool> takeOrWait(const std::string& name);
  bool faulty() const;
  std::string folder_, name_, lock_file_;
  int lock_ = -1;  ///< descriptor of the lock on the name, held until the end
  Runner* runner_ = nullptr;
  std::unique_ptr<RequestHandler> handler_;
  std::unique_ptr<control::Server> server_;
  bool dumped_ = false, ended_ = false;
};

}  // namespace hapticd::servo
