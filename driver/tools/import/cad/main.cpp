// SPDX-License-Identifier: MIT
/// `hapticd-import`: converts a CAD file to a part file. `hapticd import` starts it; if it crashes, `hapticd import`
/// reports that the file is damaged.
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Standard_ErrorHandler.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <new>

#include "base/regular_file.hpp"
#include "cad_import/part_builder.hpp"
#include "cad_import/placed_part.hpp"
#include "cad_import/shape_fixes.hpp"
#include "command_line/command_line.hpp"
#include "kernels/part/file.hpp"

namespace hapticd::cad {
namespace {

constexpr int kWorked = 0, kFailed = 1, kBadInput = 2;

struct Options {
  std::string file, out;
  std::string named;                 ///< what messages call the part; "": `out`
  double memory_mb = 0, time_s = 0;  ///< 0 means no limit
  bool check = false, json = false;
  Placement placement;
  std::string up = "y";
};

/// Limits processor time and memory. Memory is not limited with sanitizers, which use more addresses than any limit
/// allows.
void setLimits(const Options& options) {
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const auto limit = [](auto resource, double most) {
    const rlimit value{static_cast<rlim_t>(most), static_cast<rlim_t>(most)};
    if (most > 0) setrlimit(resource, &value);
  };
  limit(RLIMIT_CPU, options.time_s);
#ifndef HAPTICD_SANITIZED
  limit(RLIMIT_AS, options.memory_mb * 1024 * 1024);
#endif
}

int fail(int exit_code, const std::string& message) {
  std::fprintf(stderr, "error: %s\n", message.c_str());
  return exit_code;
}

int failOfMemory(const Options& options) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f", options.memory_mb);
  return fail(kBadInput, options.file + ": it needs more than the " + text +
                             " MB of memory that are allowed\n  fix: allow more: --memory MEGABYTES");
}

/// Prints a text. @return kFailed if a file that standard output was sent to is not complete. A pipe is not judged,
/// because its reader may end when it has read enough.
int print(const std::string& text) {
  errno = 0;
  const bool whole = std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0;
  struct stat file{};
  const bool pipe = fstat(STDOUT_FILENO, &file) != 0 || S_ISFIFO(file.st_mode) || S_ISSOCK(file.st_mode);
  if (whole || pipe) return kWorked;
  return fail(kFailed,
              std::string("standard output cannot be written: ") + std::strerror(errno) + "; it is not complete");
}

/// Prints the report and writes the part, with the steps of the import among its warnings.
int finish(const Options& options, brep::Part& part, const Report& report) {
  const std::string out = options.check ? options.file : options.named.empty() ? options.out : options.named;
  const std::string text = options.json ? jsonOf(part, report, out) : textOf(part, report, out);
  const std::vector<std::string> steps = stepsOf(report);
  part.warnings.insert(part.warnings.begin(), steps.begin(), steps.end());
  const std::string bytes = brep::writePart(part);
  if (!options.check)
    if (const auto written = writeWhole(options.out, bytes); !written) return fail(kFailed, written.error());
  const int code = print(text);
  std::fputs(oddSizeOf(part, report, out).c_str(), stderr);
  return code;
}

int import(const Options& options) {
  const auto begun = std::chrono::steady_clock::now();
  Report report;
  limitShapeFixes();
  CadFile file = readCad(options.file);
  brep::Part part = buildPart(file, report);
  part.source.file = std::filesystem::path(options.file).filename().string();
  brep::checkPart(part);
  report.measures = measured(part);
  const std::vector<std::string> open = openBodies(part);  // where the CAD program has it, before it is placed
  if (options.placement.moves()) {
    placePart(part, options.placement, report.measures.box);
    brep::checkPart(part);
    report.measures = measured(part);
  }
  part.warnings.insert(part.warnings.end(), open.begin(), open.end());
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return finish(options, part, report);
}

int guarded(const Options& options) {
  try {
    OCC_CATCH_SIGNALS
    return import(options);
  } catch (const Standard_OutOfMemory&) {
    return failOfMemory(options);
  } catch (const Standard_Failure& failure) {
    return fail(kBadInput, options.file + ": Open CASCADE failed: " + failure.DynamicType()->Name() + " " +
                               failure.GetMessageString());
  } catch (const std::bad_alloc&) {
    return failOfMemory(options);
  } catch (const std::exception& error) {
    return fail(kBadInput, options.file + ": " + error.what());
  }
}

}  // namespace
}  // namespace hapticd::cad

int main(int argc, char** argv) {
  const hapticd::command_line::Program app(
      "Converts CAD files (STEP, IGES, BREP) into parts. hapticd import starts it.", "hapticd-import");
  hapticd::cad::Options options;
  app.addOption("file", options.file, ".step, .stp, .iges, .igs, .brep, .brp or .rle").required();
  app.addOption("-o,--out", options.out, "the part file to write (.hpart)");
  app.addOption("--named", options.named, "what messages call the part; default: the part file");
  app.addOption("--memory", options.memory_mb, "largest memory that the import may use [MB]");
  app.addOption("--time", options.time_s, "largest processor time that the import may use [s]");
  app.addFlag("--check", options.check, "write no file, only report what would be lost");
  app.addFlag("--json", options.json, "report as JSON");
  app.addOption("--scale", options.placement.scale, "factor on top of the unit of the file");
  app.addOption("--fit", options.placement.fit, "scale so that the largest extent is this many metres");
  app.addFlag("--center", options.placement.center, "move the middle of the box to the origin");
  app.addOption("--up", options.up, "axis that points up in the file").oneOf({"x", "y", "z"});
  if (const auto ended = app.parse(argc, argv)) return *ended;
  options.placement.up = options.up[0];
  hapticd::cad::setLimits(options);
  // Messages of Open CASCADE are dropped, because the report says what matters to the user.
  Message::DefaultMessenger()->ChangePrinters().Clear();
  std::cout.rdbuf(nullptr);
  return hapticd::cad::guarded(options);
}
