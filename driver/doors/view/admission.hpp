// SPDX-License-Identifier: MIT
/// Who may look: decided from the head of a request alone, before anything of it is answered. A page of another site
/// that the user's browser shows must get nothing, nor another user of this machine.
#pragma once
#include <string>
#include <string_view>

namespace hapticd::view {

/// What a request says about itself.
struct RequestHead {
  std::string host, origin, cookie;  ///< header fields, "" where there is none
  std::string target;                ///< "/path?query"
  std::string protocols;             ///< Sec-WebSocket-Protocol
  bool upgrade = false;              ///< wants to be a WebSocket
};

/// The protocol of a WebSocket.
enum class Subprotocol { kNone, kHapticd, kFoxglove };

/// What comes of it.
struct Admission {
  unsigned status = 200;     ///< HTTP status: 200, 400, 401 no token, 403 foreign origin, 421 foreign host
  bool give_cookie = false;  ///< the token was in the URL; from now on the cookie is used
  Subprotocol protocol = Subprotocol::kNone;
  std::string protocol_name;  ///< as it is answered
  std::string why;            ///< for the refused
};

/// The secrets of one view: 128 random bits each, as hexadecimal text.
class Doorkeeper {
 public:
  /// [main] Draws the secrets. @param port part of the cookie's name: browsers share cookies between ports
  explicit Doorkeeper(unsigned short port);

  /// [main] Decides. It checks the name of the host first (against DNS rebinding), then the origin, then the secret. A
  /// page of another origin may only open a Foxglove WebSocket, which only reads, and only with the token in its URL,
  /// never by the cookie.
  Admission judge(const RequestHead& head) const;

  const std::string& token() const { return token_; }
  std::string cookie() const;  ///< [main] value of Set-Cookie

 private:
  std::string token_, session_, cookie_name_;
};

/// [any] The value of `key` in the query of a target, or "".
std::string queryValue(std::string_view target, std::string_view key);

/// [any] The path of a target, without its query.
std::string pathOf(std::string_view target);

}  // namespace hapticd::view
