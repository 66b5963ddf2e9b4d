// SPDX-License-Identifier: MIT
/// Carries out requests from the control socket: answers questions, prepares models on its own thread, gives orders to
/// the servo, and waits until they are obeyed. Nothing here runs in the servo thread.
#pragma once
#include <atomic>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/passed_files.hpp"
#include "base/result.hpp"
#include "control/request.hpp"
#include "control/server.hpp"
#include "session/requests/answers.hpp"
#include "session/requests/leads.hpp"
#include "session/run/runner.hpp"

namespace hapticd::servo {

class RequestHandler {
 public:
  /// Loads a scene file with all files that it names.
  using LoadScene = std::function<Result<scene::Scene>(const std::string& file)>;
  /// Returns warnings about the models in a scene. @param stiffness [N/m] stiffness that each model claims
  using Advise =
      std::function<std::vector<std::string>(const scene::Scene& models, const std::vector<double>& stiffness)>;

  /// [main] @param dump_folder folder for dumps of the black box
  RequestHandler(Runner& runner, LoadScene load, host::Services::Log log, std::string dump_folder);

  /// [main] Called before the first request: sets the name and the socket that `status` reports.
  void knownAs(const std::string& name, const std::string& socket) { name_ = name, socket_ = socket; }
  /// [main] Called before the first request: sets the function for warnings about added models; empty for no warnings.
  void adviseBy(Advise advise) { advise_ = std::move(advise); }

  /// [any] Only one thread at a time may call this. Answers a request (one line of JSON) with one line of JSON.
  /// @param files descriptors that came with the line
  control::Reply answer(const control::Peer& peer, const std::string& line, std::vector<Descriptor> files = {});
  /// [any] Any thread may call this at any time. Carries out a request to hold arms or to end the run at once, without
  /// waiting for other requests. @return the answer, or nothing if the line is not such a request
  std::optional<control::Reply> urgent(const control::Peer& peer, const std::string& line);
  /// [any] Called from the thread of answer(). Returns why the peer's connection stays open even if the peer is silent.
  control::KeepAlive keepAlive(const control::Peer& peer) const { return {stays(peer), listeners_.count(peer.id) > 0}; }
  /// [any] Called from the thread of answer(). Returns new events for a subscriber, one line each; "" if there are
  /// none.
  std::string news(const control::Peer& peer);
  /// [any] Called from the thread of answer() when a connection has ended: ends the leads and subscriptions that
  /// depended on it.
  void left(const control::Peer& peer);

  /// [any] Called from the thread of answer(). Writes the black box to a file. @return the name of the file
  Result<std::string> dump(const std::string& why);

 private:
  /// Makes an error. @param code one word by which programs can distinguish errors
  Error refuse(const char* code, std::string why) const {
    code_ = code;
    return Error{std::move(why)};
  }
  Result<std::string> execute(const control::Peer& peer, const control::Request& request);
  Result<std::string> executeForModels(const control::Peer& peer, const control::Request& request);
  /// Answers requests that change nothing.
  Result<std::string> answerQuery(const control::Peer& peer, const control::Request& request);
  /// Answers requests about one model that change nothing.
  Result<std::string> answerModelQuery(const control::Request& request);
  Session session() const { return {runner_, places_, leads_, scene_file_}; }
  Result<std::string> eventsAfter(double after) const;
  Result<std::string> subscribe(const control::Peer& peer);
  bool stays(const control::Peer& peer) const;
  size_t staying() const;
  static void remember(scene::Model& model, const hsp_param& param, const Order& order);
  Result<uint32_t> placeOf(const std::string& model) const;
  void reportPusher(uint32_t arm, const Leads::Pusher& pusher, Leads::PushEvent news);
  Result<uint32_t> armOf(const std::string& device) const;
  Result<Leads::Target> pushOf(const std::string& device) const;
  Result<Leads::Target> leadOf(const control::Request& request) const;
  Result<std::string> lead(const control::Peer& peer, const control::Request& request);
  Result<std::string> state();
  Result<std::string> bell();
  Result<void> attach(std::unique_ptr<SealedMemory>& kept, const char* name, size_t bytes,
                      SealedMemory::Writers writers);
  Result<void> unlead(const control::Peer& peer, const control::Request& request);
  Result<void> post(const Order& order) { return post({&order, 1}); }
  Result<void> post(std::span<const Order> orders);
  Result<std::string> mark(const std::string& text);
  Result<std::string> enable(const std::string& model);
  Result<void> setEnabled(const std::string& model, bool enabled);
  Result<void> set(const control::Request& request);
  Result<std::string> move(const control::Request& request);
  Result<void> clear(const control::Peer& peer, const std::string& device);
  Result<void> faultAfterClear(const std::string& device);
  uint64_t tickNow() const;
  void waitForServo(double seconds) const;
  Result<std::string> hold(const std::string& device, const char*& code);
  Result<scene::Scene> loadFor(const control::Peer& peer, const control::Request& request);
  Result<scene::Scene> loadOwn(const control::Peer& peer);
  Result<scene::Scene> loadPassed(const control::Peer& peer, const std::string& file);
  std::string tellable(const control::Peer& peer, const std::string& why) const;
  Result<std::string> add(const control::Peer& peer, const control::Request& request);
  Result<void> refuseQuarantined(const std::vector<scene::Model>& models) const;
  Result<void> adopt(const std::vector<scene::Model>& models);
  /// A model that is ready for the servo, and its description for recordings.
  struct Coming {
    std::unique_ptr<host::ShapeInstance> shape;
    std::string description;
  };
  Result<std::vector<Coming>> prepare(const std::vector<scene::Model>& models);
  Result<void> describe(uint32_t place, const std::string& text);
  void addWarnings(const control::Peer& peer, const std::vector<scene::Model>& models,
                   nlohmann::ordered_json& json) const;
  nlohmann::ordered_json cameAnswer(const std::vector<scene::Model>& models);
  nlohmann::ordered_json waitingOf(const std::vector<scene::Model>& models, double met) const;
  Result<void> remove(const std::string& model);
  Result<void> release(uint32_t place);
  Result<std::string> reload(const control::Peer& peer, const control::Request& request);
  void takePermission(const scene::Clients& wanted);
  std::vector<std::string> reportKeptSettings(const scene::Scene& wanted) const;
  void sweep();

  Runner& runner_;
  LoadScene load_;
  Advise advise_;
  std::string name_, socket_;
  std::vector<double> came_stiffness_;  ///< [N/m] stiffness that each model of the last request claims
  host::Services::Log log_;
  std::string dump_folder_, scene_file_;
  std::vector<ModelPlace> places_;
  /// models that were given to the servo and that it has not adopted yet
  std::vector<std::unique_ptr<ModelState>> prepared_;
  uint64_t given_ = 0;
  Leads leads_;
  std::map<uint64_t, uint64_t> listeners_;  ///< subscribers: number of the next event, by peer
  std::atomic<Nanoseconds> held_at_{0};     ///< CLOCK_MONOTONIC of the last hold
  bool scene_passed_ = false;               ///< a program sent the scene, so its file must not be opened by name
  std::vector<Descriptor> given_files_;     ///< received with the present request
  std::optional<PassedFiles> passed_;       ///< copies of given_files_, during the request
  Descriptor attached_;                     ///< descriptor to send with the present answer
  mutable const char* code_ = "failed";     ///< word for the error of the present request
};

}  // namespace hapticd::servo
