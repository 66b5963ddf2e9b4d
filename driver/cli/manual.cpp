// SPDX-License-Identifier: MIT
/// `hapticd manual`: prints manual pages (man(7) source) that are made from the program's tables, so that they agree
/// with the program: hapticd(1) from the option table, hapticd.yaml(5) from the tables of keys.
#include <memory>
#include <string>

#include "cli/support/command.hpp"
#include "scene/format.hpp"

namespace hapticd::cli {
namespace {

/// Escapes the characters that are special to troff.
std::string plain(const std::string& text) {
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    const bool line_start = i == 0 || text[i - 1] == '\n';
    if (line_start && (text[i] == '.' || text[i] == '\'')) result += "\\&";
    if (text[i] == '\\')
      result += "\\e";
    else if (text[i] == '-')
      result += "\\-";
    else
      result += text[i];
  }
  return result;
}

std::string header(const std::string& name, int section) {
  return ".TH \"" + name + "\" \"" + std::to_string(section) + "\" \"\" \"hapticd " HAPTICD_VERSION "\" \"hapticd\"\n";
}

std::string verbatim(const std::string& text) {
  return ".PP\n.nf\n" + plain(text) + "\n.fi\n";
}

std::string optionText(const Option& option) {
  std::string names = option.positional() ? option.positionalName() : option.allNames();
  if (!option.positional() && !option.valueName().empty()) names += " " + option.valueName();
  return ".TP\n.B " + plain(names) + "\n" + plain(option.description()) + "\n";
}

std::string commandText(const Command& command, const std::string& above) {
  const std::string name = above + command.name();
  std::string text = ".SS " + plain(name) + "\n" + plain(command.description()) + "\n";
  for (const Option& option : command.options())
    if (!option.isHelp()) text += optionText(option);
  if (!command.footer().empty()) text += verbatim(command.footer());
  for (const Command& below : command.subcommands()) text += commandText(below, name + " ");
  return text;
}

std::string programPage(const Command& app) {
  std::string text = header("HAPTICD", 1);
  text += ".SH NAME\nhapticd \\- real\\-time haptic servo daemon\n";
  text += ".SH SYNOPSIS\n.B hapticd\n[\\fIOPTIONS\\fR] \\fICOMMAND\\fR [\\fIARGUMENTS\\fR]\n";
  text += ".SH DESCRIPTION\n" + plain(app.description()) + "\n";
  text += "Scenes, devices and the daemon's own settings are YAML files: see\n.BR hapticd.yaml (5).\n";
  text += ".SH OPTIONS\n";
  for (const Option& option : app.options()) text += optionText(option);
  text += ".SH COMMANDS\n";
  for (const Command& command : app.subcommands()) text += commandText(command, "");
  text += ".SH EXIT STATUS\n0 success, 1 failure while running, 2 bad input or usage.\n";
  text +=
      ".SH ENVIRONMENT\n.TP\n.B HAPTICD_PLUGIN_PATH\nfolders searched for shape plugins, separated by colons\n"
      ".TP\n.B HAPTICD_DEVICE_PATH\nfolders searched for device modules, separated by colons\n"
      ".TP\n.B HAPTICD_CONFIG\nthe daemon file\n";
  text +=
      ".SH FILES\n.TP\n.I /etc/hapticd/hapticd.yaml\nthe daemon file of this machine\n"
      ".TP\n.I /etc/hapticd/scene.yaml\nthe scene that the systemd unit runs\n";
  return text + ".SH SEE ALSO\n.BR hapticd.yaml (5),\n.BR hapticd\\-shape (7),\n.BR hapticd\\-device (7)\n";
}

std::string keyText(const document::Key& key, const std::string& above) {
  const std::string name = above + key.name;
  std::string text = ".TP\n.B " + plain(name) + "\n" + plain(key.doc) + " Expected: " + plain(key.expected()) + ".";
  if (key.required) text += " Required.";
  if (key.def != nullptr) text += " Default: " + plain(key.def) + ".";
  text += "\n";
  if (key.table != nullptr)
    for (const document::Key& below : key.table->keys)
      text += keyText(below, name + (key.type == document::Type::kList ? "[]." : "."));
  return text;
}

std::string filesPage() {
  std::string text = header("HAPTICD.YAML", 5);
  text += ".SH NAME\nhapticd.yaml \\- scene, device and daemon files of hapticd\n.SH DESCRIPTION\n";
  text +=
      "The first key of a file names its format. Units are SI; quaternions are w, x, y, z; the world has x to the "
      "right,\ny up, z toward the user. Paths are relative to the file that names them. Unknown keys are errors.\n.B "
      "hapticd check\nprints every problem of a file,\n.B hapticd check \\-\\-schema\na JSON Schema for editors,\n.B "
      "hapticd plugin info\nand\n.B hapticd device info\nthe parameters of a plugin and of an arm.\n";
  for (const scene::Format& format : scene::kFormats) {
    text += ".SH " + std::string(format.name) + " file (begins with " + format.key + ":)\n" + plain(format.doc) + "\n";
    for (const document::Key& key : format.table->keys) text += keyText(key, "");
  }
  return text + ".SH SEE ALSO\n.BR hapticd (1)\n";
}

}  // namespace

void addManual(const Command& app, int& exit_code) {
  auto page = std::make_shared<std::string>();
  const Command command =
      app.addSubcommand("manual", "Print a manual page that is made from the program's own tables.");
  command.addOption("page", *page, "hapticd or hapticd.yaml").required().oneOf({"hapticd", "hapticd.yaml"});
  command.footer("Example:\n  hapticd manual hapticd.yaml | man -l -");
  command.callback([page, app, &exit_code] {
    std::fputs((*page == "hapticd" ? programPage(app) : filesPage()).c_str(), stdout);
    exit_code = kWorked;
  });
}

}  // namespace hapticd::cli
