// SPDX-License-Identifier: MIT
#include "host/class_table.hpp"

#include <cstring>

#include "host/class_params.hpp"

namespace hapticd::host {

std::string statusText(hsp_status status) {
  switch (status) {
    case HSP_OK:
      return "worked";
    case HSP_DEGRADED:
      return "degraded: it worked with a cheaper method";
    case HSP_E_ARG:
      return "a parameter or an argument is wrong";
    case HSP_E_STATE:
      return "the call is not allowed in the present state of the instance";
    case HSP_E_NOMEM:
      return "out of memory";
    case HSP_E_IO:
      return "a file or a device could not be read or written";
    case HSP_E_UNSUPPORTED:
      return "not supported";
    case HSP_E_NUMERIC:
      return "the calculation has no valid result";
    default:
      return "status " + std::to_string(status) + ", which the ABI does not define";
  }
}

std::string statusName(hsp_status status) {
  static const char* const kNames[] = {"HSP_OK",   "HSP_E_ARG",         "HSP_E_STATE",  "HSP_E_NOMEM",
                                       "HSP_E_IO", "HSP_E_UNSUPPORTED", "HSP_E_NUMERIC"};
  constexpr hsp_status kLast = HSP_E_NUMERIC;
  return status <= 0 && status >= kLast ? kNames[-status] : "status " + std::to_string(status);
}

std::string reasonOf(hsp_status status, const Services& services) {
  const std::string said = services.lastError();
  return said.empty() ? statusText(status) + " (it logged no reason)" : said;
}

hsp_value toAbi(const scene::Value& value) {
  hsp_value given{};
  given.kind = value.kind;
  given.number = value.number;
  if (value.kind == HSP_PATH || value.kind == HSP_TEXT || value.kind == HSP_DATA) given.text = value.text.c_str();
  if (value.kind == HSP_ARRAY) {
    given.numbers = value.numbers.data();
    given.count = static_cast<uint32_t>(value.numbers.size());
  }
  return given;
}

namespace {

bool isNumberIn(const char* unit, const hsp_class& shape, uint32_t param) noexcept {
  if (param >= shape.param_count) return false;
  const hsp_param& described = paramAt(shape, param);
  return described.kind == HSP_REAL && described.unit != nullptr && std::strcmp(described.unit, unit) == 0;
}

}  // namespace

bool damps(const hsp_class& shape, uint32_t param) noexcept {
  return isNumberIn("N s/m", shape, param);
}

bool stiffens(const hsp_class& shape, uint32_t param) noexcept {
  return isNumberIn("N/m", shape, param);
}

bool needsConsent(const hsp_class& shape, uint32_t param) noexcept {
  return param < shape.param_count && (paramAt(shape, param).flags & HSP_P_SAFETY) != 0;
}

bool complete(const hsp_class& shape) {
  return HSP_HAS(&shape, step) && shape.create && shape.destroy && shape.activate && shape.deactivate && shape.reset &&
         shape.step && (shape.param_count == 0 || (shape.set != nullptr && shape.params != nullptr));
}

bool complete(const hdv_class& device) {
  return HSP_HAS(&device, extension) && device.create && device.destroy && device.open && device.start && device.read &&
         device.write && device.stop && device.close && device.extension &&
         (device.param_count == 0 || (device.set != nullptr && device.params != nullptr));
}

}  // namespace hapticd::host
