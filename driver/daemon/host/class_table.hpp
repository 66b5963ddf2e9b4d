// SPDX-License-Identifier: MIT
/// Functions for classes of shape plugins and of device modules: they find a class and set its parameters.
#pragma once
#include <string>

#include "base/result.hpp"
#include "description/scene.hpp"
#include "hapticd/device.h"
#include "hapticd/shape.h"
#include "host/services.hpp"

namespace hapticd::host {

/// [any] Returns a status in words, for messages.
std::string statusText(hsp_status status);

/// [any] Returns the name of a status in the ABI, such as "HSP_E_NUMERIC".
std::string statusName(hsp_status status);

/// [main] Returns why a call failed, for the end of a message: the error that the module logged, or, if it logged none,
/// the status in words.
std::string reasonOf(hsp_status status, const Services& services);

/// [main] Returns the value in the form of the ABI; the result points into `value`.
hsp_value toAbi(const scene::Value& value);

/// [main] True if the class has every function of version 1.0 of the ABI, so that they can be called without a further
/// check.
bool complete(const hsp_class& shape);
bool complete(const hdv_class& device);

/// [any] Returns a text of a plugin's table; "" if the pointer is NULL.
inline const char* textOf(const char* text) noexcept {
  return text != nullptr ? text : "";
}

/// [any] True if the parameter is a damping: a number in N s/m.
bool damps(const hsp_class& shape, uint32_t param) noexcept;
/// [any] True if the parameter is a stiffness: a number in N/m.
bool stiffens(const hsp_class& shape, uint32_t param) noexcept;
/// [any] True if a live parameter is set only with the consent of the person at the arm (HSP_P_SAFETY).
bool needsConsent(const hsp_class& shape, uint32_t param) noexcept;

/// [main] Returns the class with that name (or id) in an entry; nullptr if there is none.
template <class Class, class Entry>
const Class* findClass(const Entry& entry, const std::string& name) {
  for (uint32_t i = 0; i < entry.class_count; ++i) {
    const Class* candidate = entry.classes[i];
    if (candidate == nullptr || !HSP_HAS(candidate, doc)) continue;
    if (candidate->name != nullptr && name == candidate->name) return candidate;
    if (candidate->id != nullptr && name == candidate->id) return candidate;
  }
  return nullptr;
}

/// [main] Sets all values on an instance. @param set calls set() of the class with the instance
template <class Set>
Result<void> setAll(const std::vector<scene::Value>& values, uint32_t param_count, Services& services, Set set) {
  for (const scene::Value& value : values) {
    const std::string where = value.place.file.empty() ? ""
                                                       : value.place.file + ":" + std::to_string(value.place.line) +
                                                             ":" + std::to_string(value.place.column) + ": ";
    if (value.index >= param_count) return Error{where + value.id + ": the plugin has no such parameter"};
    const hsp_value given = toAbi(value);
    services.forgetError();
    const hsp_status status = set(value.index, &given);
    if (status < 0) return Error{where + value.id + ": refused: " + reasonOf(status, services)};
  }
  return {};
}

}  // namespace hapticd::host
