/// `hapticd import`: converts Bezier patches into a model file.
#include <cmath>
#include <fstream>
#include <memory>

#include "cli/bezier_import.hpp"
#include "cli/command.hpp"
#include "scene/node.hpp"

namespace hapticd::cli {
namespace {

struct Options {
  std::string file, out, up = "y", outward = "auto";
  Placement placement;
};

int import(const Options& options) {
  scene::Problems problems;
  const auto text = scene::readFile(options.file, scene::kMaxFileBytes, problems);
  printProblems(problems, stderr);
  if (!text) return kBadInput;
  auto model = parseBpt(*text, options.file);
  if (!model) return fail(kBadInput, model.error());
  Placement placement = options.placement;
  placement.up = options.up[0];
  placeModel(*model, placement);
  if (options.outward != "auto") model->reversed = options.outward == "reversed";

  const bool json = options.out.size() > 5 && options.out.substr(options.out.size() - 5) == ".json";
  const std::string result = json ? toModelJson(*model) : toModelYaml(*model);
  if (options.out == "-") {
    std::fputs(result.c_str(), stdout);
    return kWorked;
  }
  std::ofstream out(options.out, std::ios::binary);
  out << result << std::flush;
  if (!out)
    return fail(kFailed, options.out + ": cannot be written, expected a file in a folder that you may write to");
  std::printf("%s: %zu surfaces%s\n", options.out.c_str(), model->patches.size(),
              model->reversed ? ", outward reversed" : "");
  return kWorked;
}

}  // namespace

void addImport(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("import", "Convert Bezier patches (.bpt) into a model file.");
  command
      ->add_option("file", options->file, "patches: a count, then for each two degrees and its points; # is a comment")
      ->required();
  command->add_option("-o,--out", options->out, "model file: .yaml or .json; - for standard output")->required();
  CLI::Option* scale = command->add_option("--scale", options->placement.scale, "metres per unit of the file")
                           ->check(CLI::Range(1e-9, 1e9));
  command->add_option("--fit", options->placement.fit, "scale so that the largest extent is this many metres")
      ->check(CLI::Range(1e-6, 1e3))
      ->excludes(scale);
  command->add_flag("--center", options->placement.center, "put the middle of the bounding box at the origin");
  command->add_option("--up", options->up, "axis of the file that points up; the world's is y")
      ->check(CLI::IsMember({"x", "y", "z"}));
  command
      ->add_option("--outward", options->outward,
                   "which side is outside: auto (by enclosed volume), normal (Su x Sv) or reversed")
      ->check(CLI::IsMember({"auto", "normal", "reversed"}));
  command->footer(
      "Comment lines go with the data: credit and licence are kept.\n\n"
      "Example:\n  hapticd import config/models/teapot.bpt --up z --fit 0.13 --center -o teapot.yaml");
  command->callback([options, &exit_code] { exit_code = import(*options); });
}

}  // namespace hapticd::cli
