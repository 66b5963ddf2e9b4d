// SPDX-License-Identifier: MIT
#include "ma_file.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <string_view>

#include "mat_deformable/medial_file.hpp"
#include "traced_shape/model_file.hpp"

namespace hapticd {
namespace {

constexpr std::size_t kMostProblems = 20;
constexpr long kMostElements = 10'000'000;

/// Replaces every character that is not plain ASCII by a question mark, for the terminal.
std::string printable(std::string_view word) {
  std::string text(word);
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return text;
}

/// The words of a line, one after the other.
class Words {
 public:
  explicit Words(std::string_view line) : left_(line) {}
  std::string_view next() {
    const std::size_t begin = left_.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) return {};
    const std::size_t end = std::min(left_.find_first_of(" \t\r", begin), left_.size());
    const std::string_view word = left_.substr(begin, end - begin);
    left_.remove_prefix(end);
    return word;
  }
  template <class Number>
  bool number(Number& out) {
    std::string_view word = next();
    if (!word.empty() && word[0] == '+') word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), out);
    return !word.empty() && error == std::errc{} && end == word.data() + word.size();
  }

 private:
  std::string_view left_;
};

class MaReader {
 public:
  MaReader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  medial::MeshData read() {
    for (std::size_t at = 0; at < text_.size() && problems_ < kMostProblems;) {
      const std::size_t end = std::min(text_.find('\n', at), text_.size());
      ++line_;
      readLine(text_.substr(at, end - at));
      at = end + 1;
    }
    if (problems_ < kMostProblems) finish();
    if (problems_ > 0) throwAll();
    return std::move(data_);
  }

 private:
  /// Throws all problems, with a warning about millimetres.
  [[noreturn]] void throwAll() const {
    Eigen::AlignedBox3d box;
    for (const medial::Sphere& sphere : data_.vertices)
      if (sphere.center.allFinite()) box.extend(sphere.center);
    ModelFileError error(found_);
    if (const double size = box.isEmpty() ? 0 : box.sizes().maxCoeff(); size > medial::kLargestUsual) {
      char text[160];
      std::snprintf(text, sizeof text, ": the body is %.3g m long; lengths must be in m: is the file in millimetres?",
                    size);
      error.odd.push_back(file_ + text);
    }
    throw error;
  }

  void problem(const std::string& what) {
    found_ += (problems_ > 0 ? "\n" : "") + file_ + ":" + std::to_string(std::max<std::size_t>(line_, 1)) + ": " + what;
    ++problems_;
  }

  void readLine(std::string_view line) {
    Words words(line);
    const std::string_view kind = words.next();
    if (kind.empty() || kind[0] == '#') return;
    if (!counted_) return readCounts(Words(line));
    if (kind == "v") {
      medial::Sphere s;
      const bool good = words.number(s.center.x()) && words.number(s.center.y()) && words.number(s.center.z()) &&
                        words.number(s.radius) && s.center.allFinite() &&
                        s.center.cwiseAbs().maxCoeff() <= kFarthestPoint && s.radius >= 0 && s.radius <= kFarthestPoint;
      if (!good)
        problem(
            "'" + printable(line.substr(0, 60)) +
            "' is not a vertex; expected v x y z r: centre and radius in m, at most 1e6, and a radius of at least 0");
      data_.vertices.push_back(s);
    } else if (kind == "e") {
      readCorners(line, words, data_.edges, "e i j");
    } else if (kind == "f") {
      readCorners(line, words, data_.triangles, "f i j k");
    } else {
      problem("'" + printable(kind.substr(0, 20)) + "': a line must begin with v, e, f or #");
    }
  }

  void readCounts(Words words) {
    counted_ = true;
    for (long& count : counts_) {
      const std::string_view word = words.next();
      if (!Words(word).number(count)) {
        counts_known_ = false;
        return problem((word.empty() ? "too few numbers" : "'" + printable(word.substr(0, 20)) + "'") +
                       "; the first line must have three whole numbers: how many vertices, edges and triangles follow");
      }
      if (count >= 0 && count <= kMostElements) continue;
      counts_known_ = false;
      return problem(std::to_string(count) + " elements of one kind; expected 0 to " + std::to_string(kMostElements) +
                     " vertices, edges and triangles");
    }
    if (counts_[0] == 0) problem("there are no vertices; at least one is needed");
  }

  template <std::size_t kCount>
  void readCorners(std::string_view line, Words& words, std::vector<std::array<int, kCount>>& out, const char* form) {
    std::array<int, kCount> corners{};
    bool good = true;
    for (int& corner : corners) {
      good = good && words.number(corner) && corner >= 0;
      if (good && counts_known_) good = corner < counts_[0];
    }
    for (std::size_t i = 0; good && i < kCount; ++i) good = corners[i] != corners[(i + 1) % kCount];
    if (!good)
      problem("'" + printable(line.substr(0, 60)) + "' does not name vertices; expected " + form +
              ": different vertices" +
              (counts_known_ ? " from 0 to " + std::to_string(counts_[0] - 1) : std::string()));
    out.push_back(corners);
  }

  void finish() {
    if (!counted_)
      return problem("the file is empty; the first line must have the numbers of vertices, edges and triangles");
    if (!counts_known_) return;
    const auto check = [this](long promised, std::size_t found, const char* one, const char* many) {
      if (static_cast<std::size_t>(promised) != found)
        problem(std::to_string(found) + " " + (found == 1 ? one : many) + (found == 1 ? " is" : " are") +
                " in the file, but the first line says " + std::to_string(promised) + " of them");
    };
    check(counts_[0], data_.vertices.size(), "vertex", "vertices");
    check(counts_[1], data_.edges.size(), "edge", "edges");
    check(counts_[2], data_.triangles.size(), "triangle", "triangles");
  }

  std::string_view text_;
  const std::string& file_;
  medial::MeshData data_;
  std::array<long, 3> counts_{};
  bool counted_ = false, counts_known_ = true;
  std::string found_;
  std::size_t line_ = 0, problems_ = 0;
};

}  // namespace

medial::MeshData parseMa(const std::string& text, const std::string& file) {
  return MaReader(text, file).read();
}

}  // namespace hapticd
