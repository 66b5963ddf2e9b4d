// SPDX-License-Identifier: MIT
#include "watch/notify.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "fake_servo.hpp"

namespace hapticd::watch {
namespace {

TEST(Notify, FeedsTheServiceManagerOnlyWhileTicksMove) {
  const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = (std::filesystem::temp_directory_path() / ("notify" + std::to_string(getpid()))).string();
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  unlink(path.c_str());
  ASSERT_EQ(bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  setenv("NOTIFY_SOCKET", path.c_str(), 1);
  setenv("WATCHDOG_USEC", "2000000", 1);
  Feeder feeder;
  EXPECT_TRUE(feeder.feed(10'000 * kMs, 5));
  char got[64] = "";
  EXPECT_EQ(recv(fd, got, sizeof got, 0), 10);
  EXPECT_STREQ(got, "WATCHDOG=1");
  EXPECT_FALSE(feeder.feed(20'000 * kMs, 5)) << "the servo stands still";
  EXPECT_TRUE(feeder.feed(20'000 * kMs, 6));
  unsetenv("NOTIFY_SOCKET");
  unsetenv("WATCHDOG_USEC");
  EXPECT_FALSE(notify("READY=1"));
  close(fd);
  unlink(path.c_str());
}

}  // namespace
}  // namespace hapticd::watch
