// SPDX-License-Identifier: MIT
#include "cli/ctl_lead.hpp"

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
#include "cli/command.hpp"
#include "control/client.hpp"
#include "link/lead.hpp"

namespace hapticd::cli {

namespace {

using Json = nlohmann::ordered_json;

/// Three numbers, or seven; an error says what the line has instead.
Result<hapticd_target> targetOf(std::string line) {
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
    return Error{"expected \"x y z\" in m, or \"x y z qw qx qy qz\""};
  for (const double number : numbers)
    if (!std::isfinite(number)) return Error{"expected finite numbers"};
  hapticd_target target{};
  target.orientation[0] = 1;
  std::copy_n(numbers.begin(), 3, target.position);
  if (numbers.size() == 7) std::copy_n(numbers.begin() + 3, 4, target.orientation);
  return target;
}

/// Each line is one target, put the moment it is read. @return false: a line is no target
bool putLines(link::PoseSlot& slot) {
  std::string line;
  for (int number = 1; std::getline(std::cin, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto target = targetOf(line);
    if (!target) {
      std::fprintf(stderr, "error: line %d: %s\n", number, target.error().c_str());
      return false;
    }
    slot.put(*target);
  }
  return true;
}

}  // namespace

int leadByLines(const LeadOptions& options) {
  auto client = control::Client::connect(options.socket);
  if (!client) return fail(kFailed, client.error());
  Json request = {{"do", "lead"}};
  request[options.hand.empty() ? "model" : "hand"] = options.hand.empty() ? options.model : options.hand;
  auto reply = client->askForMore(request.dump(-1, ' ', false, Json::error_handler_t::replace));
  if (!reply) return fail(kFailed, reply.error());
  const Json answer = Json::parse(reply->line, nullptr, false);
  if (!answer.is_object() || !answer.value("ok", false))
    return fail(kFailed, answer.is_object() ? answer.value("error", std::string("refused")) : reply->line);
  void* memory = mmap(nullptr, HAPTICD_LEAD_BYTES, PROT_READ | PROT_WRITE, MAP_SHARED, reply->descriptor.get(), 0);
  if (memory == MAP_FAILED) return fail(kFailed, std::string("cannot map the lead: ") + std::strerror(errno));
  const bool good = putLines(*static_cast<link::PoseSlot*>(memory));
  RealClock clock(0);
  if (good) clock.waitUntil(clock.now() + static_cast<Nanoseconds>(options.hold * 1e9));
  munmap(memory, HAPTICD_LEAD_BYTES);
  return good ? kWorked : kBadInput;
}

}  // namespace hapticd::cli
