// SPDX-License-Identifier: MIT
/// `hapticd import`: converts CAD files and triangle meshes into parts, Bezier patches into a model file, and closed
/// surfaces into soft bodies.
#include <algorithm>
#include <filesystem>
#include <memory>

#include "base/file_ending.hpp"
#include "base/regular_file.hpp"
#include "base/shell_word.hpp"
#include "cli/import/cad.hpp"
#include "cli/import/file_content.hpp"
#include "cli/import/mesh.hpp"
#include "cli/import/patches.hpp"
#include "cli/import/scene.hpp"
#include "cli/support/command.hpp"
#include "cli/support/model_file.hpp"
#include "cli/support/output_file.hpp"
#include "import/calibrate.hpp"
#include "import/medial_import.hpp"
#include "mesh_import/mesh_file.hpp"

namespace hapticd::cli {

using namespace importing;
namespace {

struct ImportArguments {
  std::string file, out, scene, up = "y", outward = "auto";
  Placement placement;
  bool medial = false;
  MedialImport body;
  std::string answers, dents;  ///< input for the calibration of a soft body
  std::string material;        ///< first option that was given for the material of a soft body, or ""
  double smooth_angle = 0;
  CadImport cad;
  bool json = false;
};

/// Returns how to convert a file of a common format that hapticd does not read, or "" for any other file.
std::string otherCommand(const std::string& file) {
  const std::string ending = endingOf(file);
  const auto is = [&](std::initializer_list<const char*> endings) {
    return std::any_of(endings.begin(), endings.end(), [&](const char* one) { return ending == one; });
  };
  if (is({".fcstd", ".sldprt", ".x_t", ".3dm"}))
    return file + ": " + ending +
           " files are not read\n  in a CAD program save it as STEP, then: hapticd import PART.step -o PART.hpart";
  if (is({".gltf", ".glb", ".fbx", ".dae", ".blend", ".3mf", ".off", ".wrl", ".x3d"}))
    return file + ": " + ending +
           " files are not read\n  export the mesh as .obj, .stl or .ply, then: hapticd import PART.stl -o PART.hpart";
  return "";
}

/// Returns a message about options that have no effect with this format, or "".
std::string misplaced(const ImportArguments& options, bool cad) {
  if (!options.material.empty() && std::filesystem::path(options.out).extension() == ".ma")
    return options.material +
           " has no effect: a .ma file holds no material, expected a file to write that ends in .yaml; of a .ma "
           "file the scene gives stiffness, damping and mass";
  if (options.outward != "auto" && (cad || options.medial || isMeshFile(options.file)))
    return "--outward has an effect only with .bpt files; triangles and CAD faces are turned outward by the volume "
           "that they enclose";
  if (!cad && options.cad.check) return "--check has an effect only with CAD files (.step, .iges, .brep)";
  if (options.out.empty() && !options.cad.check)
    return "--out is required: the name of the file to write, such as part.hpart, or model.yaml for patches";
  return "";
}

/// Returns why the file to write must not be replaced, or "". A medial mesh (.ma) begins like any list of numbers, so
/// it has no kind and only the inputs are kept.
std::string whyKept(const ImportArguments& options) {
  const std::string ending = std::filesystem::path(options.out).extension().string();
  const OutputKind any{"a file", {""}};
  const OutputKind& kind = ending == ".hpart" ? partKind() : ending == ".ma" ? any : modelKind();
  return whyNotWritten(
      options.out, kind,
      {{options.file, "the input"}, {options.answers, "the file of presses"}, {options.dents, "the file of dents"}});
}

int importCadFile(const ImportArguments& options) {
  CadImport how = options.cad;
  how.file = options.file;
  how.out = options.out;
  how.json = options.json;
  how.placement = options.placement;
  how.placement.up = options.up[0];
  return importCad(how);
}

int importSoftBody(const ImportArguments& options) {
  MedialImport body = options.body;
  body.file = options.file;
  body.out = options.out;
  body.placement = options.placement;
  body.placement.up = options.up[0];
  const auto mesh = readSurface(body, catalog());
  if (!mesh) return failLines(kBadInput, mesh.error());
  const auto done = importMedial(body, *mesh, catalog());
  return done ? kWorked : fail(kFailed, done.error());
}

/// Returns why a file cannot be imported, and what to do instead; "" if nothing is known against it.
std::string whyNotImported(const ImportArguments& options) {
  const std::string& file = options.file;
  const bool part = std::filesystem::path(file).extension() == ".hpart";
  if (part && options.medial)
    return file +
           ": --medial takes a closed surface of triangles, not a part\n  fix: give it the mesh of which the part was "
           "made, or one that a CAD program exports";
  const bool model = !options.medial && options.answers.empty() && modelFileOf(file) != ModelFile::kNone;
  if (part || model)
    return file + ": is a " + (part ? "part" : "model file") +
           " already, whose size and place stay\n  fix: hapticd import " + shellWord(file) +
           " --scene SCENE.yaml writes a scene for it, hapticd view " + shellWord(file) + " shows it";
  if (std::string better = otherCommand(file); !better.empty()) return better;
  if (std::string other = misnamed(file); !other.empty()) return other;
  if (std::error_code error; !std::filesystem::exists(file, error)) return file + ": there is no such file";
  if (options.medial && isCadFile(file))
    return file +
           ": --medial takes a closed surface of triangles, not CAD\n  fix: export a mesh in a CAD program, then: "
           "hapticd import --medial BODY.stl BODY.ma";
  if (const std::string wrong = misplaced(options, isCadFile(file)); !wrong.empty()) return file + ": " + wrong;
  if (std::string kept = whyKept(options); !kept.empty()) return kept;
  return options.out == "-" ? "" : whyNotWritable(options.out);
}

int importAnswers(const ImportArguments& options) {
  if (endingOf(options.file) == ".ma" || isMeshFile(options.file))
    return fail(kBadInput, options.file +
                               ": holds no material, expected a model file (.yaml) of a soft body\n  fix: hapticd "
                               "import --medial MESH.stl -o BODY.yaml makes one");
  const auto done = calibrate({options.file, options.answers, options.dents, options.out}, catalog());
  return done ? kWorked : fail(kBadInput, done.error());
}

int importModel(const ImportArguments& options) {
  if (const std::string wrong = whyNotImported(options); !wrong.empty()) return fail(kBadInput, wrong);
  if (isCadFile(options.file)) return importCadFile(options);
  if (options.medial) return importSoftBody(options);
  if (!options.answers.empty()) return importAnswers(options);
  Placement placement = options.placement;
  placement.up = options.up[0];
  if (isMeshFile(options.file))
    return importMesh({options.file, options.out, "", placement, options.smooth_angle, options.json});
  return importPatches({options.file, options.out, "", placement, options.outward});
}

/// Writes a scene for a model that was made before.
int sceneOfModel(const ImportArguments& options, bool soft) {
  const Placement& placement = options.placement;
  if (placement.scale != 1 || placement.fit > 0 || placement.center || options.up != "y")
    return fail(kBadInput, options.file +
                               ": is made already, so its size and place stay, expected --scene alone\n  fix: import "
                               "again what it was made of, with --out");
  if (const std::string wrong = whyNoScene(options.scene, options.file); !wrong.empty()) return fail(kBadInput, wrong);
  return writeFirstScene({options.file, options.file, options.scene, placement, soft, options.json});
}

/// Says how to see and feel what was written.
void printNext(const std::string& model) {
  const std::string name = shellWord(model);
  std::printf(
      "\nthen:\n  hapticd view %s    # look at it\n"
      "  hapticd import %s --scene SCENE.yaml    # write a scene, to feel it\n",
      name.c_str(), name.c_str());
}

/// Imports the model, and writes a scene for it if one is asked for.
int importAll(const ImportArguments& options) {
  const ModelFile kind = modelFileOf(options.file);
  if (options.out.empty() && !options.scene.empty() && !options.medial && kind != ModelFile::kNone)
    return sceneOfModel(options, kind == ModelFile::kSoft);
  if (options.scene.empty()) {
    const int code = importModel(options);
    if (code == kWorked && !options.json && !options.cad.check && options.out != "-") printNext(options.out);
    return code;
  }
  if (options.out.empty())
    return fail(kBadInput, options.file +
                               ": --scene writes a scene that names a model, so --out is required: the name of "
                               "the model to write, such as part.hpart");
  if (const std::string wrong = whyNoScene(options.scene, options.out); !wrong.empty()) return fail(kBadInput, wrong);
  if (const int code = importModel(options); code != kWorked) return code;
  Placement placement = options.placement;
  placement.up = options.up[0];
  return writeFirstScene({options.file, options.out, options.scene, placement, options.medial, options.json});
}

/// The material of a soft body. Only a model file (.yaml) holds it: that of a .ma file stands in the scene.
constexpr const char* kMaterial[] = {"--stiffness", "--young", "--poisson", "--thickness", "--damping", "--mass"};

void addMaterialOptions(const Command& command, const Option& medial, MedialImport& body) {
  const Option stiffness =
      command.addOption("--stiffness", body.stiffness, "stiffness [N/m], written to a .yaml file; default: 300")
          .within(0.0, 1e6)
          .needs(medial);
  const Option young =
      command
          .addOption("--young", body.young, "Young's modulus of tissue on something rigid [Pa], instead of --stiffness")
          .within(1.0, 1e9)
          .needs(medial)
          .excludes(stiffness);
  command.addOption("--poisson", body.poisson, "its Poisson's ratio; default: 0.45").within(0.0, 0.5).needs(young);
  young.needs(command.addOption("--thickness", body.thickness, "its thickness [m]").within(1e-5, 1.0).needs(young));
  command.addOption("--damping", body.damping, "damping [N s/m], written to a .yaml file; default: 0.5")
      .within(0.0, 1e6)
      .needs(medial);
  command
      .addOption("--mass", body.mass,
                 "mass of a vertex [kg], written to a .yaml file; default: 0.01, and 2 kg in all at most")
      .within(0.0, 1e6)
      .needs(medial);
}

void addMedialOptions(const Command& command, ImportArguments& options) {
  MedialImport& body = options.body;
  const Option medial = command.addFlag("--medial", options.medial,
                                        "make a soft body of cones and slabs from the medial axis of a closed surface");
  command.addOption("--tolerance", body.tolerance, "largest error of the body [m]; default: 1 % of its size")
      .within(1e-7, 1.0)
      .needs(medial);
  command.addOption("--samples", body.samples, "number of points on the surface; default: 20000")
      .wholeWithin(100, 1'000'000)
      .needs(medial);
  command.addOption("--spheres", body.most_spheres, "largest number of spheres; default: 2000")
      .wholeWithin(1, 100'000)
      .needs(medial);
  command
      .addOption("--angle", body.least_angle,
                 "smallest angle between the feet of a medial point [degrees]; larger values give fewer branches "
                 "toward edges; default: 60")
      .within(0.0, 180.0)
      .needs(medial);
  addMaterialOptions(command, medial, body);
  const Option calibrate =
      command
          .addOption("--calibrate", options.answers,
                     "fit the stiffness of a soft body (a model file with points or vertices) to measured or computed "
                     "presses of small strain: CSV x,y,z,depth,force [m, N]")
          .excludes(medial);
  command
      .addOption("--dents", options.dents,
                 "with --calibrate: also fit shear_reach, from a CSV x,y,z,x2,y2,z2,dent; dent is how far the second "
                 "point sinks when the first is pressed, divided by the depth of the press")
      .needs(calibrate);
}

void addPlacementOptions(const Command& command, ImportArguments& options) {
  Placement& placement = options.placement;
  const Option scale =
      command
          .addOption("--scale", placement.scale,
                     "metres per unit of the file; CAD: a factor on top of the unit that the file states")
          .within(1e-9, 1e9);
  command.addOption("--fit", placement.fit, "scale so that the largest extent is this many metres")
      .within(1e-6, 1e3)
      .excludes(scale);
  command.addFlag("--center", placement.center, "move the centre of the bounding box to the origin");
  command.addOption("--up", options.up, "axis that points up in the file; it becomes y, which points up in the world")
      .oneOf({"x", "y", "z"});
  command
      .addOption("--outward", options.outward,
                 "which side is outside: auto (by enclosed volume), normal (Su x Sv) or reversed")
      .oneOf({"auto", "normal", "reversed"});
}

void addCadOptions(const Command& command, ImportArguments& options) {
  command.addFlag("--json", options.json, "triangles and CAD: write the report as JSON");
  command.addFlag("--check", options.cad.check, "CAD: write nothing; print what would be lost");
  command.addOption("--time", options.cad.time_s, "CAD: longest time [s]; default: 600").within(1.0, 1e6);
  command.addOption("--memory", options.cad.memory_mb, "CAD: most memory [MB]; default: 4096").within(64.0, 1e7);
}

}  // namespace

void addImport(const Command& app, int& exit_code) {
  auto options = std::make_shared<ImportArguments>();
  const Command command = app.addSubcommand(
      "import",
      "Convert CAD files and triangle meshes into parts, Bezier patches (.bpt) into a model file, or a closed surface "
      "into a soft body.");
  command
      .addOption("file", options->file,
                 "Bezier patches (.bpt), triangles (.obj, .stl, .ply) or CAD (.step, .stp, .iges, .igs, .brep, .brp, "
                 ".rle). With --medial: .obj, .stl, .ply, or a model file with surfaces")
      .required();
  command.addOption(
      "-o,--out,out", options->out,
      "file to write. From patches: a model file, .yaml or .json, or - for standard output. From triangles and CAD: a "
      "part, .hpart. With --medial: .ma or .yaml");
  addPlacementOptions(command, *options);
  command
      .addOption("--smooth-angle", options->smooth_angle,
                 "triangles: interpolate normals over edges that bend by less than this [degrees]; default: 0")
      .within(0.0, 180.0);
  addCadOptions(command, *options);
  addMedialOptions(command, *options);
  command
      .addOption("--scene", options->scene,
                 "also write a first scene for what is made, or without --out for a part or model file: a new file, "
                 ".yaml, to be run with hapticd run --view")
      .excludes("--check")
      .excludes("--calibrate");
  command.footer(
      "A .bpt file holds the number of patches, then for each its two degrees and its points; # begins a comment.\n"
      "Comments are copied to the model file, so that credit and licence are kept.\n\nExamples:\n  hapticd import "
      "config/models/teapot.bpt --up z --fit 0.13 --center -o teapot.yaml\n  hapticd import bracket.stl --scale 0.001 "
      "-o bracket.hpart\n  hapticd import engine.step -o engine.hpart --scene engine.yaml\n  hapticd import --medial "
      "hand.stl --scale 0.001 --tolerance 0.001 hand.ma");
  command.callback([options, command, &exit_code] {
    for (const char* one : kMaterial)
      if (options->material.empty() && command.given(one)) options->material = one;
    exit_code = importAll(*options);
  });
}

}  // namespace hapticd::cli
