// SPDX-License-Identifier: MIT
/// A folder of its own for each test of the commands.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "run_program.hpp"

namespace hapticd::test {

namespace fs = std::filesystem;

class Commands : public testing::Test {
 protected:
  void SetUp() override {
    dir_ = fs::temp_directory_path() / ("hapticd-commands-" + std::to_string(::getpid()));
    fs::create_directories(dir_);
  }
  void TearDown() override { fs::remove_all(dir_); }
  std::string put(const std::string& name, const std::string& text) {
    std::ofstream(dir_ / name) << text;
    return (dir_ / name).string();
  }
  std::string get(const std::string& name) {
    std::stringstream text;
    text << std::ifstream(dir_ / name).rdbuf();
    return text.str();
  }
  fs::path dir_;
};

/// The modules that ship, not those of tests alone.
inline constexpr const char* kShipped = "HAPTICD_PLUGIN_PATH=" HAPTICD_BINARY_DIR "/" HAPTICD_MODULES "/devices";
inline constexpr const char* kArm = "hapticd-device: 1\nmodule: test_device\nhand: {mass: 0.2}\n";

}  // namespace hapticd::test
