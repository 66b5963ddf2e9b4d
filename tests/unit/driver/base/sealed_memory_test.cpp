// SPDX-License-Identifier: MIT
/// Whoever gets the descriptor can neither take the memory away nor, where it is said so, write to it.
#include "base/sealed_memory.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>

namespace hapticd {
namespace {

constexpr size_t kBytes = 5000;

TEST(SealedMemory, IsZeroedSharedAndOutlivesItsOwner) {
  auto memory = SealedMemory::create("test", kBytes, SealedMemory::Writers::kAll);
  ASSERT_TRUE(memory) << memory.error();
  EXPECT_GE((*memory)->bytes(), kBytes);
  for (size_t i = 0; i < (*memory)->bytes(); ++i) ASSERT_EQ((*memory)->data()[i], std::byte{0});
  auto shared = (*memory)->share();
  ASSERT_TRUE(shared) << shared.error();
  auto* seen = static_cast<char*>(mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_SHARED, shared->get(), 0));
  ASSERT_NE(seen, MAP_FAILED);
  seen[4999] = 'x';
  EXPECT_EQ((*memory)->data()[4999], std::byte{'x'});
  memory->reset();
  EXPECT_EQ(seen[4999], 'x');
  munmap(seen, kBytes);
}

TEST(SealedMemory, CannotBeMadeShorterLongerOrUnsealed) {
  auto memory = SealedMemory::create("test", kBytes, SealedMemory::Writers::kAll);
  ASSERT_TRUE(memory);
  const auto fd = (*memory)->share();
  EXPECT_EQ(ftruncate(fd->get(), 0), -1);
  EXPECT_EQ(errno, EPERM);
  EXPECT_EQ(ftruncate(fd->get(), 1 << 20), -1);
  EXPECT_EQ(fcntl(fd->get(), F_ADD_SEALS, F_SEAL_WRITE), -1);
  // A hole may be punched: the page comes back as zeros, and no access fails.
  (*memory)->data()[0] = std::byte{1};
  EXPECT_EQ(fallocate(fd->get(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0, kBytes), 0);
  EXPECT_EQ((*memory)->data()[0], std::byte{0});
}

TEST(SealedMemory, OfOneWriterCanBeReadAlone) {
  auto memory = SealedMemory::create("test", kBytes, SealedMemory::Writers::kOne);
  ASSERT_TRUE(memory) << memory.error();
  const auto fd = (*memory)->share();
  EXPECT_EQ(mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd->get(), 0), MAP_FAILED);
  EXPECT_EQ(write(fd->get(), "x", 1), -1);
  EXPECT_EQ(fallocate(fd->get(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0, kBytes), -1);
  void* seen = mmap(nullptr, kBytes, PROT_READ, MAP_SHARED, fd->get(), 0);
  ASSERT_NE(seen, MAP_FAILED);
  EXPECT_EQ(mprotect(seen, kBytes, PROT_READ | PROT_WRITE), -1);
  (*memory)->data()[1] = std::byte{'y'};
  EXPECT_EQ(static_cast<char*>(seen)[1], 'y');
  munmap(seen, kBytes);
}

TEST(SealedMemory, TakesNoMoreThanAnybodyCanNeed) {
  const auto memory = SealedMemory::create("test", SealedMemory::kMostBytes + 1, SealedMemory::Writers::kAll);
  ASSERT_FALSE(memory);
  EXPECT_NE(memory.error().find("bytes of memory"), std::string::npos) << memory.error();
}

}  // namespace
}  // namespace hapticd
