// SPDX-License-Identifier: MIT
/// What one program of Haply's interface hears and says: an inventory first, then one state for each of its messages.
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
  /// [main] Connects to a daemon. @param number of this session
  static Result<std::unique_ptr<Session>> open(const std::string& daemon, int number);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// [main] The first message. "" if the daemon reports nothing any more
  std::string inventory();
  /// [main] The answer to a message. "" if the daemon reports nothing any more
  std::string answer(const std::string& message);
  /// [main] What was asked for but is impossible, reported once; "" if there is nothing new.
  std::string complaint();

 private:
  Session(hapticd_client* client, int number) : client_(client), number_(number) {}
  void obey(const nlohmann::json& message);
  void obeyArm(Arm& arm, const nlohmann::json& commands);
  void complain(const std::string& what);
  std::string tell(bool all);

  hapticd_client* client_;
  int number_;
  std::vector<std::unique_ptr<Arm>> arms_;
  Basis basis_;
  std::string complaint_;
  bool complained_ = false;
};

}  // namespace hapticd::haply
