// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string>
#include <thread>

#include "control/client.hpp"
#include "control/server.hpp"

namespace hapticd::control {
namespace {

/// Programs wait until the socket is there. From then on it answers.
TEST(Server, NeverRefusesAProgramThatSeesItsSocket) {
  const std::string file = testing::TempDir() + "early" + std::to_string(getpid()) + ".sock";
  sockaddr_un address{};
  ASSERT_TRUE(socketAddress(file, address));
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::atomic<bool> waits{false};
    std::thread program([&] {
      const Descriptor own(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
      int code = ENOENT;
      for (; code == ENOENT; waits = true)
        code = connect(own.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? 0 : errno;
      refused += code != 0;
    });
    while (!waits) std::this_thread::yield();
    const auto listening = Server::listen(file);
    program.join();
    EXPECT_TRUE(listening);
  }
  EXPECT_EQ(refused, 0);
}

}  // namespace
}  // namespace hapticd::control
