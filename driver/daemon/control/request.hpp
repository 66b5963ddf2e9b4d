// SPDX-License-Identifier: MIT
/// One request to a running daemon: a line of JSON, checked before anything is done with it.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"

namespace hapticd::control {

constexpr size_t kMaxRequestBytes = 64 * 1024;

struct Request {
  enum class Kind {
    kStatus,
    kList,
    kSnapshot,
    kEvents,
    kSubscribe,
    kGet,
    kEnable,
    kDisable,
    kMove,
    kSet,
    kAdd,
    kRemove,
    kReload,
    kHold,
    kClear,
    kDump,
    kGeometry,
    kVertices,
    kFeature,
    kLead,
    kUnlead,
    kState,
    kBell,
    kStop
  };
  Kind kind = Kind::kStatus;
  std::string model, device, parameter, file;     ///< set as the kind needs them
  std::vector<std::string> files;                 ///< kAdd, kReload: names of the descriptors that came with it
  std::string hand;                               ///< kLead, kUnlead: the device whose simulated hand is led
  std::string force;                              ///< kLead, kUnlead: the device that is pushed on
  double value = 0;                               ///< kSet: the value, unless there is a word
  double tolerance = 0;                           ///< [m] kGeometry: chord error; 0: the daemon chooses
  bool as_memory = false;                         ///< kGeometry: a descriptor of memory instead of lists in the answer
  double after = 0;                               ///< kVertices: the last known frame; kEvents: the first event wanted
  uint32_t number = 0;                            ///< kFeature: of a contact
  bool consent = false;                           ///< kSet: the operator agrees to change what is felt
  std::array<double, 3> position{};               ///< [m] kMove, world frame
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< kMove: unit quaternion w,x,y,z
  bool turns = false;                             ///< kMove: an orientation was given
  std::optional<double> seconds;                  ///< kMove: how long it takes
  std::string word;                               ///< kSet: the value of a choice or a switch
};

/// [main] Parses and checks a line. An error says what is wrong and what was expected. @param id the request's "id" as
/// JSON, even if the rest is wrong; "" if it has none
Result<Request> parseRequest(std::string_view line, std::string* id = nullptr);

/// [main] {"ok":false,"code":CODE,"error":WHY}. @param code one word for programs
std::string refusal(const std::string& why, const std::string& code = "bad_request");

/// [main] An answer with the id of its request in front.
std::string withId(const std::string& answer, const std::string& id);

}  // namespace hapticd::control
