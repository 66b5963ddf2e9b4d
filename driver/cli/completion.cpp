// SPDX-License-Identifier: MIT
/// `hapticd completion`: makes completion scripts for bash, zsh and fish from the option table.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cli/support/command.hpp"
#include "control/client.hpp"
#include "status/page_file.hpp"

namespace hapticd::cli {
namespace {

struct CompletionWord {
  std::string text, doc;
  std::vector<std::string> choices;  ///< what may follow an option
};

/// The program or one of its commands. The path is "" for the program itself, and "plugin info" for the command `info`
/// of `plugin`.
struct CommandNode {
  std::string path;
  std::vector<CompletionWord> words;
  bool files = false;  ///< whether an argument is a file
};

bool isFile(const Option& argument) {
  static const std::vector<std::string> kFiles = {"file", "files", "scene", "recording", "part", "capture", "numbers"};
  return std::find(kFiles.begin(), kFiles.end(), argument.positionalName()) != kFiles.end();
}

/// Returns the words of a value such as "{scene,device}"; returns an empty list for other values.
std::vector<std::string> choicesOf(const Option& option) {
  const std::string type = option.valueName();
  const size_t begin = type.find('{'), end = type.find('}');
  std::vector<std::string> words;
  if (begin == std::string::npos || end == std::string::npos || end < begin) return words;
  std::stringstream list(type.substr(begin + 1, end - begin - 1));
  for (std::string word; std::getline(list, word, ',');) words.push_back(word);
  return words;
}

void collect(const Command& app, const std::string& path, std::vector<CommandNode>& nodes) {
  CommandNode node{path, {}, false};
  for (const Command& command : app.subcommands()) node.words.push_back({command.name(), command.description(), {}});
  for (const Option& option : app.options()) {
    if (option.positional()) {
      node.files = node.files || isFile(option);
      for (const std::string& choice : choicesOf(option)) node.words.push_back({choice, "", {}});
    }
    for (const std::string& name : option.longNames())
      node.words.push_back({"--" + name, option.description(), choicesOf(option)});
  }
  nodes.push_back(std::move(node));
  for (const Command& command : app.subcommands())
    collect(command, path.empty() ? command.name() : path + " " + command.name(), nodes);
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

/// Makes a text safe for single quotes of a shell, and escapes the colon at which zsh splits.
std::string quoted(const std::string& text, bool zsh = false) {
  std::string result;
  for (const char c : text) {
    if (c == '\'') result += "'\\'";
    if (c == ':' && zsh) result += '\\';
    result += c;
  }
  return result;
}

/// Returns lines of shell, for bash and zsh, that find the command in the words before the cursor.
std::string findPath(const std::vector<CommandNode>& nodes, const std::string& words) {
  std::string text = "  local path_='' word_\n  for word_ in " + words + "; do\n    case \"$path_ $word_\" in\n      ";
  for (size_t i = 1; i < nodes.size(); ++i) {
    const size_t space = nodes[i].path.rfind(' ');
    const std::string above = space == std::string::npos ? "" : nodes[i].path.substr(0, space);
    const std::string name = space == std::string::npos ? nodes[i].path : nodes[i].path.substr(space + 1);
    text += (i == 1 ? "'" : " | '") + above + " " + name + "'";
  }
  return text + ") path_=\"${path_:+$path_ }$word_\" ;;\n    esac\n  done\n";
}

/// The commands whose argument is a name of the same kind. `completion --names KIND` lists the names of this kind.
struct Named {
  const char* kind;
  std::vector<const char*> paths;
};
const std::vector<Named>& namedArguments() {
  static const std::vector<Named> kNamed = {
      {"plugins", {"plugin info", "plugin clear"}},
      {"models",
       {"ctl enable", "ctl disable", "ctl remove", "ctl set", "ctl get", "ctl move", "ctl geometry", "ctl lead"}},
      {"parameters", {"ctl set", "ctl get"}},
      {"devices", {"ctl hold", "ctl clear"}},
      {"scenes", {"run", "trace", "explain", "tune", "check", "ctl reload", "ctl add"}},
      {"device-files",
       {"device info", "device calibrate", "device kinematics", "device decode", "device encode", "device record"}},
  };
  return kNamed;
}

std::string pattern(const Named& named) {
  std::string text;
  for (const char* path : named.paths) text += std::string(text.empty() ? "'" : " | '") + path + "'";
  return text;
}

std::string bash(const std::vector<CommandNode>& nodes) {
  std::string text = "# bash completion of hapticd; made with `hapticd completion bash`\n_hapticd() {\n";
  text += findPath(nodes, "\"${COMP_WORDS[@]:1:COMP_CWORD-1}\"");
  text += "  local known_='' files_=''\n  case \"$path_ ${COMP_WORDS[COMP_CWORD-1]}\" in\n";
  for (const CommandNode& node : nodes)
    for (const CompletionWord& word : node.words)
      if (!word.choices.empty())
        text += "    '" + node.path + " " + word.text + "') known_='" + joined(word.choices) + "' ;;\n";
  text += "    *)\n      case \"$path_\" in\n";
  for (const CommandNode& node : nodes) {
    std::vector<std::string> words;
    for (const CompletionWord& word : node.words) words.push_back(word.text);
    text += "        '" + node.path + "') known_='" + joined(words) + "'" + (node.files ? " files_=-f" : "") + " ;;\n";
  }
  text += "      esac\n";
  for (const Named& named : namedArguments())
    text += "      case \"$path_\" in " + pattern(named) + ") known_+=\" $(hapticd completion --names " + named.kind +
            " 2>/dev/null)\" ;; esac\n";
  text += "      ;;\n  esac\n";
  text +=
      "  mapfile -t COMPREPLY < <(compgen -W \"$known_\" -- \"${COMP_WORDS[COMP_CWORD]}\")\n"
      "  [[ -z $files_ || ${COMP_WORDS[COMP_CWORD]} == -* ]] || mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < "
      "<(compgen -f -- \"${COMP_WORDS[COMP_CWORD]}\")\n}\n";
  return text + "complete -o default -F _hapticd hapticd\n";
}

std::string zsh(const std::vector<CommandNode>& nodes) {
  std::string text =
      "#compdef hapticd\n# zsh completion of hapticd; made with `hapticd completion zsh`\n_hapticd() {\n";
  text += findPath(nodes, "${words[2,CURRENT-1]}");
  text += "  local -a known_\n  local files_=''\n  case \"$path_ ${words[CURRENT-1]}\" in\n";
  for (const CommandNode& node : nodes)
    for (const CompletionWord& word : node.words)
      if (!word.choices.empty())
        text += "    '" + node.path + " " + word.text + "') compadd -- " + joined(word.choices) + "; return ;;\n";
  text += "  esac\n  case \"$path_\" in\n";
  for (const CommandNode& node : nodes) {
    text += "    '" + node.path + "') known_=(\n";
    for (const CompletionWord& word : node.words) text += "      '" + word.text + ":" + quoted(word.doc, true) + "'\n";
    text += node.files ? "    ); files_=1 ;;\n" : "    ) ;;\n";
  }
  text += "  esac\n";
  for (const Named& named : namedArguments())
    text += "  case \"$path_\" in " + pattern(named) + ") compadd -- ${(f)\"$(hapticd completion --names " +
            named.kind + " 2>/dev/null)\"} ;; esac\n";
  return text + "  _describe -o hapticd known_\n  [[ -z $files_ ]] || _files\n}\n_hapticd \"$@\"\n";
}

std::string fishCondition(const std::string& path) {
  if (path.empty()) return "__fish_use_subcommand";
  std::string condition;
  std::stringstream parts(path);
  for (std::string part; parts >> part;)
    condition += (condition.empty() ? "" : "; and ") + ("__fish_seen_subcommand_from " + part);
  return condition;
}

std::string fish(const std::vector<CommandNode>& nodes) {
  std::string text = "# fish completion of hapticd; made with `hapticd completion fish`\n";
  for (const Named& named : namedArguments())
    for (const char* path : named.paths)
      text += "complete -c hapticd -n '" + fishCondition(path) + "' -a '(hapticd completion --names " + named.kind +
              " 2>/dev/null)'\n";
  for (const CommandNode& node : nodes) {
    const std::string condition = fishCondition(node.path);
    if (!node.files) text += "complete -c hapticd -n '" + condition + "' -f\n";
    for (const CompletionWord& word : node.words) {
      const bool option = word.text.rfind("--", 0) == 0;
      text +=
          "complete -c hapticd -n '" + condition + "' " + (option ? "-l " + word.text.substr(2) : "-a " + word.text);
      if (!word.choices.empty()) text += " -x -a '" + joined(word.choices) + "'";
      text += " -d '" + quoted(word.doc) + "'\n";
    }
  }
  return text;
}

/// Returns the list of this name in a running daemon's answer, or an empty list.
nlohmann::json listOfDaemon(const char* request, const std::string& name) {
  const auto answer = control::ask(status::runtimeFolderOf("hapticd") + "/hapticd.sock", request);
  const auto json = answer ? nlohmann::json::parse(*answer, nullptr, false) : nlohmann::json();
  return json.is_object() && json.contains(name) ? json[name] : nlohmann::json::array();
}

/// Returns the names of the "models" or "devices" of the running daemon.
std::vector<std::string> namesOfDaemon(const std::string& kind) {
  std::vector<std::string> names;
  for (const auto& one : listOfDaemon(R"({"do":"snapshot"})", kind)) names.push_back(one.value("name", ""));
  return names;
}

/// Returns the live parameters of all models of the running daemon, each once.
std::set<std::string> parametersOfDaemon() {
  std::set<std::string> names;
  for (const auto& model : listOfDaemon(R"({"do":"list"})", "models"))
    for (const auto& parameter : model.value("live_parameters", nlohmann::json::array()))
      names.insert(parameter.value("id", ""));
  return names;
}

/// Returns the files in the folder of a shipped file.
std::vector<std::string> filesIn(const char* one_of_them) {
  std::vector<std::string> names;
  const auto file = host::shippedFile(one_of_them);
  if (!file) return names;
  for (const auto& entry : std::filesystem::directory_iterator(file->parent_path()))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().string());
  std::sort(names.begin(), names.end());
  return names;
}

int printNames(const std::string& kind) {
  std::vector<std::string> names;
  if (kind == "models" || kind == "devices") names = namesOfDaemon(kind);
  if (kind == "parameters")
    for (const std::string& name : parametersOfDaemon()) names.push_back(name);
  if (kind == "scenes") names = filesIn("scenes/teapot.yaml");
  if (kind == "device-files") names = filesIn(scene::kDefaultDevice);
  if (kind == "plugins")
    for (const host::CatalogFile* file : catalog().files(host::Kind::kShape))
      for (const host::ClassInfo& info : file->classes) names.push_back(info.name);
  for (const std::string& name : names) std::printf("%s\n", name.c_str());
  return kWorked;
}

}  // namespace

void addCompletion(const Command& app, int& exit_code) {
  auto shell = std::make_shared<std::string>();
  const Command command = app.addSubcommand("completion", "Print the completion script of a shell.");
  command.addOption("shell", *shell, "bash, zsh or fish").oneOf({"bash", "zsh", "fish"});
  auto kind = std::make_shared<std::string>();
  command.addOption("--names", *kind, "print only the names that the script completes, not the script")
      .oneOf({"plugins", "models", "parameters", "devices", "scenes", "device-files"})
      .excludes("shell");
  command.footer("Example:\n  source <(hapticd completion bash)");
  command.callback([shell, kind, app, &exit_code] {
    if (!kind->empty()) return (void)(exit_code = printNames(*kind));
    if (shell->empty()) return (void)(exit_code = fail(kBadInput, "no shell given, expected bash, zsh or fish"));
    std::vector<CommandNode> nodes;
    collect(app, "", nodes);
    std::fputs((*shell == "bash" ? bash(nodes) : *shell == "zsh" ? zsh(nodes) : fish(nodes)).c_str(), stdout);
    exit_code = kWorked;
  });
}

}  // namespace hapticd::cli
