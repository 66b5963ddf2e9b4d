// SPDX-License-Identifier: MIT
/// The device module `haply_service`: an Inverse3 behind Haply's Inverse Service. The messages are those of the
/// service's public documentation (docs.haply.co, "WebSocket protocol" and "Basis permutation" of 3.5). Their units are
/// metres and newtons; their x points to the right, y away from the user, z up.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "base/os.hpp"
#include "vendor_arm/cartesian.hpp"
#include "websocket/channel.hpp"

namespace hapticd::haply_service {
namespace {

using Json = nlohmann::json;

constexpr int kPatienceMs = 500;  ///< [ms] longest wait for an answer; the service sends one answer to each message

/// Reads a vector with the components x, y and z. Returns false, and leaves all of `v` unchanged, if a component is
/// missing or is not a finite number.
bool readVector(const Json& json, double v[3]) {
  const char* axes[] = {"x", "y", "z"};
  double read[3];
  for (int i = 0; i < 3; ++i) {
    const auto it = json.is_object() ? json.find(axes[i]) : json.end();
    if (!json.is_object() || it == json.end() || !it->is_number()) return false;
    read[i] = it->get<double>();
    if (!std::isfinite(read[i])) return false;
  }
  std::copy_n(read, 3, v);
  return true;
}

const Json& childOf(const Json& json, const char* key) {
  static const Json nothing;
  if (!json.is_object()) return nothing;
  const auto it = json.find(key);
  return it != json.end() ? *it : nothing;
}

/// Returns the boolean value of a key of a status, or true if the key is missing.
bool says(const Json& status, const char* key) {
  const Json& value = childOf(status, key);
  return !value.is_boolean() || value.get<bool>();
}

class HaplyArm : public vendor_arm::CartesianArm<HaplyArm> {
 public:
  static constexpr DeviceInfo kInfo{"org.hapticd.device.haply_service", "haply_service", "0.1.0", "MIT",
                                    "An Inverse3 behind Haply's Inverse Service (WebSocket, JSON)."};
  std::string host, device_id;
  int port = 0, rate = 0;
  double force = 0;

  static constexpr auto fields() {
    using F = Fields<HaplyArm>;
    return std::array{
        F::text("host", &HaplyArm::host, "127.0.0.1", "Address of the machine on which the service runs."),
        F::integer("port", &HaplyArm::port, "", 1, 65535, 10001, "Port of the service's simulation channel."),
        F::text("device_id", &HaplyArm::device_id, "",
                "The service's id of the Inverse3. Without it, the first Inverse3 is used."),
        F::real("force", &HaplyArm::force, "N", 0.1, 100, 5, "Largest force."),
        F::real("reach", &HaplyArm::reach, "m", 0.01, 2, 0.3,
                "Largest distance of the tip from the origin, on each axis."),
        F::integer("rate", &HaplyArm::rate, "Hz", 100, 8000, 2000,
                   "Largest number of exchanges with the service per second."),
    };
  }

  void open(hdv_info& info) {
    auto connected = websocket::Channel::connect(host, static_cast<unsigned short>(port), 4 * kPatienceMs);
    if (!connected)
      throw std::runtime_error("the Inverse Service does not answer: " + connected.error() +
                               "\n  fix: start it (systemctl start haply-inverse-service, or the Haply Hub)");
    channel_ = std::move(*connected);
    const auto inventory = channel_->receive(4 * kPatienceMs);
    const Json first = inventory ? Json::parse(*inventory, nullptr, false) : Json();
    const Json* arm = find(first);
    if (arm == nullptr)
      throw std::runtime_error("the Inverse Service has no Inverse3" +
                               (device_id.empty() ? std::string() : " \"" + device_id + "\"") + "; it has " +
                               names(first) + "\n  fix: plug it in, or see the service's dashboard");
    id_ = childOf(*arm, "device_id").get<std::string>();
    describe(info, force);
    info.capabilities = HDV_C_UNVERIFIED;  // the service finds the arm's zero itself
    info.continuous_force = force;
    info.rate_hz = rate;
    info.buttons = 3;
    std::snprintf(info.product, sizeof info.product, "Haply Inverse3");
    std::snprintf(info.serial, sizeof info.serial, "%s", id_.c_str());
  }

  void start(const hdv_start&) {
    exchange_.reset(force);
    end_ = false;
    if (const auto failed = thread_.start("hapticd-haply", [this] { run(); }))
      throw std::runtime_error("cannot start a thread for the Inverse Service: " + failed.message());
    if (exchange_.awaitFirst()) return;
    stop();
    throw std::runtime_error("the Inverse Service has sent no position for 2 s");
  }

