// SPDX-License-Identifier: MIT
#include "base/descriptors.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <string>

namespace hapticd {
namespace {

struct Pair {
  explicit Pair(int kind = SOCK_STREAM) {
    int ends[2] = {-1, -1};
    EXPECT_EQ(socketpair(AF_UNIX, kind | SOCK_CLOEXEC, 0, ends), 0);
    a = Descriptor(ends[0]), b = Descriptor(ends[1]);
  }
  Descriptor a, b;
};

Descriptor memory(const std::string& text) {
  Descriptor file(memfd_create("test", MFD_CLOEXEC));
  EXPECT_EQ(pwrite(file.get(), text.data(), text.size(), 0), static_cast<ssize_t>(text.size()));
  return file;
}

std::string contentOf(int fd) {
  std::array<char, 64> text{};
  const ssize_t got = pread(fd, text.data(), text.size(), 0);
  return got > 0 ? std::string(text.data(), static_cast<size_t>(got)) : "";
}

bool isOpen(int fd) {
  return fcntl(fd, F_GETFD) >= 0;
}

TEST(Descriptors, ComeOutInOrderWithTheBytesAndCloseOnExec) {
  const Pair pair;
  const Descriptor one = memory("one"), two = memory("two");
  ASSERT_EQ(sendWith(pair.a.get(), "hello", std::array{one.get(), two.get()}), 5);
  std::array<char, 16> bytes{};
  std::vector<Descriptor> got;
  ASSERT_EQ(receiveWith(pair.b.get(), bytes, got), 5);
  ASSERT_EQ(got.size(), 2u);
  EXPECT_EQ(contentOf(got[0].get()), "one");
  EXPECT_EQ(contentOf(got[1].get()), "two");
  for (const Descriptor& fd : got) EXPECT_NE(fcntl(fd.get(), F_GETFD) & FD_CLOEXEC, 0);
  EXPECT_TRUE(isOpen(one.get())) << "the sender keeps its own";
}

TEST(Descriptors, BytesAloneBringNone) {
  const Pair pair;
  ASSERT_EQ(sendWith(pair.a.get(), "hello", {}), 5);
  std::array<char, 16> bytes{};
  std::vector<Descriptor> got;
  EXPECT_EQ(receiveWith(pair.b.get(), bytes, got), 5);
  EXPECT_TRUE(got.empty());
}

TEST(Descriptors, AMessageOfTheLargestSizeArrivesWhole) {
  const Pair pair(SOCK_SEQPACKET);
  const Descriptor file = memory("x");
  const std::vector<int> many(kMostDescriptors, file.get());
  ASSERT_EQ(sendWith(pair.a.get(), "m", many), 1);
  std::array<char, 4> bytes{};
  std::vector<Descriptor> got;
  ASSERT_EQ(receiveWith(pair.b.get(), bytes, got), 1);
  EXPECT_EQ(got.size(), kMostDescriptors);
}

TEST(Descriptors, MoreThanFitAreAnErrorAndNoneStaysOpen) {
  const Pair pair(SOCK_SEQPACKET);
  const Descriptor file = memory("x");
  EXPECT_EQ(sendWith(pair.a.get(), "m", std::vector<int>(kMostDescriptors + 1, file.get())), -1);
  EXPECT_EQ(errno, EMSGSIZE);
}

TEST(Descriptors, TheOtherEndClosedIsToldAsSuch) {
  Pair pair;
  pair.a = Descriptor();
  std::array<char, 4> bytes{};
  std::vector<Descriptor> got;
  EXPECT_EQ(receiveWith(pair.b.get(), bytes, got), 0);
  EXPECT_EQ(sendWith(pair.b.get(), "m", {}), -1) << "and no SIGPIPE";
  EXPECT_EQ(errno, EPIPE);
}

TEST(Descriptors, CloseWithTheirOwner) {
  int number = -1;
  {
    const Descriptor file = memory("x");
    number = file.get();
    EXPECT_TRUE(isOpen(number));
  }
  EXPECT_FALSE(isOpen(number));
}

}  // namespace
}  // namespace hapticd
