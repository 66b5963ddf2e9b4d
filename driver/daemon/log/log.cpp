// SPDX-License-Identifier: MIT
#include "log/log.hpp"

#include <spdlog/logger.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>

#include "hapticd/abi.h"

namespace hapticd::log {
namespace {

constexpr size_t kFileBytes = 10 << 20, kOldFiles = 3;
constexpr std::array kLevels{spdlog::level::debug, spdlog::level::info, spdlog::level::warn, spdlog::level::err};
constexpr std::array kNames{"debug", "info", "warning", "error"};
constexpr std::array kPriorities{"<7>", "<6>", "<4>",
                                 "<3>"};  // syslog priorities, which journald reads at the beginning of a line

enum class Target : uint8_t { kTerminal, kJournal, kPlain };

/// True if stderr goes to journald, which names the stream of a service by device and inode in JOURNAL_STREAM.
bool isJournal() {
  const char* stream = std::getenv("JOURNAL_STREAM");
  struct stat status{};
  if (stream == nullptr || fstat(STDERR_FILENO, &status) != 0) return false;
  return std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino) == stream;
}

Target targetOfStderr() {
  if (isatty(STDERR_FILENO) != 0) return Target::kTerminal;
  return isJournal() ? Target::kJournal : Target::kPlain;
}

/// Writes the name of a level: "warning", as in all messages of hapticd, and not "warn" as in spdlog.
class LevelWord : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& out) override {
    const auto found = std::find(kLevels.begin(), kLevels.end(), message.level);
    const std::string word = found != kLevels.end() ? kNames[static_cast<size_t>(found - kLevels.begin())] : "error";
    out.append(word.data(), word.data() + word.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override { return std::make_unique<LevelWord>(); }
};

std::unique_ptr<spdlog::formatter> pattern(const char* text) {
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<LevelWord>('*').set_pattern(text);
  return formatter;
}

std::unique_ptr<spdlog::formatter> patternFor(Target target, bool json) {
  if (json || target == Target::kJournal) return pattern("%v");
  // The status line of a run is on the terminal. The message overwrites it, and the run prints it again below.
  if (target == Target::kTerminal) return pattern("\r\033[K%H:%M:%S.%e %^%*%$: %v");
  return pattern("%Y-%m-%d %H:%M:%S.%e %*: %v");
}

struct Log {
  std::unique_ptr<spdlog::logger> stderr_logger, file_logger;
  Target target = Target::kPlain;
  bool json = false;
};

std::unique_ptr<spdlog::logger> logger(spdlog::sink_ptr sink, Target target, const Settings& settings) {
  auto made = std::make_unique<spdlog::logger>("hapticd", std::move(sink));
  made->set_formatter(patternFor(target, settings.json));
  made->set_level(kLevels[static_cast<size_t>(settings.level)]);
  made->flush_on(spdlog::level::debug);
  made->set_error_handler([](const std::string&) {});
  return made;
}

Log make(const Settings& settings) {
  Log log;
  log.target = targetOfStderr();
  log.json = settings.json;
  const auto colour = std::getenv("NO_COLOR") != nullptr ? spdlog::color_mode::never : spdlog::color_mode::automatic;
  log.stderr_logger = logger(std::make_shared<spdlog::sinks::stderr_color_sink_mt>(colour), log.target, settings);
  if (!settings.file.empty()) {
    auto sink = std::make_shared<spdlog::sinks::rotating_file_sink_mt>(settings.file, kFileBytes, kOldFiles);
    log.file_logger = logger(std::move(sink), Target::kPlain, settings);
  }
  return log;
}

Log& instance() {
  static Log log = make({});
  return log;
}

std::string jsonLine(int32_t level, const std::string& who, const std::string& text) {
  const auto now = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  const nlohmann::ordered_json line = {
      {"time", now}, {"level", kNames[static_cast<size_t>(level)]}, {"who", who}, {"text", text}};
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Puts the priority before every line of a message, because journald takes a line without one for information.
std::string journalLines(int32_t level, const std::string& text) {
  const std::string priority = kPriorities[static_cast<size_t>(level)];
  std::string lines = priority;
  for (const char c : text) {
    lines += c;
    if (c == '\n') lines += priority;
  }
  return lines;
}

}  // namespace

Result<void> open(const Settings& settings) {
  try {
    instance() = make(settings);
  } catch (const spdlog::spdlog_ex&) {
    return Error{"--log-file " + settings.file +
                 ": cannot be written, expected a file in a folder that you may write to"};
  }
  return {};
}

void write(int32_t level, const std::string& who, const std::string& text) {
  level = std::clamp<int32_t>(level, HSP_LOG_DEBUG, HSP_LOG_ERROR);
  Log& log = instance();
  const spdlog::level::level_enum spdlog_level = kLevels[static_cast<size_t>(level)];
  const std::string words = who.empty() ? text : who + ": " + text;
  const std::string line = log.json ? jsonLine(level, who, text) : words;
  const bool journal = log.target == Target::kJournal && !log.json;
  log.stderr_logger->log(spdlog_level, spdlog::string_view_t(journal ? journalLines(level, words) : line));
  if (log.file_logger) log.file_logger->log(spdlog_level, spdlog::string_view_t(line));
}

int32_t levelOf(const std::string& name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  return found == kNames.end() ? -1 : static_cast<int32_t>(found - kNames.begin());
}

}  // namespace hapticd::log
