// SPDX-License-Identifier: MIT
/// Words for a model that the guard has silenced.
#pragma once
#include <cstdint>
#include <string>

#include "hapticd/client.h"

namespace hapticd::servo {

struct ModelState;
struct Pull;
enum class Trouble : uint8_t;

/// [main] Why the model was silenced and what to do; "" if it was not.
std::string silenceReason(const ModelState& model);
/// [main] The same. @param failed_status the first status that step may not return
std::string silenceReason(const std::string& model, Trouble trouble, int32_t failed_status);
/// [main] The same. @param pull how it pulled, if it did
std::string silenceReason(const std::string& model, Trouble trouble, int32_t failed_status, const Pull& pull);
/// [main] The same for an event HAPTICD_SILENCED.
std::string silenceReason(const hapticd_event& event, const std::string& model);

}  // namespace hapticd::servo
