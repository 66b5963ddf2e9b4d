/// What a plugin or module file says of itself, copied out of it: valid whether the file is loaded or not.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace hapticd::host {

enum class Kind : uint8_t { kShape, kDevice };

/// hsp_param with owned strings.
struct ParamInfo {
  std::string id, unit, doc;
  uint32_t kind = 0, flags = 0;
  double min = 0, max = 0, def = 0;
  std::vector<std::string> choices;
  uint32_t columns = 0, min_count = 0, max_count = 0;
  std::optional<std::string> def_text;
};

/// hsp_class or hdv_class with owned strings.
struct ClassInfo {
  Kind kind = Kind::kShape;
  std::string id, name, version, license, doc;
  uint32_t flags = 0, abi_minor = 0;
  std::vector<ParamInfo> params;
  std::filesystem::path file;

  /// Index of a parameter, or -1.
  int indexOf(const std::string& param) const;
  std::vector<std::string> paramIds() const;
};

/// [main] The classes of a file that is a plugin, a module or both. Loads it in this process: constructors run.
Result<std::vector<ClassInfo>> describe(const std::filesystem::path& file);

/// [main] The same in a child process: a crash, a hang or an exit in a constructor becomes a message about that file.
Result<std::vector<ClassInfo>> describeInChild(const std::filesystem::path& file);

/// [any] The same by a program that is started for it: for a process whose threads must not feel a fork.
/// @param program hapticd itself
Result<std::vector<ClassInfo>> describeByProgram(const std::filesystem::path& program,
                                                 const std::filesystem::path& file);

/// The only argument but for the file when hapticd is started by describeByProgram().
constexpr const char* kDescribeForParent = "describe-for-parent";

/// [main] What hapticd does when it was started so. Ends the process.
[[noreturn]] void describeForParent(const std::filesystem::path& file);

}  // namespace hapticd::host
