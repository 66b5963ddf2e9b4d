// SPDX-License-Identifier: MIT
#include "host/services.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace hapticd::host {
namespace {

TEST(Services, AllocatesAlignedZeroedCountedMemory) {
  Services services("x", nullptr);
  const hsp_host* host = services.abi();
  for (const size_t align : {1u, 8u, 64u, 4096u}) {
    auto* block = static_cast<unsigned char*>(host->alloc(host, 1000, align));
    ASSERT_NE(block, nullptr);
    EXPECT_EQ(reinterpret_cast<uintptr_t>(block) % align, 0u);
    for (size_t i = 0; i < 1000; ++i) ASSERT_EQ(block[i], 0);
    EXPECT_GE(services.lockedBytes(), 1000u);
    host->release(host, block);
    EXPECT_EQ(services.lockedBytes(), 0u);
  }
}

TEST(Services, RefusesWhatItCannotGiveAndSurvivesAWrongRelease) {
  Services services("x", nullptr);
  const hsp_host* host = services.abi();
  EXPECT_EQ(host->alloc(host, 0, 8), nullptr);
  EXPECT_EQ(host->alloc(host, SIZE_MAX - 5, 8), nullptr);
  EXPECT_EQ(host->alloc(host, 8, 3000), nullptr);
  void* block = host->alloc(host, 8, 8);
  host->release(host, block);
  host->release(host, block);
  host->release(host, nullptr);
  int elsewhere = 0;
  host->release(host, &elsewhere);
  EXPECT_EQ(services.lockedBytes(), 0u);
}

TEST(Services, KeepsTheNewestErrorAndNamesWhoSaidIt) {
  std::vector<std::string> lines;
  Services services("ball", [&](int level, const std::string& who, const std::string& text) {
    lines.push_back(std::to_string(level) + who + text);
  });
  const hsp_host* host = services.abi();
  host->log(host, HSP_LOG_ERROR, "first");
  host->log(host, HSP_LOG_ERROR, "second");
  host->log(host, HSP_LOG_INFO, "third");
  host->log(host, 99, nullptr);
  EXPECT_EQ(services.lastError(), "second");
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0], "3ballfirst");
  services.forgetError();
  EXPECT_EQ(services.lastError(), "");
}

TEST(Services, TraceKeepsOrderAndLosesWhatDoesNotFit) {
  Services services("x", nullptr);
  const hsp_host* host = services.abi();
  for (uint32_t i = 0; i < 1000; ++i) host->trace(host, i, i, 0);
  TraceEvent event;
  uint32_t count = 0;
  while (services.takeEvent(event)) EXPECT_EQ(event.event, count++);
  EXPECT_EQ(count, 64u);
}

TEST(Services, KnowsTheServoThread) {
  Services services("x", nullptr);
  const hsp_host* host = services.abi();
  EXPECT_EQ(host->is_rt_thread(host), 0);
  int inside = 0;
  std::thread([&] {
    Services::markServoThread();
    inside = host->is_rt_thread(host);
  }).join();
  EXPECT_EQ(inside, 1);
  EXPECT_EQ(host->is_rt_thread(host), 0);
}

}  // namespace
}  // namespace hapticd::host
