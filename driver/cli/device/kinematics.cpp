// SPDX-License-Identifier: MIT
/// `hapticd device kinematics`: forward kinematics, Jacobian and torques of an arm, offline, for joints of a CSV file.
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "base/short_number.hpp"
#include "cli/device/content.hpp"
#include "cli/device/file.hpp"
#include "cli/device/joint_angles.hpp"
#include "cli/support/command.hpp"
#include "cli/support/output_file.hpp"
#include "document/csv.hpp"
#include "document/reader.hpp"
#include "host/class_table.hpp"
#include "host/device_instance.hpp"

namespace hapticd::cli {
namespace {

struct KinematicsArguments {
  std::string file, joints, out = "-";
};

/// Columns of the pose of the tip; they follow the columns of the joints.
constexpr const char* kTipColumns = ",x,y,z,qw,qx,qy,qz";

std::string headerOf(size_t joints) {
  std::string header;
  for (size_t i = 1; i <= joints; ++i) header += (i > 1 ? ",q" : "q") + std::to_string(i);
  return header;
}

/// Converts a table that `device decode` wrote to a table with the columns q1,q2,... Only good rows are taken. Returns
/// nothing if the text is another table.
std::optional<std::string> fromDecoded(const std::string& text, size_t joints) {
  std::istringstream in(text);
  std::string line;
  std::getline(in, line);
  const auto cells = [](const std::string& row) {  // returns the cells of a row, also the empty ones
    std::vector<std::string> found(1);
    for (const char c : row) {
      if (c == ',')
        found.emplace_back();
      else if (c != '\r')
        found.back() += c;
    }
    return found;
  };
  const std::vector<std::string> names = cells(line);
  const auto columnOf = [&names](const std::string& name) {
    return static_cast<size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  const size_t verdict = columnOf("verdict");
  std::vector<size_t> columns;
  for (size_t i = 1; i <= joints; ++i) columns.push_back(columnOf("position" + std::to_string(i)));
  if (verdict == names.size() || *std::max_element(columns.begin(), columns.end()) >= names.size()) return std::nullopt;
  std::string table = headerOf(joints) + "\n";
  while (std::getline(in, line)) {
    const std::vector<std::string> row = cells(line);
    if (row.size() != names.size() || row[verdict] != "good") continue;
    for (size_t i = 0; i < joints; ++i) table += (i > 0 ? "," : "") + row[columns[i]];
    table += "\n";
  }
  return table;
}

/// Reads joints, and (where the file has them) force and torque on the hand.
Result<document::CsvTable> readRows(const std::string& file, size_t joints) {
  const std::string q = headerOf(joints);
  document::Problems problems;
  document::CsvRules form;
  form.headers = {q, q + ",fx,fy,fz", q + ",fx,fy,fz,tx,ty,tz"};
  const auto text = contentOf(file);
  if (!text) return Error{file + ": " + text.error()};
  const auto decoded = fromDecoded(*text, joints);
  auto table = document::parseCsv(decoded ? *decoded : *text, file, form, problems);
  if (!table) return Error{document::textOf(problems)};
  return std::move(*table);
}

class Table {
 public:
  Table(std::FILE* out, const hdv_ext_kinematics& kinematics, const hdv_device* device, const Eigen::Vector3d& gravity)
      : out_(out), kinematics_(kinematics), device_(device), gravity_(gravity) {}

  void header(size_t columns) {
    const size_t n = kinematics_.joint_count;
    std::string text = headerOf(n) + kTipColumns;
    for (int i = 1; i <= 6; ++i)
      for (size_t j = 1; j <= n; ++j) text += ",J" + std::to_string(i) + "_" + std::to_string(j);
    for (size_t j = 1; j <= n; ++j) text += ",gravity" + std::to_string(j);
    for (size_t j = 1; columns > n && j <= n; ++j) text += ",tau" + std::to_string(j);
    std::fprintf(out_, "%s\n", text.c_str());
  }

  Result<void> row(const std::vector<double>& values) {
    const size_t n = kinematics_.joint_count;
    std::array<double, HDV_MAX_JOINTS> q{}, held{};
    std::array<double, 6 * HDV_MAX_JOINTS> J{};
    std::array<double, 3> p{};
    std::array<double, 4> o{1, 0, 0, 0};
    std::copy_n(values.begin(), n, q.begin());
    const hsp_status status = std::min({kinematics_.forward(device_, q.data(), p.data(), o.data()),
                                        kinematics_.jacobian(device_, q.data(), J.data()),
                                        kinematics_.gravity(device_, q.data(), gravity_.data(), held.data())});
    if (status < 0) return Error{"the kinematics failed for these joints (" + host::statusName(status) + ")"};
    line_.clear();
    add(values.data(), n);
    add(p.data(), 3);
    add(o.data(), 4);
    add(J.data(), 6 * n);
    add(held.data(), n);
    if (values.size() > n) addTorques(values, J.data());
    std::array<double, HDV_MAX_JOINTS> back = q;
    outside_ += kinematics_.inverse(device_, p.data(), back.data()) < 0 ? 1 : 0;
    std::fprintf(out_, "%s\n", line_.c_str());
    return {};
  }

  /// Returns how many rows had a tip that the arm cannot reach within its joint limits.
  size_t outside() const { return outside_; }

 private:
  /// Adds the torques tau = J^T W (Thompson et al. 1999, Eq. 9).
  void addTorques(const std::vector<double>& values, const double* J) {
    const size_t n = kinematics_.joint_count;
    for (size_t j = 0; j < n; ++j) {
      double tau = 0;
      for (size_t i = 0; i + n < values.size(); ++i) tau += J[i * n + j] * values[n + i];
      add(&tau, 1);
    }
  }
  void add(const double* values, size_t count) {
    for (size_t i = 0; i < count; ++i) line_ += (line_.empty() ? "" : ",") + withDigits(values[i], 17);
  }
  std::FILE* out_;
  const hdv_ext_kinematics& kinematics_;
  const hdv_device* device_;
  Eigen::Vector3d gravity_;
  std::string line_;
  size_t outside_ = 0;
};

int kinematics(const KinematicsArguments& options) {
  const auto loaded = loadDeviceOrReport(options.file);
  if (!loaded) return kBadInput;
  auto device = host::DeviceInstance::create(*loaded, logToTerminal);
  if (!device) return fail(kFailed, device.error());
  const Inputs inputs{{options.joints, "the file of joints"}, {options.file, "the device file"}};
  // Such tables have any number of joints.
  const OutputKind kind{"a table of this command (CSV)", {"q1,"}, kTipColumns};
  if (const std::string wrong = whyNotWritten(options.out, kind, inputs); !wrong.empty()) return fail(kBadInput, wrong);
  auto rows = readRows(options.joints, (*device)->kinematics().joint_count);
  if (!rows) return fail(kBadInput, rows.error());
  std::vector<size_t> joints((*device)->kinematics().joint_count);
  std::iota(joints.begin(), joints.end(), size_t{0});
  warnOfDegrees(options.joints, *rows, joints, **device);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(
      options.out == "-" ? nullptr : std::fopen(options.out.c_str(), "w"),
      [](std::FILE* f) { return f != nullptr ? std::fclose(f) : 0; });
  if (options.out != "-" && !file) return fail(kBadInput, options.out + ": cannot be written");
  std::FILE* out = file ? file.get() : stdout;
  const Eigen::Vector3d gravity = loaded->mount.orientation.conjugate() * scene::Servo{}.gravity;
  Table table(out, (*device)->kinematics(), (*device)->handle(), gravity);
  table.header(rows->columns);
  for (size_t i = 0; i < rows->rows(); ++i)
    if (auto done = table.row({rows->row(i), rows->row(i) + rows->columns}); !done)
      return fail(kFailed, options.joints + ": row " + std::to_string(i + 1) + ": " + done.error());
  if (table.outside() > 0)
    std::fprintf(stderr,
                 "warning: %s: in %zu of %zu rows the arm cannot reach the tip position within its joint limits\n  the "
                 "table was computed without these limits\n  fix: correct the joint positions, or arm.limits in %s\n",
                 options.joints.c_str(), table.outside(), rows->rows(), options.file.c_str());
  return std::fflush(out) == 0 ? kWorked : fail(kFailed, options.out + ": cannot be written");
}

}  // namespace

void addDeviceKinematics(const Command& app, int& exit_code) {
  auto options = std::make_shared<KinematicsArguments>();
  const Command command = app.subcommand("device").addSubcommand(
      "kinematics", "Compute tip pose, Jacobian, gravity torques and J^T W for the joint positions of a CSV file.");
  command.addOption("file", options->file, "device file (YAML)").required();
  command
      .addOption(
          "--joints", options->joints,
          "CSV with q1,q2,... [rad; m for sliding joints] and optionally fx,fy,fz[,tx,ty,tz] [N, N m], or the table "
          "of device decode (its good rows); - for standard input")
      .required();
  command.addOption("-o,--out", options->out, "CSV file to write; - for standard output");
  command.footer(
      "Everything is in the device frame and in SI units. J is given row by row: J1..J3 are the velocity of the "
      "tip,\nJ4..J6 the angular velocity. gravityN are the torques that hold the arm against gravity as it is "
      "mounted.\ntauN = J^T W is given if the file has forces.\n\nExample:\n  hapticd device kinematics "
      "config/devices/simulated-premium15.yaml --joints joints.csv");
  command.callback([options, &exit_code] { exit_code = kinematics(*options); });
}

}  // namespace hapticd::cli
