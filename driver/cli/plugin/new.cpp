// SPDX-License-Identifier: MIT
/// `hapticd plugin new`: creates a plugin to start from, as a copy of the template under another name.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include "base/shell_word.hpp"
#include "cli/support/command.hpp"
#include "host/build_folders.hpp"

namespace hapticd::cli {
namespace {

namespace fs = std::filesystem;

struct NewPluginArguments {
  std::string name, folder, language = "c++";
  bool moving = false;

  /// The folder of the template below that of the usual one; "" for the usual one.
  std::string kind() const { return moving ? "moving" : language == "c" ? "c" : ""; }
};

/// Returns true for a name that can be a file, a C++ identifier and a CMake target.
bool usablePluginName(const std::string& name) {
  if (name.empty() || name.size() > 40 || !std::islower(static_cast<unsigned char>(name[0]))) return false;
  for (const char c : name)
    if (!std::islower(static_cast<unsigned char>(c)) && !std::isdigit(static_cast<unsigned char>(c)) && c != '_')
      return false;
  return name != "template";
}

/// Returns a usable name that is like the given one, such as "my_ball" for "My-Ball".
std::string usableLike(const std::string& name) {
  std::string usable;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    usable += std::isalnum(byte) ? static_cast<char>(std::tolower(byte)) : '_';
  }
  usable.erase(0, std::min(usable.find_first_of("abcdefghijklmnopqrstuvwxyz"), usable.size()));
  return usablePluginName(usable) ? usable : "my_shape";
}

/// Turns "push_button" into "PushButton".
std::string camelCase(const std::string& name) {
  std::string text;
  bool upper = true;
  for (const char c : name) {
    if (c != '_') text += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    upper = c == '_';
  }
  return text;
}

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
  for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

std::string renamed(std::string text, const std::string& name) {
  for (const char* shape : {"TemplateBall", "TemplatePlate"}) replaceAll(text, shape, camelCase(name));
  replaceAll(text, "org.hapticd.shape.template", "org.example.shape." + name);
  for (const std::string kind : {"", " --language c", " --moving"})
    for (const std::string what : {"it", "this folder"})
      replaceAll(text, "`hapticd plugin new NAME" + kind + "` copies " + what + " under another name.",
                 "Made with `hapticd plugin new" + kind + "`.");
  replaceAll(text, "template", name);  // the template file uses no C++ template
  return text;
}

/// @param kind folder below that of the usual template, or ""
std::optional<fs::path> templateFolder(const std::string& kind) {
  if (const auto installed = host::shippedFile(kind.empty() ? "template" : "template/" + kind)) return installed;
  std::error_code error;
  const fs::path source = fs::path(host::buildFolders().source) / "plugins/template" / kind;
  return fs::is_directory(source, error) ? std::optional(source) : std::nullopt;
}

/// Returns the folder of the plugin interface's headers: that of the installation, or that of the source tree from
/// which the program was built.
fs::path includeFolder() {
  const auto header = host::ownFile("include/hapticd/shape.hpp", "driver/include/hapticd/shape.hpp");
  return header ? header->parent_path().parent_path() : fs::path("/usr/include");
}

/// Prints what to do next. The compiler's command comes first, because it works with and without an installed hapticd.
void printNextSteps(const std::string& folder, const std::string& name, bool c) {
  const auto in = [&](const std::string& file) { return shellWord((fs::path(folder) / file).string()); };
  const std::string at = shellWord(folder), library = in(name + ".so"), build = in("build");
  std::printf("\nbuild it:  %s -O2 -shared -fPIC -I %s %s -o %s%s\n", c ? "gcc -std=c11" : "g++ -std=c++20",
              shellWord(includeFolder().string()).c_str(), in(name + (c ? ".c" : ".cpp")).c_str(), library.c_str(),
              c ? " -lm" : "");
  std::printf("test it:   hapticd plugin check %s\n", library.c_str());
  std::printf("touch it:  hapticd --plugin-path %s run %s\n", at.c_str(), in("scene.yaml").c_str());
  std::printf("or with CMake, where hapticd is installed:  cmake -S %s -B %s && cmake --build %s\n", at.c_str(),
              build.c_str(), build.c_str());
  std::printf("for all users of this machine, after that:  sudo cmake --install %s\n", build.c_str());
}

/// Copies the template to a new folder, file by file, and prints their names.
Result<void> copyTemplate(const fs::path& source, const fs::path& target, const std::string& name) {
  for (const auto& entry : fs::directory_iterator(source)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream in(entry.path(), std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(in), {});
    const fs::path file = target / renamed(entry.path().filename().string(), name);
    std::ofstream out(file, std::ios::binary);
    out << renamed(text, name) << std::flush;
    if (!out)
      return Error{file.string() + ": cannot be written, expected a disk with room and a folder that you may write to"};
    std::printf("%s\n", file.c_str());
  }
  return {};
}

int makeNew(const NewPluginArguments& options) {
  if (!usablePluginName(options.name))
    return fail(kBadInput, "\"" + options.name +
                               "\" is not a valid name of a plugin, expected lower-case letters, digits and _, "
                               "beginning with a letter: " +
                               usableLike(options.name));
  const fs::path target = options.folder.empty() ? fs::path(options.name) : fs::path(options.folder);
  std::error_code error;
  if (fs::exists(target, error))
    return fail(kBadInput, target.string() + " exists already, expected the name of a new folder");
  const auto source = templateFolder(options.kind());
  if (!source)
    return fail(kFailed, "the template is not installed; expected it in share/hapticd/template beside this program");
  if (!fs::create_directories(target, error))
    return fail(kBadInput, target.string() + " cannot be created: " + error.message() +
                               ", expected a name in a folder that you may write to");
  if (const auto copied = copyTemplate(*source, target, options.name); !copied) {
    fs::remove_all(target, error);  // a folder that is not complete would block the next try
    return fail(kFailed, copied.error() + "; the new folder was removed");
  }
  printNextSteps(target.string(), options.name, options.language == "c");
  if (const auto same = catalog().shape(options.name))
    std::fprintf(stderr,
                 "warning: there is a plugin \"%s\" already, in %s: where both folders are searched, one hides the "
                 "other\n  fix: choose another name, unless you mean to replace it; "
                 "hapticd plugin list shows which one is used\n",
                 (*same)->name.c_str(), (*same)->file.c_str());
  return kWorked;
}

}  // namespace

void addPluginNew(const Command& app, int& exit_code) {
  auto options = std::make_shared<NewPluginArguments>();
  const Command command =
      app.subcommand("plugin").addSubcommand("new", "Create a new plugin from a template: source, build file, scene.");
  command.addOption("name", options->name, "name of the plugin: lower-case letters, digits and _").required();
  command.addOption("--dir", options->folder, "folder to create; default: NAME in the current folder");
  const auto language = command.addOption("--language", options->language, "c++, or c: plain C against hapticd/shape.h")
                            .oneOf({"c++", "c"})
                            .showDefault();
  command
      .addFlag("--moving", options->moving,
               "a shape that moves by itself under the forces of the hand: a plate on a spring")
      .excludes(language);
  command.footer("Example:\n  hapticd plugin new my_shape");
  command.callback([options, &exit_code] { exit_code = makeNew(*options); });
}

}  // namespace hapticd::cli
