// SPDX-License-Identifier: MIT
/// `hapticd plugin list|info|clear`: lists plugins, prints the documentation in their parameter tables, and takes them
/// out of quarantine.
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "cli/support/class_info.hpp"
#include "cli/support/command.hpp"
#include "host/file_stamp.hpp"
#include "watch/quarantine.hpp"

namespace hapticd::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kInQuarantine = "IN QUARANTINE: ";

std::string noteOf(const watch::QuarantinedPlugin& entry) {
  const auto found = catalog().shape(entry.plugin);
  if (!found || entry.holds(entry.plugin, host::identityOnDisk((*found)->file)))
    return std::string(kInQuarantine) + entry.reason + "; runs leave it out until: hapticd plugin clear " +
           entry.plugin;
  return "NOTE: " + entry.fileForPeople() + " ended a run by " + entry.reason +
         "; the file has changed since, or is another one, so it runs again; "
         "once it is repaired: hapticd plugin clear " +
         entry.plugin;
}

/// Returns why runs leave a plugin out, by the name of the plugin.
std::map<std::string, std::string> quarantineNotes() {
  std::map<std::string, std::string> notes;
  const auto dir = watch::stateDir();
  if (dir.empty()) return notes;
  for (const watch::QuarantinedPlugin& entry : watch::quarantined(dir)) {
    std::string& note = notes[entry.plugin];  // that of the newest build, unless the present one is in quarantine
    if (!note.starts_with(kInQuarantine)) note = noteOf(entry);
  }
  return notes;
}

int listPluginsJson() {
  Json json = classesJson(catalog().files(host::Kind::kShape), host::Kind::kShape);
  const auto notes = quarantineNotes();
  for (Json& plugin : json["plugins"]) {
    const auto note = notes.find(plugin["name"].get<std::string>());
    plugin["quarantine"] = note != notes.end() ? Json(note->second) : Json();
  }
  return printJson(json);
}

int list(bool details) {
  const auto files = catalog().files(host::Kind::kShape);
  printClasses(files, host::Kind::kShape, details, quarantineNotes());
  printUnusable(files);
  warnOfAbsentFolders();
  if (files.empty()) return fail(kFailed, "no plugin found\n" + searchedText(catalog().searchPath().plugins));
  return kWorked;
}

int info(const std::string& name, bool json) {
  auto found = catalog().shape(name);
  if (!found) return fail(kBadInput, found.error());
  const auto notes = quarantineNotes();
  const auto note = notes.find((*found)->name);
  if (json) {
    Json facts = classJson(**found);
    facts["quarantine"] = note != notes.end() ? Json(note->second) : Json();
    return printJson(facts);
  }
  printClass(**found);
  if (note != notes.end()) std::printf("\n%s\n", note->second.c_str());
  return kWorked;
}

int clear(const std::string& name) {
  const auto dir = watch::stateDir();
  if (dir.empty())
    return fail(kFailed,
                "no state folder is writable\n  fix: set HOME, XDG_STATE_HOME or STATE_DIRECTORY as for the daemon");
  auto cleared = watch::clearQuarantine(dir, name);
  if (!cleared) return fail(kFailed, cleared.error());
  if (*cleared) {
    std::printf("plugin '%s' may run again\n", name.c_str());
    return kWorked;
  }
  std::string known;
  for (const watch::QuarantinedPlugin& entry : watch::quarantined(dir)) known += " " + entry.plugin;
  return fail(kBadInput, "plugin '" + name + "' is not in quarantine; " +
                             (known.empty() ? "no plugin is" : "expected one of:" + known));
}

}  // namespace

void addPlugin(const Command& app, int& exit_code) {
  const Command command = app.addSubcommand("plugin", "Find, document, check and create shape plugins.");
  command.requireSubcommand();
  command.footer("Example:\n  hapticd plugin info nurbs_rigid");

  auto details = std::make_shared<bool>(false);
  const Command list_command =
      command.addSubcommand("list", "List every plugin that a scene can name, and every file that cannot be used.");
  list_command.addFlag("--files", *details, "show the file and licence of each");
  list_command.footer("Example:\n  HAPTICD_PLUGIN_PATH=~/my-plugins/build hapticd plugin list --files");
  auto json = std::make_shared<bool>(false);
  list_command.addFlag("--json", *json, "print JSON, with the parameters of each");
  list_command.callback([details, json, &exit_code] { exit_code = *json ? listPluginsJson() : list(*details); });

  auto crashed = std::make_shared<std::string>();
  const Command clear_command =
      command.addSubcommand("clear", "Take a plugin that crashed the daemon out of quarantine.");
  clear_command.addOption("name", *crashed, "name of the plugin, as in the crash message").required();
  clear_command.footer("Example:\n  hapticd plugin clear my_shape");
  clear_command.callback([crashed, &exit_code] { exit_code = clear(*crashed); });

  auto name = std::make_shared<std::string>();
  const Command info_command =
      command.addSubcommand("info", "Show the parameters of a plugin with unit, range and default.");
  info_command.addOption("name", *name, "name or id of the plugin").required();
  info_command.addFlag("--json", *json, "print JSON");
  info_command.footer("Example:\n  hapticd plugin info nurbs_rigid");
  info_command.callback([name, json, &exit_code] { exit_code = info(*name, *json); });
}

}  // namespace hapticd::cli
