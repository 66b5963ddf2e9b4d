// SPDX-License-Identifier: MIT
#include "record/recording.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "output_of.hpp"
#include "record/flight_ring.hpp"
#include "record/recording_file.hpp"
#include "sample_recording.hpp"

namespace hapticd::record {
namespace {

/// What an HDF5 library that is not ours reads: "rows first-tick last-tick sum-of-x events"; "" where there is none.
std::string readByPython(const std::string& file) {
  return outputOf("/usr/bin/python3 " HAPTICD_SOURCE_DIR "/tests/unit/driver/daemon/record/read_by_h5py.py " + file);
}

TEST(RecordingFile, GivesBackEveryRowWhateverTheSizeOfChunksAndPieces) {
  const std::string name = temporary("rows");
  for (const uint64_t chunk_bytes : {1u, 24u, 100u, 4096u})
    for (const uint64_t piece : {1u, 3u, 170u, 5000u}) {
      auto file = RecordingFile::create(name, specs(), about(), chunk_bytes);
      ASSERT_TRUE(file);
      write(**file, 0, 500, piece);
      ASSERT_TRUE((*file)->close());
      const auto recording = Recording::open(name);
      ASSERT_TRUE(recording) << recording.error();
      EXPECT_TRUE((*recording)->closed());
      EXPECT_FALSE((*recording)->blackBox());
      expectRows(*(*recording)->stream("ticks"), 0, 500);
    }
}

TEST(RecordingFile, IsReadByAnotherLibraryThroughAllLevelsOfTheIndex) {
  const std::string name = temporary("h5");
  for (const uint64_t rows : {0u, 1u, 63u, 64u, 65u, 4096u, 4097u, 10000u}) {
    auto file = RecordingFile::create(name, specs(), about(), 1);  // a row a chunk: 10,000 rows are three levels
    ASSERT_TRUE(file);
    write(**file, 0, rows, 100);
    ASSERT_TRUE((*file)->close());
    const double sum = 0.25 * static_cast<double>(rows) * (static_cast<double>(rows) - 1);
    char wanted[200];
    std::snprintf(wanted, sizeof wanted, "%llu %lld %.1f %llu hapticd-recording/1 hapticd: 1\n",
                  static_cast<unsigned long long>(rows), rows == 0 ? -1LL : static_cast<long long>(rows) - 1,
                  rows == 0 ? 0.0 : sum, static_cast<unsigned long long>((rows + 99) / 100));
    EXPECT_EQ(readByPython(name), wanted);
  }
}

TEST(RecordingFile, IsReadableWhereverItsWriterWasKilled) {
  const std::string name = temporary("killed");
  for (int attempt = 0; attempt < 8; ++attempt) {
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const pid_t child = fork();
    if (child == 0) {
      auto file = RecordingFile::create(name, specs(), about(), 512);
      for (uint64_t from = 0;; from += 50) {
        write(**file, from, 50, 50);
        if (!(*file)->publish()) _exit(1);
        if (from == 1000 && ::write(ready[1], "x", 1) != 1) _exit(1);
      }
    }
    char byte;
    ASSERT_EQ(::read(ready[0], &byte, 1), 1);
    usleep(static_cast<useconds_t>(700 * attempt));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const auto recording = Recording::open(name);
    ASSERT_TRUE(recording) << recording.error();
    EXPECT_FALSE((*recording)->closed());
    const uint64_t rows = (*recording)->stream("ticks")->rows();
    EXPECT_GE(rows, 1050u);
    EXPECT_EQ(rows % 50, 0u);
    expectRows(*(*recording)->stream("ticks"), 0, rows);
    const std::string read = readByPython(name), count = std::to_string(rows) + " ";
    // killed between the table's header and our own, the two may differ by one publish
    const std::string next = std::to_string(rows + 50) + " ";
    EXPECT_TRUE(read.rfind(count, 0) == 0 || read.rfind(next, 0) == 0) << read << "expected " << count;
  }
}

TEST(RecordingFile, SaysThatTheDiskIsFull) {
  auto file = RecordingFile::create("/dev/full", specs(), about());
  EXPECT_FALSE(file);
  EXPECT_NE(file.error().find("/dev/full"), std::string::npos);
}

/// As if the disk were full: no file of this process may grow.
TEST(RecordingFile, LeavesNoFileOnAFullDisk) {
  const std::string name = temporary("full");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit none{0, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &none);
  auto file = RecordingFile::create(name, specs(), about());
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().find("the file ends"), std::string::npos) << file.error();
  EXPECT_FALSE(std::filesystem::exists(name));
}

TEST(FlightRing, KeepsTheNewestRowsInOrder) {
  const std::string name = temporary("ring");
  auto ring = FlightRing::create(specs(100), about(), name);
  ASSERT_TRUE(ring) << ring.error();
  for (uint64_t tick = 0; tick < 1234; ++tick) {
    const Row row = rowOf(tick);
    std::memcpy((*ring)->next(0), &row, sizeof row);
    (*ring)->commit(0);
  }
  const auto box = Recording::open(name);
  ASSERT_TRUE(box) << box.error();
  EXPECT_TRUE((*box)->blackBox());
  expectRows(*(*box)->stream("ticks"), 1234 - 99, 99);
  EXPECT_EQ(readByPython(name).rfind("100 ", 0), 0u) << "the file is a table of all its slots";

  const std::string dumped = temporary("dump");
  ASSERT_TRUE((*ring)->dump(dumped));
  const auto copy = Recording::open(dumped);
  ASSERT_TRUE(copy) << copy.error();
  EXPECT_FALSE((*copy)->blackBox());
  expectRows(*(*copy)->stream("ticks"), 1234 - 99, 99);

  EXPECT_FALSE((*box)->closed());
  (*ring)->noteEnd();
  EXPECT_TRUE((*Recording::open(name))->closed()) << "programs that have mapped it know that the run ended in order";
  (*ring)->removeFile();
  EXPECT_FALSE(Recording::open(name));
}

/// A copy of the memory takes its bytes in any order, so the number of rows must not be taken from the copy.
TEST(FlightRing, IsReadWhileItIsWrittenWithoutRowsThatWereNotWrittenYet) {
  const std::string name = temporary("live");
  constexpr uint64_t kRows = 1 << 17;
  auto ring = FlightRing::create(specs(kRows), about(), name);
  ASSERT_TRUE(ring) << ring.error();
  std::atomic<bool> stop{false};
  std::thread writer([&] {
    for (uint64_t tick = 0; tick < kRows - 1 && !stop; ++tick) {
      const Row row = rowOf(tick);
      std::memcpy((*ring)->next(0), &row, sizeof row);
      (*ring)->commit(0);
      if (tick % 64 == 0) std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
  });
  uint64_t seen = 0, wrong = 0;
  while (seen < kRows - 1 && wrong == 0) {
    const auto box = Recording::open(name);
    if (!box) break;
    const RecordedStream& ticks = *(*box)->stream("ticks");
    for (uint64_t i = seen = ticks.rows(); i > 0 && i + 1000 > seen; --i)
      wrong += ticks.number(i - 1, *ticks.find("tick")) != static_cast<double>(i - 1);
  }
  stop = true;
  writer.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(seen, kRows - 1);
  (*ring)->removeFile();
}

/// Starts a process that opens the file again and again, and counts that, until it is killed, wherever it is then.
pid_t startReader(const std::string& file, std::atomic<uint64_t>& looks) {
  const pid_t child = fork();
  if (child == 0)
    for (;;) {
      if (!Recording::open(file)) _exit(1);
      ++looks;
    }
  return child;
}

TEST(FlightRing, KilledReadersChangeNothing) {
  const std::string file = testing::TempDir() + "killed_readers.h5";
  constexpr uint64_t kRows = 64;
  std::vector<StreamSpec> streams(1);
  streams[0].name = "ticks";
  streams[0].layout.add("tick", ColumnType::kCount, "", "number");
  streams[0].layout.add("twice", ColumnType::kCount, "", "twice that");
  streams[0].ring_rows = kRows;
  auto ring = FlightRing::create(streams, {"{\"columns\":" + columnsJson(streams) + "}", ""}, file);
  ASSERT_TRUE(ring) << ring.error();
  uint64_t written = 0;
  const auto write = [&] {
    const std::array<uint64_t, 2> row{written, 2 * written};
    std::memcpy((*ring)->next(0), row.data(), sizeof row);
    (*ring)->commit(0);
    ++written;
  };
  void* shared = mmap(nullptr, sizeof(uint64_t), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  auto& looks = *new (shared) std::atomic<uint64_t>(0);
  for (uint64_t reader = 0; reader < 20; ++reader) {
    const uint64_t enough = looks + 1 + reader;
    const pid_t child = startReader(file, looks);
    int status = 0;
    while (looks < enough && waitpid(child, &status, WNOHANG) == 0)
      for (int i = 0; i < 1000; ++i) write();
    ASSERT_GE(looks, enough) << "a reader met no recording";
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
  }
  munmap(shared, sizeof(uint64_t));
  EXPECT_EQ((*ring)->written(0), written);
  std::array<uint64_t, 2 * (kRows - 1)> rows{};
  ASSERT_EQ((*ring)->copy(0, written - kRows + 1, kRows - 1, reinterpret_cast<std::byte*>(rows.data())), kRows - 1);
  for (size_t i = 0; i < kRows - 1; ++i) {
    EXPECT_EQ(rows[2 * i], written - kRows + 1 + i);
    EXPECT_EQ(rows[2 * i + 1], 2 * rows[2 * i]);
  }
  (*ring)->removeFile();
}

TEST(FlightRing, SurvivesTheProcessThatWroteIt) {
  const std::string name = temporary("crash");
  const pid_t child = fork();
  if (child == 0) {
    auto ring = FlightRing::create(specs(50), about(), name);
    for (uint64_t tick = 0; tick < 70; ++tick) {
      const Row row = rowOf(tick);
      std::memcpy((*ring)->next(0), &row, sizeof row);
      (*ring)->commit(0);
    }
    kill(getpid(), SIGKILL);
  }
  waitpid(child, nullptr, 0);
  const auto box = Recording::open(name);
  ASSERT_TRUE(box) << box.error();
  expectRows(*(*box)->stream("ticks"), 70 - 49, 49);
}

TEST(FlightRing, NeverGivesAReaderARowThatWasOverwrittenMeanwhile) {
  auto ring = FlightRing::create(specs(64), about());
  ASSERT_TRUE(ring);
  constexpr uint64_t kTicks = 200000;
  std::thread writer([&] {
    for (uint64_t tick = 0; tick < kTicks; ++tick) {
      const Row row = rowOf(tick);
      std::memcpy((*ring)->next(0), &row, sizeof row);
      (*ring)->commit(0);
      if (tick % 32 == 0) std::this_thread::yield();
    }
  });
  uint64_t seen = 0, lost = 0;
  std::vector<Row> rows(16);
  for (uint64_t next = 0; next < kTicks;) {
    const uint64_t got = (*ring)->copy(0, next, rows.size(), reinterpret_cast<std::byte*>(rows.data()));
    for (uint64_t i = 0; i < got; ++i) ASSERT_EQ(rows[i].x, 0.5 * static_cast<double>(next + i));
    seen += got;
    next += got;
    const uint64_t end = (*ring)->written(0);
    if (got == 0 && end - next >= 64) {
      lost += end - 32 - next;
      next = end - 32;
    }
  }
  writer.join();
  EXPECT_EQ(seen + lost, kTicks);
}

TEST(FlightRing, IsReadInOrderWhileItIsOverwritten) {
  const std::string name = temporary("live");
  auto ring = FlightRing::create(specs(4096), about(), name);
  ASSERT_TRUE(ring) << ring.error();
  std::atomic<bool> ends{false};
  std::thread writer([&] {
    for (uint64_t tick = 0; !ends; ++tick) {
      const Row row = rowOf(tick);
      std::memcpy((*ring)->next(0), &row, sizeof row);
      (*ring)->commit(0);
    }
  });
  for (int i = 0; i < 200; ++i) {
    const auto box = Recording::open(name);
    if (!box) continue;  // no row yet
    const RecordedStream& ticks = *(*box)->stream("ticks");
    Row first{}, row{};
    for (uint64_t at = 0; at < ticks.rows(); ++at) {
      std::memcpy(&row, ticks.row(at), sizeof row);
      if (at == 0) first = row;
      EXPECT_EQ(row.x, first.x + 0.5 * static_cast<double>(at));
      if (HasFailure()) break;
    }
  }
  ends = true;
  writer.join();
}

TEST(Recording, RefusesWhatIsNoneAndSaysSo) {
  const std::string name = temporary("not");
  EXPECT_FALSE(Recording::open(name));
  std::ofstream(name) << "a text";
  EXPECT_NE(Recording::open(name).error().find("not a recording"), std::string::npos);
  EXPECT_NE(Recording::open("/").error().find("is a folder, expected a file"), std::string::npos);
}

TEST(Recording, ReadsTheRowsThatAreThereHoweverManyAreClaimed) {
  const std::string name = temporary("claims");
  auto file = RecordingFile::create(name, specs(), about(), 240);
  write(**file, 0, 95, 10);
  ASSERT_TRUE((*file)->close());
  const uint64_t claimed = UINT64_MAX;
  std::fstream(name, std::ios::in | std::ios::out | std::ios::binary)
      .seekp(kHeaderAt + offsetof(FileHeader, streams) + offsetof(StreamHeader, rows))
      .write(reinterpret_cast<const char*>(&claimed), sizeof claimed);
  const auto recording = Recording::open(name);
  ASSERT_TRUE(recording) << recording.error();
  EXPECT_EQ((*recording)->stream("ticks")->rows(), 100u);
}

}  // namespace
}  // namespace hapticd::record
