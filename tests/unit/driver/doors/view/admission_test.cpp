// SPDX-License-Identifier: MIT
#include "admission.hpp"

#include <gtest/gtest.h>

#include <set>

namespace hapticd::view {
namespace {

/// A request that is let in, for tests that change one thing of it.
RequestHead good(const AccessPolicy& access_policy) {
  RequestHead head;
  head.host = "127.0.0.1:4000";
  head.target = "/?token=" + access_policy.token();
  return head;
}

/// "name=value" of the cookie, as a browser sends it back.
std::string cookieOf(const AccessPolicy& access_policy) {
  return access_policy.cookie().substr(0, access_policy.cookie().find(';'));
}

TEST(AccessPolicy, DrawsOtherSecretsEachTime) {
  std::set<std::string> drawn;
  for (int i = 0; i < 100; ++i) {
    const AccessPolicy access_policy(4000);
    EXPECT_EQ(access_policy.token().size(), 32u);
    drawn.insert(access_policy.token());
    drawn.insert(cookieOf(access_policy));
  }
  EXPECT_EQ(drawn.size(), 200u);
}

TEST(AccessPolicy, LetsTheTokenInAndGivesACookieOnce) {
  const AccessPolicy access_policy(4000);
  RequestHead head = good(access_policy);
  EXPECT_EQ(access_policy.check(head).status, 200u);
  EXPECT_TRUE(access_policy.check(head).give_cookie);
  head.cookie = "other=1; " + cookieOf(access_policy);
  EXPECT_FALSE(access_policy.check(head).give_cookie);
  head.target = "/app.js";
  EXPECT_EQ(access_policy.check(head).status, 200u);
}

TEST(AccessPolicy, KnowsNoSecretThatDiffersInOneLetter) {
  const AccessPolicy access_policy(4000);
  for (size_t i = 0; i < access_policy.token().size(); ++i) {
    RequestHead head = good(access_policy);
    char& letter = head.target[std::string("/?token=").size() + i];
    letter = letter == '0' ? '1' : '0';
    EXPECT_EQ(access_policy.check(head).status, 401u) << i;
  }
}

TEST(AccessPolicy, KnowsNoCookieOfAnotherPort) {
  const AccessPolicy here(4000), there(4001);
  RequestHead head = good(here);
  head.target = "/";
  head.cookie = cookieOf(there);
  EXPECT_EQ(here.check(head).status, 401u);
}

TEST(AccessPolicy, JudgesTheHostBeforeAllElse) {
  const AccessPolicy access_policy(4000);
  for (const char* host : {"", "evil.example", "127.0.0.1.evil.example", "localhost.evil.example:80", "127.0.0.1:80:90",
                           "[::1", "127.0.0.2", "localhost:", "localhost:123456", "LOCALHOST.", "evil@localhost"}) {
    RequestHead head = good(access_policy);
    head.host = host;
    EXPECT_EQ(access_policy.check(head).status, 421u) << host;
  }
  for (const char* host : {"localhost", "localhost:1", "127.0.0.1:65535", "[::1]:8080"}) {
    RequestHead head = good(access_policy);
    head.host = host;
    EXPECT_EQ(access_policy.check(head).status, 200u) << host;
  }
}

TEST(AccessPolicy, TakesNoOriginButItsOwn) {
  const AccessPolicy access_policy(4000);
  RequestHead head = good(access_policy);
  head.cookie = cookieOf(access_policy);
  head.origin = "http://127.0.0.1:4000";
  EXPECT_EQ(access_policy.check(head).status, 200u);
  for (const char* origin :
       {"null", "http://127.0.0.1", "https://127.0.0.1:4000", "http://localhost:4000", "http://evil.example"}) {
    head.origin = origin;
    EXPECT_EQ(access_policy.check(head).status, 403u) << origin;
  }
}

TEST(AccessPolicy, LetsAForeignPageReadByFoxgloveWithTheTokenAlone) {
  const AccessPolicy access_policy(4000);
  RequestHead head = good(access_policy);
  head.origin = "https://app.foxglove.dev";
  head.upgrade = true;
  head.protocols = "foxglove.sdk.v1, foxglove.websocket.v1";
  const Admission admission = access_policy.check(head);
  EXPECT_EQ(admission.status, 200u);
  EXPECT_EQ(admission.protocol, Subprotocol::kFoxglove);
  EXPECT_EQ(admission.protocol_name, "foxglove.sdk.v1");
  head.protocols = "hapticd.1";
  EXPECT_EQ(access_policy.check(head).status, 403u);
  head.protocols = "foxglove.sdk.v1";
  head.target = "/";
  head.cookie = cookieOf(access_policy);
  EXPECT_EQ(access_policy.check(head).status, 403u);
}

TEST(AccessPolicy, WantsAProtocolThatItSpeaks) {
  const AccessPolicy access_policy(4000);
  RequestHead head = good(access_policy);
  head.upgrade = true;
  EXPECT_EQ(access_policy.check(head).status, 400u);
  head.protocols = "chat, hapticd.1";
  EXPECT_EQ(access_policy.check(head).protocol, Subprotocol::kHapticd);
}

TEST(QueryValue, TakesTheWholeKey) {
  EXPECT_EQ(queryValue("/?token=a", "token"), "a");
  EXPECT_EQ(queryValue("/?x=1&token=a&y=2", "token"), "a");
  EXPECT_EQ(queryValue("/?atoken=a", "token"), "");
  EXPECT_EQ(queryValue("/token=a", "token"), "");
  EXPECT_EQ(queryValue("/?token", "token"), "");
}

}  // namespace
}  // namespace hapticd::view
