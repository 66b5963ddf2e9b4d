/// Carries out requests from the control socket: looks up, prepares on its own thread, gives orders to the servo, waits
/// until they are obeyed. Nothing here runs in the servo thread.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "control/request.hpp"
#include "servo/runner.hpp"

namespace hapticd::servo {

class Steward {
 public:
  /// Loads a scene file with everything it names.
  using LoadScene = std::function<Result<scene::Scene>(const std::string& file)>;

  /// [main] @param dump_folder where black boxes are written
  Steward(Runner& runner, LoadScene load, host::Services::Log log, std::string dump_folder);

  /// [any] One thread at a time. A line of JSON for a line of JSON.
  std::string answer(const std::string& line);

  /// [any] The same thread. Writes the black box. @return the file
  Result<std::string> dump(const std::string& why);

 private:
  struct Place {
    scene::Model model;
    bool taken = false, enabled = true;
  };
  Result<std::string> obey(const control::Request& request);
  std::string status() const;
  std::string list() const;
  Result<uint32_t> placeOf(const std::string& model) const;
  Result<void> give(Order order);
  Result<void> able(const std::string& model, bool enabled);
  Result<void> set(const control::Request& request);
  Result<std::string> move(const control::Request& request);
  Result<void> arms(const std::string& device, Order::Kind kind);
  Result<std::string> add(const control::Request& request);
  Result<void> adopt(const std::vector<scene::Model>& models);
  Result<void> release(uint32_t place);
  Result<std::string> reload(const std::string& file);
  void sweep();

  Runner& runner_;
  LoadScene load_;
  host::Services::Log log_;
  std::string dump_folder_, scene_file_;
  std::vector<Place> places_;
  std::vector<std::unique_ptr<ModelState>> prepared_;  ///< given to the servo and not yet taken
  uint64_t given_ = 0;
};

}  // namespace hapticd::servo
