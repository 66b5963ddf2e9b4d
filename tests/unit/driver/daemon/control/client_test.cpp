// SPDX-License-Identifier: MIT
#include "control/client.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <thread>

namespace hapticd::control {
namespace {

constexpr double kShort = 0.01, kLong = 30;  // s

/// A daemon that says what a test tells it to.
struct Daemon {
  Daemon() : file(testing::TempDir() + "client" + std::to_string(getpid()) + ".sock") {
    sockaddr_un address{};
    EXPECT_TRUE(socketAddress(file, address));
    unlink(file.c_str());
    listening = Descriptor(socket(AF_UNIX, SOCK_STREAM, 0));
    EXPECT_EQ(bind(listening.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(listen(listening.get(), 1), 0);
  }
  ~Daemon() { unlink(file.c_str()); }
  void accept() { line = Descriptor(::accept(listening.get(), nullptr, nullptr)); }
  void say(const std::string& text) const {
    EXPECT_EQ(write(line.get(), text.data(), text.size()), ssize_t(text.size()));
  }
  /// A line that brings a file with this content along.
  void give(const std::string& text, const std::string& content) const {
    const Descriptor memory(memfd_create("test", MFD_CLOEXEC));
    EXPECT_EQ(write(memory.get(), content.data(), content.size()), ssize_t(content.size()));
    const int fd = memory.get();
    EXPECT_EQ(sendWith(line.get(), text, {&fd, 1}), ssize_t(text.size()));
  }
  std::string file;
  Descriptor listening, line;
};

Client connectTo(Daemon& daemon) {
  auto client = Client::connect(daemon.file);
  EXPECT_TRUE(client);
  daemon.accept();
  return std::move(*client);
}

std::string contentOf(const Descriptor& file) {
  char text[16];
  const ssize_t got = file ? pread(file.get(), text, sizeof text, 0) : 0;
  return {text, got > 0 ? static_cast<size_t>(got) : 0};
}

TEST(Client, TakesALateAnswerForNoOther) {
  Daemon daemon;
  Client client = connectTo(daemon);
  EXPECT_FALSE(client.ask("one", kShort));
  EXPECT_FALSE(client.ask("two", kShort));
  daemon.say("1\n2\n3\n");
  const auto answer = client.ask("three", kLong);
  ASSERT_TRUE(answer);
  EXPECT_EQ(*answer, "3");
}

TEST(Client, GivesEachLineTheFileThatCameWithIt) {
  Daemon daemon;
  Client client = connectTo(daemon);
  EXPECT_FALSE(client.askForMore("one", kShort));
  daemon.say("{\"event\":1}\n");
  daemon.give("the first, late\n", "1");
  daemon.give("the second\n", "2");
  daemon.say("the third\n");
  const auto second = client.askForMore("two", kLong), third = client.askForMore("three", kLong);
  ASSERT_TRUE(second && third);
  EXPECT_EQ(second->line, "the second");
  EXPECT_EQ(contentOf(second->descriptor), "2");
  EXPECT_EQ(third->line, "the third");
  EXPECT_FALSE(third->descriptor);
}

TEST(Client, KeepsWhatComesByItself) {
  Daemon daemon;
  Client client = connectTo(daemon);
  daemon.say("{\"event\":1}\n{\"event\":2}\nanswer\n{\"event\":3}\n");
  const auto answer = client.ask("request", kLong);
  ASSERT_TRUE(answer);
  EXPECT_EQ(*answer, "answer");
  for (const char* event : {"{\"event\":1}", "{\"event\":2}", "{\"event\":3}"}) {
    const auto heard = client.receiveLine(kLong);
    ASSERT_TRUE(heard);
    EXPECT_EQ(*heard, event);
  }
  EXPECT_FALSE(client.receiveLine(kShort));
}

TEST(Client, TellsADaemonThatClosesFromOneThatHasEnded) {
  Daemon daemon;
  const std::string name = daemon.file.substr(0, daemon.file.size() - 5) + ".lock";
  Descriptor lock(open(name.c_str(), O_RDWR | O_CREAT, 0600));
  ASSERT_EQ(flock(lock.get(), LOCK_EX), 0);
  Client client = connectTo(daemon);
  daemon.line = Descriptor();
  EXPECT_NE(client.ask("one", kLong).error().find("but runs on"), std::string::npos);
  Client other = connectTo(daemon);
  daemon.line = Descriptor();
  lock = Descriptor();  // as the daemon ends
  EXPECT_NE(other.ask("two", kLong).error().find("has ended without an answer"), std::string::npos);
  unlink(name.c_str());
}

TEST(Client, WaitsOnThroughTheSignalsOfItsProgram) {
  struct sigaction old{}, quiet{};
  quiet.sa_handler = [](int) {};
  sigaction(SIGUSR1, &quiet, &old);
  Daemon daemon;
  Client client = connectTo(daemon);
  std::atomic<bool> done{false};
  std::thread other([&, target = pthread_self()] {
    for (int i = 0; i < 20; ++i) {
      pthread_kill(target, SIGUSR1);
      usleep(1000);
    }
    daemon.say("answer\n");
    while (!done) usleep(1000);
  });
  EXPECT_TRUE(client.ask("request", kLong));
  done = true;
  other.join();
  sigaction(SIGUSR1, &old, nullptr);
}

}  // namespace
}  // namespace hapticd::control
