#include "scene/kinematic_path.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "scene/reader.hpp"

namespace hapticd::scene {
namespace {

constexpr size_t kMaxPathBytes = 256u << 20;  ///< an hour at 1 kHz and more
constexpr size_t kShownProblems = 20;         ///< a file of a wrong format is wrong in every line
constexpr double kFarthest = 1e6;             ///< [m]
constexpr size_t kColumns = 8;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

class PathParser {
 public:
  PathParser(const std::string& file, Problems& problems) : file_(file), problems_(problems) {}

  void line(std::string_view text) {
    ++line_;
    if (const std::string_view content = trimmed(text); content.empty() || content[0] == '#') return;
    if (columns_ == 0)
      header(text);
    else
      row(text);
  }
  bool tooWrong() const { return wrong_ >= kShownProblems; }
  std::vector<PathPoint> take() {
    if (points_.empty() && wrong_ == 0)
      problem(0, "", "no rows, expected a header t,x,y,z,qw,qx,qy,qz and at least one row");
    return std::move(points_);
  }

 private:
  void problem(size_t offset, const std::string& column, const std::string& what) {
    ++wrong_;
    report(problems_, file_, std::max(line_, 1), static_cast<int>(offset) + 1, column, what);
  }
  void header(std::string_view text) {
    std::string names;
    for (const char c : text)
      if (c != ' ' && c != '\t' && c != '\r') names += c;
    columns_ = names == "t,x,y,z" ? 4 : kColumns;
    if (columns_ == kColumns && names != "t,x,y,z,qw,qx,qy,qz")
      problem(0, "", "the header is \"" + names.substr(0, 60) + "\", expected t,x,y,z,qw,qx,qy,qz (or t,x,y,z)");
  }
  void row(std::string_view text) {
    static constexpr const char* kNames[kColumns] = {"t", "x", "y", "z", "qw", "qx", "qy", "qz"};
    std::array<double, kColumns> values{0, 0, 0, 0, 1, 0, 0, 0};
    size_t start = 0, column = 0;
    for (; column < columns_ && start <= text.size(); ++column) {
      const size_t comma = std::min(text.find(',', start), text.size());
      const std::string_view field = trimmed(text.substr(start, comma - start));
      const std::optional<double> value = toNumber(field);
      if (!value || !std::isfinite(*value) || std::abs(*value) > kFarthest)
        return problem(start, kNames[column],
                       std::string(field.substr(0, 40)).append(" is not usable, expected a finite number"));
      values[column] = *value;
      start = comma + 1;
    }
    if (column < columns_ || start <= text.size())
      return problem(0, "",
                     (column < columns_ ? std::to_string(column) : "more than " + std::to_string(columns_)) +
                         " columns, expected " + std::to_string(columns_));
    add(values);
  }
  void add(const std::array<double, kColumns>& v) {
    PathPoint point;
    point.t = v[0];
    point.pose.position = {v[1], v[2], v[3]};
    point.pose.orientation = {v[4], v[5], v[6], v[7]};
    if (!points_.empty() && point.t <= points_.back().t)
      return problem(0, "t",
                     numberText(v[0]) + " s does not grow, expected more than " + numberText(points_.back().t) + " s");
    if (!normalise(point.pose.orientation))
      return problem(0, "qw",
                     "the quaternion has length " + numberText(point.pose.orientation.norm()) +
                         ", expected 1 within 0.001 (order w, x, y, z)");
    points_.push_back(point);
  }

  std::string file_;
  Problems& problems_;
  std::vector<PathPoint> points_;
  size_t columns_ = 0, wrong_ = 0;
  int line_ = 0;
};

}  // namespace

std::vector<PathPoint> parseKinematicPath(const std::string& text, const std::string& file, Problems& problems) {
  PathParser parser(file, problems);
  for (size_t start = 0; start < text.size() && !parser.tooWrong();) {
    const size_t end = std::min(text.find('\n', start), text.size());
    parser.line(std::string_view(text).substr(start, end - start));
    start = end + 1;
  }
  return parser.take();
}

std::vector<PathPoint> readKinematicPath(const std::filesystem::path& file, Problems& problems) {
  const auto text = readFile(file, kMaxPathBytes, problems);
  return text ? parseKinematicPath(*text, file.string(), problems) : std::vector<PathPoint>{};
}

}  // namespace hapticd::scene
