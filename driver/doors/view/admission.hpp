// SPDX-License-Identifier: MIT
/// Decides from the head of a request whether it may be answered. Pages of other sites in the user's browser and other
/// users of this machine must get no answer.
#pragma once
#include <string>
#include <string_view>

namespace hapticd::view {

/// The head of a request.
struct RequestHead {
  std::string host, origin, cookie;  ///< header fields, "" if the field is missing
  std::string target;                ///< "/path?query"
  std::string protocols;             ///< Sec-WebSocket-Protocol
  bool upgrade = false;              ///< true if the request asks for a WebSocket
};

/// The protocol of a WebSocket.
enum class Subprotocol { kNone, kHapticd, kFoxglove };

/// The decision about a request.
struct Admission {
  unsigned status = 200;  ///< HTTP status: 200, 400, 401 no token, 403 foreign origin, 421 foreign host
  /// true if the token was in the URL: the answer then sets the cookie, which the page uses from then on
  bool give_cookie = false;
  Subprotocol protocol = Subprotocol::kNone;
  std::string protocol_name;  ///< name of the protocol in the answer
  std::string why;            ///< reason of a refusal
};

/// The secrets of one view: 128 random bits each, as hexadecimal text.
class AccessPolicy {
 public:
  /// [main] Makes the secrets from random numbers. @param port becomes part of the cookie's name, because browsers
  /// share cookies between ports
  explicit AccessPolicy(unsigned short port);

  /// [main] Decides about a request. It checks the name of the host first (against DNS rebinding), then the origin,
  /// then the secret. A page of another origin may only open a Foxglove WebSocket, which only reads, and only with the
  /// token in its URL, never by the cookie.
  Admission check(const RequestHead& head) const;

  const std::string& token() const { return token_; }
  std::string cookie() const;  ///< [main] value of Set-Cookie

 private:
  std::string token_, session_, cookie_name_;
};

/// [any] Returns the value of `key` in the query of a target, or "".
std::string queryValue(std::string_view target, std::string_view key);

/// [any] Returns the path of a target, without its query.
std::string pathOf(std::string_view target);

}  // namespace hapticd::view
