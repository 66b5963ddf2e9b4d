// SPDX-License-Identifier: MIT
/// The connection to one program that uses Haply's interface. The program first receives an inventory, then one state
/// for each message that it sends.
#pragma once
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "arm.hpp"
#include "basis.hpp"

namespace hapticd::haply {

class Session {
 public:
  /// [main] Connects to a daemon. @param number number of this session
  static Result<std::unique_ptr<Session>> open(const std::string& daemon, int number);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// [main] Returns the first message, or "" if the daemon reports no more ticks.
  std::string inventory();
  /// [main] Returns the answer to a message, or "" if the daemon reports no more ticks.
  std::string answer(const std::string& message);
  /// [main] Returns a message about a request of the program that cannot be met, or "". Each problem is returned once.
  std::string takeProblem();

 private:
  Session(hapticd_client* client, int number) : client_(client), number_(number) {}
  void execute(const nlohmann::json& message);
  void executeForArm(Arm& arm, const nlohmann::json& commands);
  void noteProblem(const std::string& what);
  std::string stateMessage(bool all);

  hapticd_client* client_;
  int number_;
  std::vector<std::unique_ptr<Arm>> arms_;
  Basis basis_;
  std::string complaint_;
  bool complained_ = false;
};

}  // namespace hapticd::haply
