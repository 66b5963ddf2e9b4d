// SPDX-License-Identifier: MIT
#include "admission.hpp"

#include <sys/random.h>

#include <array>
#include <cctype>
#include <stdexcept>
#include <vector>

namespace hapticd::view {

namespace {

/// Returns 128 random bits of the system, as hexadecimal text.
std::string secret() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("cannot read random numbers from the system for the token");
  std::string text;
  for (const unsigned char byte : bytes) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

/// Returns whether two secrets are equal. Its duration does not depend on where the texts differ, so it does not help
/// to guess.
bool sameSecret(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned char difference = 0;
  for (size_t i = 0; i < a.size(); ++i)
    difference = static_cast<unsigned char>(difference | (static_cast<unsigned char>(a[i] ^ b[i])));
  return difference == 0;
}

std::string trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
  return std::string(text);
}

std::vector<std::string> split(std::string_view text, char by) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const size_t end = std::min(text.find(by), text.size());
    parts.push_back(trimmed(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

/// Returns true for "localhost", "127.0.0.1" or "[::1]", with any port, because a tunnel (ssh -L) may use another port.
bool loopback(const std::string& host) {
  for (const std::string_view name : {"localhost", "127.0.0.1", "[::1]"}) {
    if (host.rfind(name, 0) != 0) continue;
    const std::string rest = host.substr(name.size());
    if (rest.empty()) return true;
    if (rest.size() > 1 && rest.size() <= 6 && rest[0] == ':' &&
        rest.find_first_not_of("0123456789", 1) == std::string::npos)
      return true;
  }
  return false;
}

std::string cookieValue(const std::string& cookies, const std::string& name) {
  for (const std::string& part : split(cookies, ';'))
    if (part.rfind(name + "=", 0) == 0) return part.substr(name.size() + 1);
  return "";
}

/// Returns the first protocol of the client's list that this server knows.
void choose(const std::string& offered, Admission& admission) {
  for (const std::string& name : split(offered, ',')) {
    if (name == "hapticd.1")
      admission.protocol = Subprotocol::kHapticd;
    else if (name == "foxglove.sdk.v1" || name == "foxglove.websocket.v1")
      admission.protocol = Subprotocol::kFoxglove;
    else
      continue;
    admission.protocol_name = name;
    return;
  }
}

Admission refused(unsigned status, const std::string& why) {
  Admission admission;
  admission.status = status;
  admission.why = why;
  return admission;
}

}  // namespace

std::string queryValue(std::string_view target, std::string_view key) {
  const size_t query = target.find('?');
  if (query == std::string_view::npos) return "";
  for (const std::string& part : split(target.substr(query + 1), '&'))
    if (part.size() > key.size() && part.compare(0, key.size(), key) == 0 && part[key.size()] == '=')
      return part.substr(key.size() + 1);
  return "";
}

std::string pathOf(std::string_view target) {
  return std::string(target.substr(0, target.find('?')));
}

AccessPolicy::AccessPolicy(unsigned short port)
    : token_(secret()), session_(secret()), cookie_name_("hapticd-view-" + std::to_string(port)) {}

std::string AccessPolicy::cookie() const {
  return cookie_name_ + "=" + session_ + "; Path=/; HttpOnly; SameSite=Strict";
}

Admission AccessPolicy::check(const RequestHead& head) const {
  if (!loopback(head.host)) return refused(421, "this server answers only to the hosts localhost, 127.0.0.1 and [::1]");
  Admission admission;
  if (head.upgrade) choose(head.protocols, admission);
  const bool by_token = sameSecret(queryValue(head.target, "token"), token_);
  const bool by_cookie = sameSecret(cookieValue(head.cookie, cookie_name_), session_);
  const bool foreign = !head.origin.empty() && head.origin != "http://" + head.host;
  if (foreign && !(admission.protocol == Subprotocol::kFoxglove && by_token))
    return refused(403, "pages of another origin are refused");
  if (!by_token && !by_cookie) return refused(401, "open the address that hapticd view printed, with its token");
  if (head.upgrade && admission.protocol == Subprotocol::kNone)
    return refused(400,
                   "the WebSocket protocol is not known, expected hapticd.1, foxglove.sdk.v1 or foxglove.websocket.v1");
  admission.give_cookie = by_token && !by_cookie;
  return admission;
}

}  // namespace hapticd::view
