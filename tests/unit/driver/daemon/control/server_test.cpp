// SPDX-License-Identifier: MIT
#include "control/server.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "control/client.hpp"
#include "control/request.hpp"

namespace hapticd::control {
namespace {

std::string contentOf(int fd) {
  char text[64];
  const ssize_t got = pread(fd, text, sizeof text, 0);
  return got > 0 ? std::string(text, static_cast<size_t>(got)) : "";
}

Descriptor memory(const std::string& text) {
  Descriptor file(memfd_create("test", MFD_CLOEXEC));
  EXPECT_EQ(write(file.get(), text.data(), text.size()), static_cast<ssize_t>(text.size()));
  return file;
}

struct Rig {
  explicit Rig(const char* name, std::string answer = "")
      : file(testing::TempDir() + name + std::to_string(getpid()) + ".sock") {
    auto listening = Server::listen(file);
    EXPECT_TRUE(listening) << (listening ? "" : listening.error());
    server = std::move(*listening);
    Server::Service service;
    service.answer = [this, answer](const Peer& peer, const std::string& line, std::vector<Descriptor> files) {
      last_peer = peer;
      for (const Descriptor& passed : files) given += "," + contentOf(passed.get());
      return answer.empty() ? "you said " + line : answer;
    };
    service.left = [this](const Peer& peer) { left = peer.id; };
    server->start(std::move(service));
  }
  std::atomic<uint64_t> left{0};
  std::string given;  ///< what the descriptors hold that came, the server's thread's too
  Peer last_peer;     ///< the server's thread's until it has answered
  std::string file;
  std::unique_ptr<Server> server;
};

int connectRaw(const std::string& file) {
  sockaddr_un address{};
  socketAddress(file, address);
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  EXPECT_EQ(connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  return fd;
}

/// Everything until the server closes or nothing comes for a second.
std::string readAll(int fd) {
  std::string text;
  char buffer[4096];
  pollfd polled{fd, POLLIN, 0};
  while (poll(&polled, 1, 1000) == 1) {
    const ssize_t got = recv(fd, buffer, sizeof buffer, 0);
    if (got <= 0) break;
    text.append(buffer, static_cast<size_t>(got));
  }
  return text;
}

TEST(Server, AnswersEachLineInOrderHoweverItIsCut) {
  Rig rig("lines");
  EXPECT_EQ(*ask(rig.file, "hello"), "you said hello");
  const int fd = connectRaw(rig.file);
  for (const char* part : {"on", "e\ntw", "o\n\nfour\nrest"}) {
    ASSERT_GT(send(fd, part, strlen(part), MSG_NOSIGNAL), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  shutdown(fd, SHUT_WR);
  EXPECT_EQ(readAll(fd), "you said one\nyou said two\nyou said \nyou said four\nyou said rest\n");
  close(fd);
}

TEST(Server, DropsIdleClientsWhereAnotherWaits) {
  Rig rig("idle");
  std::vector<int> crowd;
  for (size_t i = 0; i < Server::kMaxClients; ++i) crowd.push_back(connectRaw(rig.file));
  send(crowd[0], "half a", 6, MSG_NOSIGNAL);
  const auto asked = ask(rig.file, "hold", 5);
  ASSERT_TRUE(asked) << asked.error();
  EXPECT_EQ(*asked, "you said hold");
  std::this_thread::sleep_for(std::chrono::nanoseconds(Server::kIdle));
  for (int i = 0; i < 16; ++i) crowd.push_back(connectRaw(rig.file));
  EXPECT_TRUE(ask(rig.file, "stop", 5));
  for (const int fd : crowd) close(fd);
}

TEST(Server, RestsWhereItHasNoDescriptorForAConnection) {
  Rig rig("full");
  sockaddr_un address{};
  socketAddress(rig.file, address);
  const int client = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  rlimit before{};
  getrlimit(RLIMIT_NOFILE, &before);
  const rlimit none{static_cast<rlim_t>(client) + 1, before.rlim_max};
  setrlimit(RLIMIT_NOFILE, &none);
  EXPECT_EQ(connect(client, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  const std::clock_t begun = std::clock();
  std::this_thread::sleep_for(std::chrono::seconds(1));
  const double busy = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  setrlimit(RLIMIT_NOFILE, &before);
  EXPECT_LT(busy, 0.1);  // s of the processor's time; a loop that spins takes what it gets
  EXPECT_TRUE(ask(rig.file, "again"));
  close(client);
}

TEST(Client, GivesUpWhereNobodyAcceptsItsConnection) {
  const std::string file = testing::TempDir() + "deaf" + std::to_string(getpid()) + ".sock";
  sockaddr_un address{};
  ASSERT_TRUE(socketAddress(file, address));
  const int deaf = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  ASSERT_EQ(bind(deaf, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(listen(deaf, 0), 0);
  const int first = connectRaw(file);
  EXPECT_FALSE(Client::connect(file));
  close(first);
  close(deaf);
  unlink(file.c_str());
}

TEST(Server, IsForItsOwnerAndGroupAlone) {
  Rig rig("mode");
  struct stat info{};
  ASSERT_EQ(stat(rig.file.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0660u);
}

TEST(Server, LeavesAServedSocketAndAFileAloneAndReplacesADeadOne) {
  Rig rig("taken");
  const auto second = Server::listen(rig.file);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().find("another daemon"), std::string::npos);
  EXPECT_TRUE(ask(rig.file, "still"));
  const std::string plain = testing::TempDir() + "plain" + std::to_string(getpid());
  std::ofstream(plain) << "mine";
  EXPECT_FALSE(Server::listen(plain));
  EXPECT_TRUE(std::ifstream(plain).good());
  const pid_t child = fork();
  if (child == 0) {
    auto dead = Server::listen(rig.file + "2");
    kill(getpid(), SIGKILL);
  }
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(Server::listen(rig.file + "2"));
  EXPECT_FALSE(Server::listen(std::string(200, 'x')));
}

TEST(Server, EndsAClientThatSendsALineWithoutEnd) {
  Rig rig("long");
  const int fd = connectRaw(rig.file);
  const std::string piece(4096, 'x');
  for (int i = 0; i < 64 && send(fd, piece.data(), piece.size(), MSG_NOSIGNAL | MSG_DONTWAIT) > 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_NE(readAll(fd).find("longer than"), std::string::npos);
  close(fd);
  EXPECT_TRUE(ask(rig.file, "others go on"));
}

TEST(Server, DoesNotGrowForAClientThatNeverReads) {
  Rig rig("slow", std::string(100000, 'a'));
  const int fd = connectRaw(rig.file);
  std::string lines;
  for (int i = 0; i < 20000; ++i) lines += "x\n";
  [[maybe_unused]] const ssize_t sent = send(fd, lines.data(), lines.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(ask(rig.file, "me")->size(), 100000u) << "others are served meanwhile";
  std::ifstream statm("/proc/self/statm");
  size_t total = 0, resident = 0;
  statm >> total >> resident;
  EXPECT_LT(resident * 4096, 500u << 20);
  close(fd);
}

TEST(Server, LetsAClientReadALongAnswerSlowly) {
  const std::string answer(Server::kMaxWaiting, 'a');
  Rig rig("slow", answer);
  const int fd = connectRaw(rig.file);
  send(fd, "all\n", 4, MSG_NOSIGNAL);
  std::string got;
  std::vector<char> part(answer.size() / 64);
  const Nanoseconds begin = monotonicNow();
  while (monotonicNow() - begin < Server::kPatience * 5 / 4) {
    const ssize_t now = recv(fd, part.data(), part.size(), 0);
    ASSERT_GT(now, 0) << "the server hung up after " << got.size() << " bytes";
    got.append(part.data(), static_cast<size_t>(now));
    std::this_thread::sleep_for(std::chrono::nanoseconds(Server::kPatience / 50));
  }
  ASSERT_LT(got.size(), answer.size()) << "the client read too quickly for this test";
  EXPECT_EQ(got + readAll(fd), answer + "\n");
  close(fd);
}

TEST(Server, ServesManyClientsAndOutlivesThoseThatDie) {
  Rig rig("many");
  std::vector<int> idle;
  for (int i = 0; i < 20; ++i) idle.push_back(connectRaw(rig.file));
  for (int i = 0; i < 10; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      const int fd = connectRaw(rig.file);
      [[maybe_unused]] const ssize_t sent = send(fd, "half a li", 9, MSG_NOSIGNAL);
      kill(getpid(), SIGKILL);
    }
    waitpid(child, nullptr, 0);
    EXPECT_EQ(*ask(rig.file, "alive"), "you said alive");
  }
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&] {
      for (int k = 0; k < 50; ++k) EXPECT_EQ(*ask(rig.file, "t"), "you said t");
    });
  for (std::thread& thread : threads) thread.join();
  for (const int fd : idle) close(fd);
}

TEST(Server, WakesUpToStop) {
  Rig rig("stop");
  EXPECT_TRUE(ask(rig.file, "x"));
  rig.server.reset();
  EXPECT_FALSE(ask(rig.file, "x"));
  EXPECT_FALSE(std::ifstream(rig.file).good());
}

TEST(Server, SaysWhoAsksAndWhenItHasGone) {
  Rig rig("peer");
  {
    auto client = Client::connect(rig.file);
    ASSERT_TRUE(client);
    ASSERT_TRUE(client->ask("first"));
    EXPECT_EQ(rig.last_peer.pid, getpid());
    EXPECT_EQ(rig.last_peer.uid, getuid());
    EXPECT_EQ(rig.left.load(), 0u);
  }
  for (int i = 0; i < 2000 && rig.left == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(rig.left.load(), rig.last_peer.id);
}

/// A server whose lines "give" carry a descriptor of an own file, and whose clients stay or listen once they said so.
struct GivingRig {
  explicit GivingRig(const char* name) : file(testing::TempDir() + name + std::to_string(getpid()) + ".sock") {
    server = std::move(*Server::listen(file));
    Server::Service service;
    service.answer = [this](const Peer& peer, const std::string& line, const std::vector<Descriptor>&) {
      if (line == "stay") staying.insert(peer.id);
      if (line == "listen") listening.insert(peer.id);
      if (line != "give") return Reply("you said " + line);
      return Reply("here", Descriptor(memfd_create("given", MFD_CLOEXEC)));
    };
    service.keep_alive = [this](const Peer& peer) {
      return KeepAlive{staying.count(peer.id) > 0, listening.count(peer.id) > 0};
    };
    service.news = [](const Peer&) { return "news\n"; };
    service.left = [this](const Peer& peer) { staying.erase(peer.id), listening.erase(peer.id); };
    server->start(std::move(service));
  }
  ~GivingRig() { server->stop(); }
  std::string file;
  std::unique_ptr<Server> server;
  std::set<uint64_t> staying, listening;  ///< the server's thread's
};

TEST(Server, TakesDescriptorsWithTheLineThatNamesThem) {
  Rig rig("files");
  const Descriptor a = memory("a"), b = memory("b"), c = memory("c");
  const std::string two = R"({"do":"add","file":"/x","files":["/x","/y"]})", one = R"({"do":"reload","files":["/z"]})";
  const int fd = connectRaw(rig.file);
  const int first[] = {a.get(), b.get()}, second[] = {c.get()};
  ASSERT_GT(sendWith(fd, "plain\n", {}), 0);  // the kernel may glue it to what follows
  ASSERT_EQ(sendWith(fd, two + "\n", first), static_cast<ssize_t>(two.size() + 1));
  ASSERT_EQ(sendWith(fd, one.substr(0, 9), second), 9);
  ASSERT_GT(sendWith(fd, one.substr(9) + "\n", {}), 0);
  shutdown(fd, SHUT_WR);
  EXPECT_EQ(readAll(fd), "you said plain\nyou said " + two + "\nyou said " + one + "\n");
  rig.server->stop();
  EXPECT_EQ(rig.given, ",a,b,c");
  close(fd);
}

TEST(Server, GivesDescriptorsToNoLineThatNamesNone) {
  Rig rig("stray");
  auto client = Client::connect(rig.file);
  ASSERT_TRUE(client);
  const Descriptor a = memory("a"), b = memory("b");
  const int stray[] = {a.get()}, meant[] = {b.get()};
  ASSERT_TRUE(client->askWith("no request", stray));
  ASSERT_TRUE(client->askWith(R"({"do":"add","file":"/x","files":["/x"]})", meant));
  rig.server->stop();
  EXPECT_EQ(rig.given, ",b");
}

TEST(Server, DropsWhoHeapsUpDescriptors) {
  Rig rig("heap");
  const Descriptor file = memory("x");
  const std::vector<int> many(kMostDescriptors, file.get());
  const int fd = connectRaw(rig.file);
  ASSERT_EQ(sendWith(fd, "half ", many), 5);
  ASSERT_TRUE(ask(rig.file, "another"));
  sendWith(fd, "a line", many);
  EXPECT_EQ(readAll(fd), "");
  EXPECT_EQ(*ask(rig.file, "and the next"), "you said and the next");
  close(fd);
}

TEST(Server, PassesADescriptorWithItsOwnLine) {
  GivingRig rig("give");
  auto client = Client::connect(rig.file);
  ASSERT_TRUE(client);
  for (int i = 0; i < 100; ++i) {
    auto reply = client->askForMore(i % 3 == 0 ? "give" : "something");
    ASSERT_TRUE(reply) << reply.error();
    EXPECT_EQ(reply->line, i % 3 == 0 ? "here" : "you said something");
    EXPECT_EQ(static_cast<bool>(reply->descriptor), i % 3 == 0);
    if (reply->descriptor) {
      EXPECT_EQ(write(reply->descriptor.get(), "x", 1), 1) << i;
    }
  }
}

TEST(Server, LeavesNoDescriptorBehindWhereNobodyReadsThem) {
  GivingRig rig("greedy");
  const auto open = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator());
  };
  const auto before = open();
  const int fd = connectRaw(rig.file);
  std::string lines;
  for (int i = 0; i < 50; ++i) lines += "give\n";
  ASSERT_GT(send(fd, lines.data(), lines.size(), MSG_NOSIGNAL), 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  close(fd);  // with all of them in its queue
  EXPECT_TRUE(ask(rig.file, "still there"));
  for (int i = 0; i < 2000 && open() > before; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(open(), before);
}

TEST(Server, TellsNewsToThoseWhoListenAlone) {
  GivingRig rig("news");
  const int deaf = connectRaw(rig.file), listener = connectRaw(rig.file);
  ASSERT_EQ(send(deaf, "hello\n", 6, MSG_NOSIGNAL), 6);
  ASSERT_EQ(send(listener, "listen\n", 7, MSG_NOSIGNAL), 7);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  char buffer[4096];
  std::string heard(buffer,
                    static_cast<size_t>(std::max<ssize_t>(recv(listener, buffer, sizeof buffer, MSG_DONTWAIT), 0)));
  EXPECT_EQ(heard.rfind("you said listen\nnews\nnews\n", 0), 0u) << heard;
  heard.assign(buffer, static_cast<size_t>(std::max<ssize_t>(recv(deaf, buffer, sizeof buffer, MSG_DONTWAIT), 0)));
  EXPECT_EQ(heard, "you said hello\n");
  close(deaf), close(listener);
}

TEST(Server, NeverDropsOneThatStays) {
  GivingRig rig("stay");
  std::vector<int> crowd;
  const int leader = connectRaw(rig.file);
  ASSERT_EQ(send(leader, "stay\n", 5, MSG_NOSIGNAL), 5);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  while (crowd.size() + 1 < Server::kMaxClients) crowd.push_back(connectRaw(rig.file));
  std::this_thread::sleep_for(std::chrono::nanoseconds(Server::kIdle + 100'000'000));
  for (size_t i = 0; i < Server::kMaxClients / 2; ++i) EXPECT_TRUE(ask(rig.file, "make room", 5));
  ASSERT_EQ(send(leader, "again\n", 6, MSG_NOSIGNAL), 6);
  EXPECT_EQ(readAll(leader), "you said stay\nyou said again\n");
  for (const int fd : crowd) close(fd);
  close(leader);
}

}  // namespace
}  // namespace hapticd::control
