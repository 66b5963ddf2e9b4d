/// `hapticd`: one program, a subcommand a file.
#include <exception>

#include "cli/command.hpp"
#include "cli/commands.hpp"  // made by the build: a declaration and a table entry for each subcommand

int main(int argc, char** argv) {
  using namespace hapticd::cli;
  CLI::App app{"hapticd: a real-time haptic servo daemon. Traces NURBS and medial-axis shapes and pushes back."};
  int exit_code = kWorked;
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("hapticd ") + HAPTICD_VERSION);
  app.footer(
      "Examples:\n"
      "  hapticd run config/scenes/teapot.yaml --for 10 --report report.json\n"
      "  hapticd check my-scene.yaml\n"
      "  hapticd plugin list\n\n"
      "Exit codes: 0 worked, 1 failed while running, 2 bad input or usage.");
  addGlobalOptions(app);
  for (const auto add : kCommands) add(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kWorked : kBadInput;
  } catch (const std::exception& error) {
    return fail(kFailed, error.what());
  }
  return exit_code;
}
