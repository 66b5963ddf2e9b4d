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
    kMark,
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
  std::string model, device, parameter, file;  ///< "" if the request has none
  std::vector<std::string> files;              ///< kAdd, kReload: names of the files passed with the request
  std::string hand;                            ///< kLead, kUnlead: the device whose simulated hand is led
  std::string force;                           ///< kLead, kUnlead: the device that gets a force
  double value = 0;                            ///< kSet: the new value, if it is a number
  double tolerance = 0;                        ///< [m] kGeometry: chord error; 0: the daemon chooses
  bool as_memory = false;                      ///< kGeometry: true to get the lists in shared memory
  /// kVertices: number of the last frame that the client has; kEvents: number of the first event that it wants
  double after = 0;
  uint32_t triangles = 0;  ///< kGeometry: most triangles of the drawing; 0: any number
  uint32_t number = 0;     ///< kFeature: number of the feature, as in a contact
  bool consent = false;    ///< kSet: the person who holds the arm agrees to a change that may be felt suddenly
  std::array<double, 3> position{};               ///< [m] kMove, world frame
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< kMove: unit quaternion w,x,y,z
  bool turns = false;                             ///< kMove: an orientation was given
  std::optional<double> seconds;                  ///< [s] kMove: duration of the motion
  std::string word;                               ///< kSet: the new value, if it is a choice or a switch
  std::string text;                               ///< kMark: what to write into the recording
};

/// [main] Parses and checks a line. An error says what is wrong and what was expected. @param id receives the request's
/// "id" as JSON, even if the rest of the request is wrong; it is not changed if there is no valid "id"
Result<Request> parseRequest(std::string_view line, std::string* id = nullptr);

/// [main] Returns {"ok":false,"code":CODE,"error":WHY}. @param code one word for programs
std::string refusal(const std::string& why, const std::string& code = "bad_request");

/// [main] Returns the answer with the id of its request added as the first key.
std::string withId(const std::string& answer, const std::string& id);

}  // namespace hapticd::control
