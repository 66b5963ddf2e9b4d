// SPDX-License-Identifier: MIT
#include "cli/support/command.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <utility>
#include <vector>

#include "base/shell_word.hpp"
#include "document/json_text.hpp"
#include "hapticd/abi.h"

namespace hapticd::cli {
namespace {

struct Settings {
  std::string config_file;
  std::vector<std::filesystem::path> plugin_path;
};

Settings& settings() {
  static Settings instance;
  return instance;
}

/// Errors of modules that are kept for the message of a failing set-up.
struct PendingErrors {
  std::mutex mutex;
  bool open = false;
  std::vector<std::pair<std::string, std::string>> errors;  ///< sender and text of each error
};

PendingErrors& waiting() {
  static PendingErrors instance;
  return instance;
}

/// Returns the daemon file that is used, or "" if the defaults are used.
std::filesystem::path daemonFile() {
  if (!settings().config_file.empty()) return settings().config_file;
  if (const char* named = std::getenv("HAPTICD_CONFIG"); named != nullptr && named[0] != '\0') return named;
  std::error_code error;
  constexpr const char* kSystem = "/etc/hapticd/hapticd.yaml";
  if (std::filesystem::exists(kSystem, error)) return kSystem;
  return host::shippedFile("hapticd.yaml").value_or("");
}

}  // namespace

std::string wrongPicture(const std::string& file) {
  const std::string ending = std::filesystem::path(file).extension().string();
  for (const char* other : {".png", ".jpg", ".jpeg", ".pdf", ".gif", ".webp", ".PNG", ".JPG", ".PDF"})
    if (ending == other)
      return file + ": pictures are SVG, which every browser shows; expected a name that ends in .svg";
  return "";
}

SetupErrors::SetupErrors() {
  const std::lock_guard lock(waiting().mutex);
  waiting().open = true;
}

bool SetupErrors::holdsBack(int level, const std::string& who, const std::string& text) {
  const std::lock_guard lock(waiting().mutex);
  if (!waiting().open || level != HSP_LOG_ERROR) return false;
  waiting().errors.emplace_back(who, text);
  return true;
}

void SetupErrors::print() {
  const std::lock_guard lock(waiting().mutex);
  for (const auto& [who, text] : waiting().errors) std::fprintf(stderr, "error: %s: %s\n", who.c_str(), text.c_str());
  waiting().errors.clear();
  waiting().open = false;
}

int fail(int exit_code, const std::string& message) {
  {
    const std::lock_guard lock(waiting().mutex);
    std::erase_if(waiting().errors, [&](const auto& e) { return message.find(e.second) != std::string::npos; });
  }
  SetupErrors::print();
  std::fprintf(stderr, "error: %s\n", message.c_str());
  return exit_code;
}

int printJson(const nlohmann::ordered_json& json) {
  std::printf("%s\n", document::jsonLines(json).c_str());
  return kWorked;
}

void logToTerminal(int level, const std::string& who, const std::string& text) {
  if (level < HSP_LOG_INFO || SetupErrors::holdsBack(level, who, text)) return;
  const char* word = level == HSP_LOG_INFO ? "info" : level == HSP_LOG_WARNING ? "warning" : "error";
  std::fprintf(stderr, "%s: %s: %s\n", word, who.c_str(), text.c_str());
}

void addGlobalOptions(const Command& app) {
  app.addOption("--config", settings().config_file,
                "daemon file; default: $HAPTICD_CONFIG, /etc/hapticd/hapticd.yaml or the installed one");
  app.addOption("--plugin-path", settings().plugin_path,
                "folders that are searched first for plugins and device modules")
      .delimiter(':')
      .oneValueEach();  // the next word is the subcommand, or its file
}

const scene::Daemon& daemonSettings() {
  static const scene::Daemon daemon = [] {
    const std::filesystem::path file = daemonFile();
    if (file.empty()) return scene::Daemon{};
    const scene::LoadedDaemon loaded = scene::loadDaemon(file);
    printProblems(loaded.problems, stderr);
    if (!loaded.daemon) throw BadDaemonFile();
    return *loaded.daemon;
  }();
  return daemon;
}

void applyDaemonFile(scene::Scene& scene) {
  const scene::Daemon& daemon = daemonSettings();
  if (daemon.rate) scene.servo.rate = *daemon.rate;
  for (scene::Device& device : scene.devices)
    if (daemon.force && (device.limits.force == 0 || device.limits.force > *daemon.force))
      device.limits.force = *daemon.force;
}

std::string guide(const std::string& page) {
  const std::string source = "driver/docs/" + page;
  const auto file = host::ownFile("share/doc/hapticd/docs/" + page, source);
  return file ? file->string() : source;
}

host::Catalog& catalog() {
  static host::Catalog instance = [] {
    host::SearchPath path = host::SearchPath::standard();
    path.prepend(daemonSettings().plugin_path);
    path.prepend(settings().plugin_path);
    return host::Catalog(path);
  }();
  return instance;
}

void printProblems(const document::Problems& problems, std::FILE* out) {
  for (const document::Problem& problem : problems) std::fprintf(out, "%s\n", problem.text().c_str());
}

void printWarnings(document::Problems warnings, std::FILE* out) {
  for (document::Problem& warning : warnings) warning.what = "warning: " + warning.what;
  printProblems(warnings, out);
}

namespace {

/// Says that a scene of this name ships, if the file is absent and its name is one of those.
void printShippedScene(const std::string& file) {
  std::error_code error;
  const std::filesystem::path name = std::filesystem::path(file).filename();
  if (name.empty() || std::filesystem::exists(file, error)) return;
  for (const std::string& scene : {name.string(), name.string() + ".yaml"})
    if (const auto shipped = host::shippedFile("scenes/" + scene))
      std::fprintf(stderr, "  fix: a scene of this name ships: %s\n", shellWord(shipped->string()).c_str());
}

}  // namespace

std::optional<scene::Scene> loadSceneOrReport(const std::string& file, const std::string& device_file,
                                              bool default_device) {
  scene::Loaded loaded = scene::load(file, catalog(), {default_device, device_file});
  printProblems(loaded.problems, stderr);
  if (!loaded.scene) printShippedScene(file);
  if (loaded.scene) applyDaemonFile(*loaded.scene);
  return std::move(loaded.scene);
}

}  // namespace hapticd::cli