  void stop() {
    end_ = true;
    thread_.join();
    if (!channel_ || lost_) return;
    constexpr double kNothing[3] = {};
    if (channel_->send(command(kNothing), kPatienceMs)) (void)channel_->receive(kPatienceMs);
  }
  void close() { channel_.reset(); }

 private:
  /// Returns the arm's entry in a message, or nullptr if the message has none.
  const Json* find(const Json& message) const {
    const std::string& wanted = id_.empty() ? device_id : id_;
    for (const Json& arm : childOf(message, "inverse3")) {
      const Json& id = childOf(arm, "device_id");
      if (id.is_string() && (wanted.empty() || id.get_ref<const std::string&>() == wanted)) return &arm;
    }
    return nullptr;
  }
  static std::string names(const Json& message) {
    std::string all;
    for (const Json& arm : childOf(message, "inverse3"))
      if (const Json& id = childOf(arm, "device_id"); id.is_string())
        all += (all.empty() ? "\"" : ", \"") + id.get<std::string>() + "\"";
    return all.empty() ? "none" : all;
  }

  /// Returns the message that sets the force.
  /// @param wanted force [N] in the daemon's axes: x right, y up, z toward the user
  std::string command(const double wanted[3]) {
    Json message = {
        {"inverse3",
         {{{"device_id", id_},
           {"commands",
            {{"set_cursor_force", {{"values", {{"x", wanted[0]}, {"y", -wanted[2]}, {"z", wanted[1]}}}}}}}}}}};
    if (!introduced_) message["session"] = {{"configure", {{"profile", {{"name", "org.hapticd"}}}}}};
    introduced_ = true;
    return message.dump();
  }

  /// Runs in the thread that waits for the service. If the arm is lost, it stays lost until the next start().
  void run() {
    (void)os::setFifo(os::kServoPriority + 1);  // this thread waits for the service, so that the servo need not
    const auto period = std::chrono::nanoseconds(kNanosecondsPerSecond) / rate;
    auto due = std::chrono::steady_clock::now();
    vendor_arm::ArmReading seen;
    seen.calibrated = true;
    introduced_ = lost_ = false;
    while (!end_) {
      if (!seen.lost) exchangeOnce(seen);
      lost_ = seen.lost;
      exchange_.show(seen);
      due = std::max(due + period, std::chrono::steady_clock::now());
      std::this_thread::sleep_until(seen.lost ? due + std::chrono::milliseconds(10) : due);
    }
  }

  void exchangeOnce(vendor_arm::ArmReading& seen) {
    double wanted[3];
    exchange_.force(wanted);
    const bool sent = static_cast<bool>(channel_->send(command(wanted), kPatienceMs));
    const auto answer = sent ? channel_->receive(kPatienceMs) : Result<std::string>(Error{""});
    const Json message = answer ? Json::parse(*answer, nullptr, false) : Json();
    const Json* arm = find(message);
    double at[3];
    if (arm == nullptr || !readVector(childOf(childOf(*arm, "state"), "cursor_position"), at)) {
      seen.lost = true;
      letGo();
      return;
    }
    seen.position[0] = at[0], seen.position[1] = at[2], seen.position[2] = -at[1];
    const Json& status = childOf(*arm, "status");
    seen.calibrated = says(status, "calibrated");
    seen.fault = !says(status, "power_supply");
    seen.buttons = buttonsOf(message);
    seen.time_ns = monotonicNow();
    ++seen.sequence;
  }

  /// Asks for no force, and leaves the service: it keeps the last force for a program that is connected.
  void letGo() {
    constexpr double kNothing[3] = {};
    (void)channel_->send(command(kNothing), kPatienceMs);
    channel_.reset();
  }

  /// Returns one bit for each pressed button (a, b, c) of the first handle in the message, or 0 if it has no handle.
  static uint32_t buttonsOf(const Json& message) {
    const char* names[] = {"a", "b", "c"};
    for (const char* kind : {"wireless_verse_grip", "verse_grip"})
      for (const Json& grip : childOf(message, kind)) {
        const Json& buttons = childOf(childOf(grip, "state"), "buttons");
        uint32_t down = 0;
        for (uint32_t i = 0; i < 3; ++i)
          if (const Json& one = childOf(buttons, names[i]); one.is_boolean() && one.get<bool>()) down |= 1u << i;
        return down;
      }
    return 0;
  }

  std::unique_ptr<websocket::Channel> channel_;
  os::Thread thread_;
  std::atomic<bool> end_{false}, lost_{false};
  bool introduced_ = false;
  std::string id_;
};

}  // namespace
}  // namespace hapticd::haply_service

HAPTICD_DEVICES(hapticd::haply_service::HaplyArm)
