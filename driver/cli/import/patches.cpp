// SPDX-License-Identifier: MIT
#include "cli/import/patches.hpp"

#include <cstdio>
#include <filesystem>

#include "base/regular_file.hpp"
#include "cli/import/mesh.hpp"
#include "cli/support/command.hpp"
#include "document/node.hpp"

namespace hapticd::cli {

using namespace importing;
namespace {

int writeModel(const BezierModel& model, const PatchImport& options) {
  const std::string& called = options.named.empty() ? options.out : options.named;
  const std::string text =
      std::filesystem::path(options.out).extension() == ".json" ? toModelJson(model) : toModelYaml(model);
  const Eigen::Vector3d size = boundsOf(model).sizes();
  if (options.out == "-") {
    std::fputs(text.c_str(), stdout);
  } else {
    if (const auto written = writeWhole(options.out, text); !written) return fail(kFailed, written.error());
    std::printf("%s: %zu surface%s, %.4g x %.4g x %.4g m%s\n", called.c_str(), model.patches.size(),
                model.patches.size() == 1 ? "" : "s", size.x(), size.y(), size.z(),
                model.reversed ? ", outward reversed" : "");
    printUnit(options.placement, size.maxCoeff());
  }
  warnOfSize(called, size.norm());
  return kWorked;
}

}  // namespace

int importPatches(const PatchImport& options) {
  document::Problems problems;
  const auto text = document::readFile(options.file, document::kMaxFileBytes, problems);
  printProblems(problems, stderr);
  if (!text) return kBadInput;
  auto model = parseBpt(*text, options.file);
  if (!model && std::filesystem::path(options.file).extension() != ".bpt")
    return fail(kBadInput, options.file +
                               ": its name does not say what it holds, and it holds no Bezier patches; expected "
                               "the ending .bpt, .stl, .obj, .ply, .step, .stp, .iges, .igs, .brep, .brp or .rle");
  if (!model) return fail(kBadInput, model.error());
  placeModel(*model, options.placement);
  if (options.outward != "auto") model->reversed = options.outward == "reversed";
  if (std::filesystem::path(options.out).extension() == ".hpart")
    return fail(kBadInput,
                options.out + ": Bezier patches become a model file, expected a name that ends in .yaml or .json");
  return writeModel(*model, options);
}

}  // namespace hapticd::cli
