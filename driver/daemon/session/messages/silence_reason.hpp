// SPDX-License-Identifier: MIT
/// Messages about a model that its Guard has silenced.
#pragma once
#include <cstdint>
#include <string>

#include "hapticd/client.h"

namespace hapticd::servo {

struct ModelState;
struct Breach;
enum class ShapeFault : uint8_t;

/// [main] Returns words that stand for the file of a plugin where only its name is known.
std::string fileOfPlugin(const std::string& plugin);
/// [main] Returns why the model was silenced and what to do; "" if it was not silenced.
std::string silenceReason(const ModelState& model);
/// [main] Returns the same text from the data of a model. @param file the file of the plugin @param failed_status the
/// first status that step() returned and that the ABI does not allow
std::string silenceReason(const std::string& model, const std::string& file, ShapeFault fault, int32_t failed_status);
/// [main] Returns the same text with more detail. @param breach the pull, or the largest jump, for which it was
/// silenced
std::string silenceReason(const std::string& model, const std::string& file, ShapeFault fault, int32_t failed_status,
                          const Breach& breach);
/// [main] Returns the text for an event of kind HAPTICD_SILENCED.
std::string silenceReason(const hapticd_event& event, const std::string& model, const std::string& file);

}  // namespace hapticd::servo
