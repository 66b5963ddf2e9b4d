// SPDX-License-Identifier: MIT
/// For programs that contain all their plugins: this version loads no files and starts no processes.
#include <cstdlib>

#include "host/child.hpp"
#include "host/file_stamp.hpp"
#include "host/loader.hpp"

namespace hapticd::host {
namespace {

constexpr const char* kNoFiles = "this program cannot load files: it contains all its plugins";

}  // namespace

Result<void*> loadFile(const std::filesystem::path&) {
  return Error{kNoFiles};
}

Result<const void*> symbolOf(void*, const char*) {
  return Error{kNoFiles};
}

std::optional<FileStamp> stampOf(const std::filesystem::path&) {
  return std::nullopt;
}

// There are no child processes here, so a trail stays empty.
ChildProgress::ChildProgress() : mark_(nullptr) {}
ChildProgress::~ChildProgress() = default;
void ChildProgress::mark(uint32_t, const char*) noexcept {}
uint32_t ChildProgress::item() const noexcept {
  return 0;
}
const char* ChildProgress::call() const noexcept {
  return "";
}

void ChildProgress::beginPiece() noexcept {}
void ChildProgress::rest() noexcept {}
uint64_t ChildProgress::pieces() const noexcept {
  return 0;
}
void ChildProgress::answer() noexcept {}
bool ChildProgress::answered() const noexcept {
  return false;
}

Result<std::string> runInChild(const std::function<std::string()>& work, int, const ChildWatch&) {
  return work();
}

Result<std::string> runProgram(std::vector<std::string>, int) {
  return Error{"could not be tried: this program cannot start another"};
}

void answerParent(const std::function<std::string()>&) {
  std::abort();  // never called, because nothing starts this program as a child
}

}  // namespace hapticd::host
