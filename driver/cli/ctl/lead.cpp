// SPDX-License-Identifier: MIT
#include "cli/ctl/lead.hpp"

#include <fmt/format.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/clock.hpp"
#include "cli/ctl/answer.hpp"
#include "cli/support/command.hpp"
#include "control/client.hpp"
#include "document/json_text.hpp"
#include "link/lead.hpp"

namespace hapticd::cli {

namespace {

using Json = nlohmann::ordered_json;

/// Checks a target for what the servo would refuse. It is checked here, because here the message can name the line.
Result<hapticd_target> checked(const hapticd_target& target) {
  constexpr double kFarthest = 10, kUnitWithin = 1e-3;  // [m]; deviation of the length from 1; as in control.md
  const auto length = [](const double* of, size_t count) {
    double square = 0;
    for (size_t i = 0; i < count; ++i) square += of[i] * of[i];
    return std::sqrt(square);
  };
  if (const double far = length(target.position, 3); !(far <= kFarthest))
    return Error{fmt::format("the position is {:g} m from the world's origin, expected at most 10 m", far)};
  if (const double size = length(target.orientation, 4); !(std::abs(size - 1) <= kUnitWithin))
    return Error{fmt::format("the quaternion has length {:g}, expected 1 (qw qx qy qz behind the position)", size)};
  return target;
}

/// Reads three or seven numbers. An error says what was expected.
Result<hapticd_target> targetOf(const std::string& given) {
  std::string line = given;
  std::replace(line.begin(), line.end(), ',', ' ');
  std::vector<double> numbers;
  const char* at = line.c_str();
  for (char* end = nullptr;; at = end) {
    const double number = std::strtod(at, &end);
    if (end == at) break;
    numbers.push_back(number);
  }
  const bool rest = std::strspn(at, " \t\r") != std::strlen(at);
  if (rest || (numbers.size() != 3 && numbers.size() != 7))
    return Error{"\"" + given.substr(0, 60) + "\" is not a pose, expected \"x y z\" in m, or \"x y z qw qx qy qz\"" +
                 (given.find(',') != given.npos ? "; a comma separates two numbers: write decimals with a point" : "")};
  for (const double number : numbers)
    if (!std::isfinite(number)) return Error{"a number is not finite, expected finite numbers"};
  hapticd_target target{};
  target.orientation[0] = 1;
  std::copy_n(numbers.begin(), 3, target.position);
  if (numbers.size() == 7) std::copy_n(numbers.begin() + 3, 4, target.orientation);
  return checked(target);
}

int reportEnd() {
  return fail(kFailed, "the daemon has ended, or it has ended this lead: the model or hand comes to rest");
}

/// Sends each line of standard input as one target, as soon as the line is read. @return the exit code
int putLines(const control::Client& client, link::PoseSlot& slot) {
  std::string line;
  for (int number = 1; std::getline(std::cin, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto target = targetOf(line);
    if (!target) return fail(kBadInput, "line " + std::to_string(number) + ": " + target.error());
    if (client.ended()) return reportEnd();
    slot.put(*target);
  }
  return kWorked;
}

}  // namespace

void addLeadOptions(const Command& lead, LeadOptions& options) {
  lead.addOption("model", options.model, "name of the model");
  lead.addOption("--hand", options.hand, "device whose simulated hand is led, instead of a model");
  lead.addOption("--hold", options.hold, "how long the lead goes on after the last line [s]; default: 1")
      .within(0, 1e9);
  lead.footer(
      "A line is \"x y z\" in m, or \"x y z qw qx qy qz\", world frame. The model follows with at most 1 m/s and\n"
      "20 m/s^2. When the lead ends, the model or the hand brakes and stays.\n"
      "Example:\n  echo 0.1 0 0 | hapticd ctl lead door");
}

int leadByLines(const LeadOptions& options) {
  if (!options.complete()) return fail(kBadInput, "lead: expected either a model or --hand DEVICE");
  auto client = control::Client::connect(options.socket);
  if (!client) return fail(kFailed, client.error());
  Json request = {{"do", "lead"}};
  request[options.hand.empty() ? "model" : "hand"] = options.hand.empty() ? options.model : options.hand;
  auto reply = client->askForMore(document::jsonLine(request));
  if (!reply) return fail(kFailed, reply.error());
  if (const auto answer = acceptedAnswer(reply->line); !answer) return fail(exitCodeOf(reply->line), answer.error());
  void* memory = mmap(nullptr, HAPTICD_LEAD_BYTES, PROT_READ | PROT_WRITE, MAP_SHARED, reply->descriptor.get(), 0);
  if (memory == MAP_FAILED) return fail(kFailed, std::string("cannot map the lead: ") + std::strerror(errno));
  int exit_code = putLines(*client, *static_cast<link::PoseSlot*>(memory));
  RealClock clock(0);
  if (exit_code == kWorked) clock.waitUntil(clock.now() + static_cast<Nanoseconds>(options.hold * 1e9));
  munmap(memory, HAPTICD_LEAD_BYTES);
  if (exit_code == kWorked && client->ended()) exit_code = reportEnd();
  return exit_code;
}

}  // namespace hapticd::cli
