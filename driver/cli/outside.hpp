/// What a run shows to the outside: status page, black box file and control socket, in one folder under one name.
#pragma once
#include <memory>
#include <string>

#include "control/server.hpp"
#include "servo/runner.hpp"
#include "servo/steward.hpp"

namespace hapticd::cli {

class Outside {
 public:
  /// [main] Chooses folder and name, keeps a black box that a crash left, and fills in the options of the run. Without
  /// a folder that is a warning: the run goes on unseen. @param name "": "hapticd", or one with the process's number
  /// where that is taken; any other that is taken is an error
  static Result<std::unique_ptr<Outside>> open(const std::string& name, servo::RunOptions& how);
  ~Outside();  ///< [main] the name is free again
  Outside(const Outside&) = delete;
  Outside& operator=(const Outside&) = delete;

  /// [main] Serves the socket. A failure is a warning: the run goes on.
  void serve(servo::Runner& runner, const std::string& device_file);

  /// [main] Called now and then: writes the black box once after each new fault.
  void look();

  void end();  ///< [main] after the run: no more requests, no more files

 private:
  Outside() = default;
  Result<bool> take(const std::string& name);
  bool faulty() const;
  std::string folder_, name_, lock_file_;
  int lock_ = -1;  ///< descriptor of the lock on the name, held until the end
  servo::Runner* runner_ = nullptr;
  std::unique_ptr<servo::Steward> steward_;
  std::unique_ptr<control::Server> server_;
  bool dumped_ = false;
};

}  // namespace hapticd::cli
