// SPDX-License-Identifier: MIT
/// Words for a model that the guard has silenced.
#pragma once
#include <cstdint>
#include <string>

namespace hapticd::servo {

struct ModelState;
enum class Trouble : uint8_t;

/// [main] Why the model was silenced and what to do; "" if it was not.
std::string silenceReason(const ModelState& model);
/// [main] The same. @param failed_status the first status that was no status of a step
std::string silenceReason(const std::string& model, Trouble trouble, int32_t failed_status);

}  // namespace hapticd::servo
