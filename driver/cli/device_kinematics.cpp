/// `hapticd device kinematics`: forward kinematics, Jacobian and torques of an arm, offline, for joints of a CSV file.
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "cli/command.hpp"
#include "host/device_instance.hpp"
#include "scene/reader.hpp"

namespace hapticd::cli {
namespace {

struct Options {
  std::string file, joints, out = "-";
};

constexpr size_t kMaxCsvBytes = 256u << 20;
constexpr size_t kWrench = 6;

/// Rows of numbers: joints first, then (if the header has them) force and torque on the hand.
struct Rows {
  size_t columns = 0;
  std::vector<std::vector<double>> rows;
};

std::vector<std::string> fieldsOf(const std::string& line) {
  std::vector<std::string> fields;
  for (size_t start = 0; start <= line.size();) {
    const size_t comma = std::min(line.find(',', start), line.size());
    std::string field = line.substr(start, comma - start);
    field.erase(0, std::min(field.find_first_not_of(" \t"), field.size()));
    field.erase(field.find_last_not_of(" \t\r") + 1);
    fields.push_back(field);
    start = comma + 1;
  }
  return fields;
}

std::string headerOf(size_t joints) {
  std::string header;
  for (size_t i = 1; i <= joints; ++i) header += (i > 1 ? ",q" : "q") + std::to_string(i);
  return header;
}

Result<Rows> readRows(const std::string& file, size_t joints) {
  scene::Problems problems;
  const auto text = scene::readFile(file, kMaxCsvBytes, problems);
  if (!text) return Error{problems.front().text()};
  std::istringstream lines(*text);
  Rows rows;
  size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::vector<std::string> fields = fieldsOf(line);
    if (line.empty() || line[0] == '#' || (fields.size() == 1 && fields[0].empty())) continue;
    const std::string where = file + ":" + std::to_string(number) + ":1: ";
    if (rows.columns == 0) {
      rows.columns = fields.size();
      if (fields.size() != joints && fields.size() != joints + 3 && fields.size() != joints + kWrench)
        return Error{where + std::to_string(fields.size()) + " columns, expected " + headerOf(joints) +
                     " and, for torques, fx,fy,fz or fx,fy,fz,tx,ty,tz"};
      if (!scene::toNumber(fields[0])) continue;  // a header; without one the file begins with numbers
    }
    std::vector<double> row;
    for (const std::string& field : fields) row.push_back(scene::toNumber(field).value_or(std::nan("")));
    if (row.size() != rows.columns)
      return Error{where + std::to_string(row.size()) + " columns, expected " + std::to_string(rows.columns)};
    for (size_t i = 0; i < row.size(); ++i)
      if (!std::isfinite(row[i]))
        return Error{where + "column " + std::to_string(i + 1) + " is \"" + fields[i] + "\", expected a finite number"};
    rows.rows.push_back(std::move(row));
  }
  if (rows.rows.empty()) return Error{file + ":1:1: no rows, expected joint positions in rad (m for sliding joints)"};
  return rows;
}

class Table {
 public:
  Table(std::FILE* out, const hdv_ext_kinematics& kinematics, const hdv_device* device, const Eigen::Vector3d& gravity)
      : out_(out), kinematics_(kinematics), device_(device), gravity_(gravity) {}

  void header(size_t columns) {
    const size_t n = kinematics_.joint_count;
    std::string text = headerOf(n) + ",x,y,z,qw,qx,qy,qz";
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
    if (status < 0)
      return Error{"the kinematics have no answer for these joints (status " + std::to_string(status) + ")"};
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

  /// Rows whose tip the arm cannot reach within its joint limits.
  size_t outside() const { return outside_; }

 private:
  /// tau = J^T W (Thompson et al. 1999, Eq. 9).
  void addTorques(const std::vector<double>& values, const double* J) {
    const size_t n = kinematics_.joint_count;
    for (size_t j = 0; j < n; ++j) {
      double tau = 0;
      for (size_t i = 0; i + n < values.size(); ++i) tau += J[i * n + j] * values[n + i];
      add(&tau, 1);
    }
  }
  void add(const double* values, size_t count) {
    for (size_t i = 0; i < count; ++i) {
      char text[32];
      std::snprintf(text, sizeof text, "%s%.17g", line_.empty() ? "" : ",", values[i]);
      line_ += text;
    }
  }
  std::FILE* out_;
  const hdv_ext_kinematics& kinematics_;
  const hdv_device* device_;
  Eigen::Vector3d gravity_;
  std::string line_;
  size_t outside_ = 0;
};

int kinematics(const Options& options) {
  const scene::LoadedDevice loaded = scene::loadDevice(options.file, catalog());
  printProblems(loaded.problems, stderr);
  if (!loaded.device) return kBadInput;
  auto device = host::DeviceInstance::create(*loaded.device, logToTerminal);
  if (!device) return fail(kFailed, device.error());
  auto rows = readRows(options.joints, (*device)->kinematics().joint_count);
  if (!rows) return fail(kBadInput, rows.error());
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(
      options.out == "-" ? nullptr : std::fopen(options.out.c_str(), "w"),
      [](std::FILE* f) { return f != nullptr ? std::fclose(f) : 0; });
  if (options.out != "-" && !file) return fail(kBadInput, options.out + ": cannot be written");
  std::FILE* out = file ? file.get() : stdout;
  const Eigen::Vector3d gravity = loaded.device->mount.orientation.conjugate() * scene::Servo{}.gravity;
  Table table(out, (*device)->kinematics(), (*device)->handle(), gravity);
  table.header(rows->columns);
  for (size_t i = 0; i < rows->rows.size(); ++i)
    if (auto done = table.row(rows->rows[i]); !done)
      return fail(kFailed, options.joints + ": row " + std::to_string(i + 1) + ": " + done.error());
  if (table.outside() > 0)
    std::fprintf(stderr,
                 "warning: %s: in %zu of %zu rows the tip is where the arm's joint limits do not let it\n  the numbers are "
                 "those of its mechanism without stops\n  fix: correct the joints, or arm.limits in %s\n",
                 options.joints.c_str(), table.outside(), rows->rows.size(), options.file.c_str());
  return std::fflush(out) == 0 ? kWorked : fail(kFailed, options.out + ": cannot be written");
}

}  // namespace

void addDeviceKinematics(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.get_subcommand("device")->add_subcommand(
      "kinematics", "Tip pose, Jacobian, gravity torques and J^T W of an arm for joint positions of a CSV file.");
  command->add_option("file", options->file, "device file (YAML)")->required();
  command
      ->add_option("--joints", options->joints,
                   "CSV: q1,q2,... in rad (m for sliding joints), then perhaps fx,fy,fz[,tx,ty,tz] in N and N m")
      ->required();
  command->add_option("-o,--out", options->out, "result (CSV); - for standard output");
  command->footer(
      "All in the device frame, SI units. J is row by row: J1..J3 velocity of the tip, J4..J6 angular velocity.\n"
      "gravityN holds the arm against gravity as it is mounted; tauN = J^T W, with forces in the file only.\n\n"
      "Example:\n  hapticd device kinematics config/devices/simulated-premium15.yaml --joints joints.csv");
  command->callback([options, &exit_code] { exit_code = kinematics(*options); });
}

}  // namespace hapticd::cli
