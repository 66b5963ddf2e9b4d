// SPDX-License-Identifier: MIT
/// For a device module in C++: derive from hapticd::Device, list the parameters, write open, start, read, write, stop
/// and close, and name the class in HAPTICD_DEVICES(...). device.h, the C ABI behind it, says what each call must do.
#pragma once
#include "device.h"
#include "parameters.hpp"

namespace hapticd {

/// Describes a class before any instance exists. All texts have static storage.
struct DeviceInfo {
  const char* id;    ///< reverse DNS, "org.example.device.arm"
  const char* name;  ///< name of the class in device files, "arm"
  const char* version;
  const char* license;
  const char* doc;
};

/// Base class of devices. The host creates and destroys instances. A derived class T has
///   static constexpr DeviceInfo kInfo;
///   static constexpr auto fields();                        std::array<Field<T>, N>, one line per parameter
///   void open(hdv_info&);  void start(const hdv_start&);   [main] may allocate, block and throw
///   hsp_status read(uint64_t now_ns, hdv_sample&) noexcept HSP_RT;           [rt]
///   hsp_status write(uint64_t now_ns, const hdv_command&) noexcept HSP_RT;   [rt]
/// and may have
///   void given(const char* id);   [main] called after the host has set a parameter: only those that the file gives
/// and may hide the functions below. The text of an exception becomes the error that the user reads.
class Device {
 public:
  void stop() {}   ///< [main] called if started: switches the motors off, ends threads
  void close() {}  ///< [main] called if open: releases the hardware
  const void* extension(const char* /*name*/) { return nullptr; }  ///< [main] nullptr if it has none of that name
  const hsp_host* host() const { return host_; }                   ///< [any] not valid in the constructor
  /// [main] Writes a text to the log of the host, if there is one. The level is HSP_LOG_WARNING or the like.
  void writeLog(int32_t level, const std::string& text) const { detail::writeLog(host_, level, text); }

 private:
  template <class T>
  friend struct DeviceClass;
  enum class State { kClosed, kOpen, kStarted };
  const hsp_host* host_ = nullptr;
  State state_ = State::kClosed;
};

/// Makes the C functions of class T, and its description as constant data. A call in a wrong state returns HSP_E_STATE.
template <class T>
struct DeviceClass {
  static constexpr auto kFields = T::fields();
  static constexpr auto kParams = detail::tableOf(kFields);
  using State = Device::State;

  static T& self(hdv_device* device) { return *reinterpret_cast<T*>(device); }

  static hdv_device* create(const hdv_class*, const hsp_host* host) {
    T* object = detail::make(host, kFields);
    if (object != nullptr) static_cast<Device*>(object)->host_ = host;
    return reinterpret_cast<hdv_device*>(object);
  }
  static void destroy(hdv_device* device) { delete &self(device); }

  static hsp_status set(hdv_device* device, uint32_t param, const hsp_value* value) {
    if (base(device).state_ != State::kClosed) return HSP_E_STATE;
    const hsp_status assigned = detail::assign(self(device), kFields, base(device).host_, param, value);
    if constexpr (requires(T& object) { object.given(""); })
      if (assigned == HSP_OK) self(device).given(kFields[param].param.id);
    return assigned;
  }
  static hsp_status get(hdv_device* device, uint32_t param, hsp_value* value) {
    return detail::fetch(self(device), kFields, param, value);
  }

  static hsp_status open(hdv_device* device, hdv_info* info) {
    return move(device, State::kClosed, State::kOpen, "open()", [&](T& object) { object.open(*info); });
  }
  static hsp_status start(hdv_device* device, const hdv_start* how) {
    return move(device, State::kOpen, State::kStarted, "start()", [&](T& object) { object.start(*how); });
  }
  static hsp_status read(hdv_device* device, uint64_t now_ns, hdv_sample* sample) noexcept HSP_RT {
    if (base(device).state_ != State::kStarted) return HSP_E_STATE;
    return self(device).read(now_ns, *sample);
  }
  static hsp_status write(hdv_device* device, uint64_t now_ns, const hdv_command* command) noexcept HSP_RT {
    if (base(device).state_ != State::kStarted) return HSP_E_STATE;
    return self(device).write(now_ns, *command);
  }
  static void stop(hdv_device* device) {
    if (base(device).state_ == State::kStarted) self(device).stop();
    if (base(device).state_ == State::kStarted) base(device).state_ = State::kOpen;
  }
  static void close(hdv_device* device) {
    stop(device);
    if (base(device).state_ == State::kOpen) self(device).close();
    base(device).state_ = State::kClosed;
  }
  static const void* extension(hdv_device* device, const char* name) { return self(device).extension(name); }

  static constexpr hdv_class kClass = {sizeof(hdv_class),
                                       static_cast<uint32_t>(kParams.size()),
                                       0,
                                       0,
                                       T::kInfo.id,
                                       T::kInfo.name,
                                       T::kInfo.version,
                                       T::kInfo.license,
                                       T::kInfo.doc,
                                       kParams.data(),
                                       &create,
                                       &destroy,
                                       &set,
                                       &get,
                                       &open,
                                       &start,
                                       &read,
                                       &write,
                                       &stop,
                                       &close,
                                       &extension};

 private:
  static Device& base(hdv_device* device) { return self(device); }

  template <class Action>
  static hsp_status move(hdv_device* device, State from, State to, const char* what, Action action) {
    if (base(device).state_ != from) return HSP_E_STATE;
    return detail::guarded(base(device).host_, "", what, HSP_E_IO, [&] {
      action(self(device));
      base(device).state_ = to;
    });
  }
};

namespace detail {
template <class... T>
inline constexpr std::array<const hdv_class*, sizeof...(T)> kDeviceClasses = {&DeviceClass<T>::kClass...};
}

}  // namespace hapticd

/// Exports the devices of this module. Use it once per shared object, at file scope: HAPTICD_DEVICES(SimulatedArm)
#define HAPTICD_DEVICES(...)                                                                            \
  extern "C" {                                                                                          \
  constinit const hdv_entry hdv_module_entry = {HDV_MAGIC, HSP_ABI_MAJOR, HSP_ABI_MINOR,                \
                                                ::hapticd::detail::kDeviceClasses<__VA_ARGS__>.size(),  \
                                                ::hapticd::detail::kDeviceClasses<__VA_ARGS__>.data()}; \
  }
