// SPDX-License-Identifier: MIT
/// Logs what a command waits for while a plugin takes long to set up a model. A large model may need minutes, and a
/// faulty plugin never returns. It hears of the calls that a World makes; without such a line nobody could know
/// what the command does.
#pragma once
#include <condition_variable>
#include <mutex>
#include <string>

#include "base/os.hpp"
#include "description/scene.hpp"
#include "host/services.hpp"

namespace hapticd::servo {

class SetupWatch {
 public:
  /// [main] @param log gets the lines, from another thread  @param first_s [s] time after which the first line comes;
  /// each further one comes after twice the time of the one before  @param advice what a user can do
  explicit SetupWatch(host::Services::Log log, double first_s = 10,
                      std::string advice = "a large model may need long; to end it: Ctrl-C");
  ~SetupWatch();  ///< [main]
  SetupWatch(const SetupWatch&) = delete;
  SetupWatch& operator=(const SetupWatch&) = delete;

 private:
  void enters(const scene::Model* model, const char* call);
  void loop();

  const host::Services::Log log_;
  const double first_s_;
  const std::string advice_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string model_, plugin_;
  const char* call_ = "";
  uint64_t calls_ = 0;
  bool ended_ = false;
  os::Thread thread_;  // last, because it uses the others
};

}  // namespace hapticd::servo
