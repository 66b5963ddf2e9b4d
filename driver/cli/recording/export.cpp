// SPDX-License-Identifier: MIT
/// `hapticd export`: converts a recording, or the last seconds of a running daemon, for other tools.
#include "export/export.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "base/file_ending.hpp"
#include "base/regular_file.hpp"
#include "cli/recording/name_tables.hpp"
#include "cli/support/command.hpp"
#include "cli/support/open_end.hpp"
#include "cli/support/output_file.hpp"
#include "control/liveness.hpp"
#include "document/suggestion.hpp"
#include "session/replay/about.hpp"
#include "session/replay/run_models.hpp"
#include "status/page_file.hpp"

namespace hapticd::cli {

namespace {

struct ExportArguments {
  std::string name = "hapticd", file, mcap, csv, stream;
};

void printExport(const std::string& file, const record::Exported& done) {
  std::printf("%s: %llu rows, %.1f MB\n", file.c_str(), static_cast<unsigned long long>(done.rows),
              static_cast<double>(done.bytes) / 1e6);
}

/// Prints what was written, or removes it if the recording was changed meanwhile.
int finish(const record::Recording& recording, const std::string& file, const record::Exported& done) {
  if (auto same = recording.unchanged(); !same) {
    removeIncomplete(file);
    return fail(kFailed, same.error() + "; " + file + " was removed");
  }
  printExport(file, done);
  return kWorked;
}

int toMcap(const record::Recording& recording, const std::string& file) {
  std::vector<record::Attachment> names;
  if (const auto run = servo::readAbout(recording.aboutJson()))
    names.push_back({"models.csv", "text/csv", modelsTable(servo::RunModels(recording, run->scene)).text});
  auto done = record::exportMcap(recording, file, names);
  if (!done) return fail(kFailed, done.error());
  return finish(recording, file, *done);
}

std::vector<std::string> namesOf(const record::Recording& recording) {
  std::vector<std::string> names;
  for (const record::RecordedStream& stream : recording.streams()) names.push_back(stream.name());
  return names;
}

/// Returns the columns by which a table of this stream is recognised; a newer hapticd may add more columns after them.
std::string firstColumns(const record::RecordedStream& stream) {
  std::string header;
  for (size_t i = 0; i < stream.columns().size() && i < 3; ++i) header += (i > 0 ? "," : "") + stream.columns()[i].name;
  return header;
}

/// Returns what is wrong if the folder for all streams has the name of a file; "" if it has not.
std::string fileForFolder(const record::Recording& recording, const std::filesystem::path& folder) {
  std::error_code none;
  const std::string ending = endingOf(folder.string());
  const bool is_file = std::filesystem::is_regular_file(folder, none);
  const bool like_file = ending == ".csv" || ending == ".xlsx" || ending == ".ods";
  if (!is_file && (!like_file || std::filesystem::is_directory(folder, none))) return "";
  const std::string name = folder.string();
  return "--csv " + name +
         " names a file, but each stream has a table of its own; expected a folder for all of them (--csv " +
         folder.stem().string() + (folder.has_extension() ? "" : "-tables") + "), or one of them: --csv " +
         folder.stem().string() + ".csv" + " --stream STREAM, with one of " + document::listed(namesOf(recording), 10);
}

/// A table that is no stream.
struct ExtraTable {
  std::string file;
  const char* header;
  NameTable table;
};

/// Returns the tables that stand in the folder beside those of the streams; without names if the description of the run
/// cannot be read.
std::vector<ExtraTable> extraTables(const record::Recording& recording, const std::filesystem::path& folder) {
  std::vector<ExtraTable> all{{(folder / "columns.csv").string(), kColumnsHeader, columnsTable(recording)}};
  const auto run = servo::readAbout(recording.aboutJson());
  if (!run) return all;
  const servo::RunModels models(recording, run->scene);
  all.push_back({(folder / "models.csv").string(), kModelsHeader, modelsTable(models)});
  NameTable joints = jointsTable(recording, models);
  if (joints.rows > 0) all.push_back({(folder / "joints.csv").string(), kJointsHeader, std::move(joints)});
  return all;
}

int writeExtra(const std::vector<ExtraTable>& tables) {
  for (const ExtraTable& extra : tables) {
    std::ofstream out(extra.file, std::ios::binary);
    if (!(out << extra.table.text).flush()) return fail(kFailed, extra.file + ": cannot be written");
    printExport(extra.file, {extra.table.rows, extra.table.text.size()});
  }
  return kWorked;
}

/// Writes one file of one stream, or a folder with a file for each stream.
int toCsv(const record::Recording& recording, const ExportArguments& options) {
  const bool one = !options.stream.empty();
  if (const std::string wrong = one ? "" : fileForFolder(recording, options.csv); !wrong.empty())
    return fail(kBadInput, wrong);
  if (one && recording.stream(options.stream) == nullptr)
    return fail(kBadInput, "--stream " + options.stream + ": the recording has no such stream, expected one of " +
                               document::listed(namesOf(recording), 10) +
                               document::suggestionOfName(options.stream, namesOf(recording)));
  std::vector<std::pair<const record::RecordedStream*, std::string>> tables;
  for (const record::RecordedStream& stream : recording.streams())
    if (!one || stream.name() == options.stream)
      tables.emplace_back(&stream,
                          one ? options.csv : (std::filesystem::path(options.csv) / (stream.name() + ".csv")).string());
  for (const auto& [stream, file] : tables)
    if (const std::string wrong =
            whyNotWritten(file, tableKind(firstColumns(*stream)), {{options.file, "the recording"}});
        !wrong.empty())
      return fail(kBadInput, wrong);
  const std::vector<ExtraTable> extra = one ? std::vector<ExtraTable>() : extraTables(recording, options.csv);
  for (const ExtraTable& table : extra)
    if (const std::string wrong = whyNotWritten(table.file, tableKind(table.header)); !wrong.empty())
      return fail(kBadInput, wrong);
  if (const std::string wrong = one ? whyNotWritable(options.csv) : ""; !wrong.empty()) return fail(kBadInput, wrong);
  std::error_code error;
  if (!one) std::filesystem::create_directories(options.csv, error);
  if (error)
    return fail(kFailed, options.csv + ": cannot be created: " + error.message() +
                             ", expected a folder in a folder that you may write to");
  for (const auto& [stream, file] : tables) {
    auto done = record::exportCsv(*stream, file);
    if (!done) {
      if (!one) std::filesystem::remove(options.csv, error);  // if it is empty
      return fail(kFailed, done.error());
    }
    if (const int code = finish(recording, file, *done); code != kWorked) return code;
  }
  return writeExtra(extra);
}

int exportRecording(const ExportArguments& options) {
  if (options.mcap.empty() && options.csv.empty())
    return fail(kBadInput, "nothing to write, expected --mcap FILE or --csv FOLDER");
  if (const std::string wrong = whyNotWritten(options.mcap, mcapKind(), {{options.file, "the recording"}});
      !wrong.empty())
    return fail(kBadInput, wrong);
  if (const std::string wrong = whyNotWritable(options.mcap); !wrong.empty()) return fail(kBadInput, wrong);
  auto recording = record::Recording::open(options.file);
  if (!recording) return fail(kBadInput, recording.error());
  if (const std::string& damage = (*recording)->damage(); !damage.empty())
    std::fprintf(stderr, "warning: %s: %s\n", options.file.c_str(), damage.c_str());
  noteOpenEnd(options.file, **recording, "exporting");
  const int code = options.mcap.empty() ? kWorked : toMcap(**recording, options.mcap);
  return code == kWorked && !options.csv.empty() ? toCsv(**recording, options) : code;
}

/// Exports the black box of a daemon, which has the last 10 s. A daemon that was killed has left it, too.
int exportDaemon(ExportArguments options, bool named) {
  const std::string base = status::runtimeFolderOf(options.name) + "/" + options.name;
  options.file = base + ".blackbox.h5";
  std::error_code none;
  if (control::isAlive(base + ".sock") || std::filesystem::exists(options.file, none)) return exportRecording(options);
  return fail(kFailed, (named ? "" : "no recording is given (hapticd export RECORDING), and ") +
                           control::noDaemonText(base + ".sock"));
}

}  // namespace

void addExport(const Command& app, int& exit_code) {
  auto options = std::make_shared<ExportArguments>();
  const Command command = app.addSubcommand(
      "export", "Convert a recording, or the last 10 s of a running daemon, for other tools: MCAP or CSV.");
  command.addOption("recording", options->file,
                    "recording, dump, or black box of a crash; default: the last 10 s of a running daemon");
  command.addOption("--name", options->name, "name of the daemon, as given to `hapticd run --name`; default: hapticd")
      .excludes("recording");
  command.addOption("--mcap", options->mcap, "MCAP file, for Foxglove, PlotJuggler and rosbag2");
  command.addOption("--csv", options->csv,
                    "folder for one CSV file per stream; with --stream, the CSV file of that stream");
  command.addOption("--stream", options->stream, "with --csv: the only stream to write (ticks, contacts, poses, ...)")
      .needs("--csv");
  command.footer("Examples:\n  hapticd export run.h5 --mcap run.mcap\n  hapticd export --name left --csv last-seconds");
  command.callback([options, command, &exit_code] {
    exit_code = options->file.empty() ? exportDaemon(*options, command.given("--name")) : exportRecording(*options);
  });
}

}  // namespace hapticd::cli
