/// `hapticd import`: converts Bezier patches into a model file, and closed surfaces into soft bodies.
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>

#include "cli/bezier_import.hpp"
#include "cli/command.hpp"
#include "cli/import_medial.hpp"
#include "scene/node.hpp"

namespace hapticd::cli {
namespace {

struct Options {
  std::string file, out, up = "y", outward = "auto";
  Placement placement;
  bool medial = false;
  MedialImport body;
};

/// The commonest mistake: triangles given where patches are read.
std::string medialHint(const std::string& file) {
  std::string kind = std::filesystem::path(file).extension().string();
  for (char& c : kind) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return kind == ".obj" || kind == ".stl" ? "\n  fix: an OBJ or STL needs --medial, which makes a soft body of it" : "";
}

int import(const Options& options) {
  if (options.medial) {
    MedialImport body = options.body;
    body.file = options.file;
    body.out = options.out;
    body.scale = options.placement.scale;
    return importMedial(body);
  }
  scene::Problems problems;
  const auto text = scene::readFile(options.file, scene::kMaxFileBytes, problems);
  printProblems(problems, stderr);
  if (!text) return kBadInput;
  auto model = parseBpt(*text, options.file);
  if (!model) return fail(kBadInput, model.error() + medialHint(options.file));
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

void addMedialOptions(CLI::App& command, Options& options) {
  MedialImport& body = options.body;
  CLI::Option* medial = command.add_flag("--medial", options.medial,
                                         "find the medial axis of a closed surface: a soft body of cones and slabs");
  command.add_option("--tolerance", body.tolerance, "m by which the body may differ; without it 1 % of its size")
      ->check(within(1e-7, 1.0))
      ->needs(medial);
  command.add_option("--samples", body.samples, "points on the surface; without it 20000")
      ->check(CLI::Range(100, 1'000'000))
      ->needs(medial);
  command.add_option("--spheres", body.most_spheres, "at most; without it 2000")
      ->check(CLI::Range(1, 100'000))
      ->needs(medial);
  command
      .add_option("--angle", body.least_angle,
                  "degrees between the feet of a medial point; larger: fewer branches toward edges; without it 60")
      ->check(within(0.0, 180.0))
      ->needs(medial);
  command.add_option("--stiffness", body.stiffness, "N/m, written to .yaml")->check(within(0.0, 1e6))->needs(medial);
  command.add_option("--damping", body.damping, "N s/m, likewise")->check(within(0.0, 1e6))->needs(medial);
  command.add_option("--mass", body.mass, "kg of a vertex, likewise")->check(within(0.0, 1e6))->needs(medial);
}

}  // namespace

void addImport(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "import", "Convert Bezier patches (.bpt) into a model file, or a closed surface into a soft body.");
  command
      ->add_option(
          "file", options->file,
          "patches: a count, then for each two degrees and its points; # is a comment. With --medial: .obj, .stl, "
          "or a model file with surfaces")
      ->required();
  command
      ->add_option("-o,--out,out", options->out,
                   "model file: .yaml or .json; - for standard output. With --medial: .ma or .yaml")
      ->required();
  CLI::Option* scale =
      command->add_option("--scale", options->placement.scale, "metres per unit of the file")->check(within(1e-9, 1e9));
  command->add_option("--fit", options->placement.fit, "scale so that the largest extent is this many metres")
      ->check(within(1e-6, 1e3))
      ->excludes(scale);
  command->add_flag("--center", options->placement.center, "put the middle of the bounding box at the origin");
  command->add_option("--up", options->up, "axis of the file that points up; the world's is y")
      ->check(CLI::IsMember({"x", "y", "z"}));
  command
      ->add_option("--outward", options->outward,
                   "which side is outside: auto (by enclosed volume), normal (Su x Sv) or reversed")
      ->check(CLI::IsMember({"auto", "normal", "reversed"}));
  addMedialOptions(*command, *options);
  command->footer(
      "Comment lines go with the data: credit and licence are kept.\n\n"
      "Example:\n  hapticd import config/models/teapot.bpt --up z --fit 0.13 --center -o teapot.yaml\n"
      "  hapticd import --medial hand.stl --scale 0.001 --tolerance 0.001 hand.ma");
  command->callback([options, &exit_code] { exit_code = import(*options); });
}

}  // namespace hapticd::cli
