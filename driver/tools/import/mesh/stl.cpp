// SPDX-License-Identifier: MIT
/// Reads STL, the format of 3D Systems, as text and binary. Many binary files begin with the word solid as well, so the
/// length decides.
#include <cctype>
#include <cstring>

#include "base/counted.hpp"
#include "mesh_import/mesh_file.hpp"
#include "mesh_import/mesh_text.hpp"
#include "mesh_import/polygons.hpp"
#include "mesh_import/wrong_lines.hpp"

namespace hapticd::importing {
namespace {

using Eigen::Vector3d;
constexpr std::size_t kStlHead = 84, kStlTriangle = 50;  ///< [bytes]

Result<MeshFile> parseBinaryStl(std::string_view bytes, std::size_t count, const std::string& name) {
  if (count > kMostTriangles) return Error{name + ": the file has more than 20,000,000 triangles"};
  MeshFile mesh;
  Weld weld(mesh.points);
  mesh.corners.reserve(count);
  for (std::size_t t = 0; t < count; ++t) {
    std::array<float, 9> xyz{};
    std::memcpy(xyz.data(), bytes.data() + kStlHead + kStlTriangle * t + 12, sizeof xyz);
    std::array<std::uint32_t, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d p(xyz[3 * k], xyz[3 * k + 1], xyz[3 * k + 2]);
      if (!p.allFinite())
        return Error{name + ": triangle " + std::to_string(t) +
                     " (from 0) has a coordinate that is not a finite number"};
      corner[k] = weld.at(p);
    }
    mesh.corners.push_back(corner);
  }
  if (const std::size_t rest = bytes.size() - kStlHead - kStlTriangle * count; rest > 0)
    mesh.remarks.push_back(std::to_string(rest) + " bytes after the last triangle were passed over");
  return mesh;
}

/// Reads the text form. Programs differ in what they leave out, so only the corners count: three or more between two
/// other words are a facet.
class TextStl {
 public:
  TextStl(std::string_view bytes, const std::string& name) : words_(bytes), name_(name) {}

  Result<MeshFile> run() {
    while (nextWord()) {
      take();
      if (mesh_.corners.size() > kMostTriangles)
        return Error{at(words_.lineNumber()) + "the file has more than 20,000,000 triangles"};
    }
    if (inside_)
      wrong_lines_.add(begun_, at(begun_) + "the file ends inside this facet, so it is cut off; expected endfacet");
    else
      endLoop();
    if (!wrong_lines_.none()) return wrong_lines_.error(name_);
    if (mesh_.corners.empty())
      return Error{name_ +
                   ": the file has no triangles; "
                   "expected a text STL (solid, facet, vertex x y z) or a whole binary one"};
    if (polygons_ > 0)
      mesh_.remarks.push_back(counted(polygons_, "facet has", "facets have") +
                              " more than three corners and became triangles");
    if (!ended_) mesh_.remarks.emplace_back("the file does not end with endsolid, so it may be cut off");
    return std::move(mesh_);
  }

 private:
  std::string at(std::size_t line) const { return name_ + ":" + std::to_string(line) + ": "; }
  /// Goes to the next word, in small letters, on this line or a later one.
  bool nextWord() {
    std::string_view word = words_.next();
    while (word.empty()) {
      if (!words_.nextLine()) return false;
      word = words_.next();
    }
    word_.assign(word);
    for (char& c : word_) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return true;
  }

  void take() {
    if (word_[0] == '#' || word_[0] == ';' || word_.starts_with("//")) return words_.skipLine();  // a comment
    if (word_ == "solid" || word_ == "endsolid") {
      words_.skipLine();  // its name may be any words
      ended_ = word_ == "endsolid";
      endFacet();
    } else if (word_ == "facet") {
      endFacet();
      inside_ = true;
      loops_ = 0;
      begun_ = words_.lineNumber();
    } else if (word_ == "endfacet") {
      endFacet();
    } else if (word_ == "outer" || word_ == "endloop") {
      endLoop();
      looped_ = true;
    } else if (word_ == "vertex") {
      takePoint();
    }
  }

  void takePoint() {
    const std::size_t line = words_.lineNumber();
    const auto p = nextPoint(words_);
    if (!p)
      wrong_lines_.add(line, at(line) + "'" + plainWord(words_.wholeLine()) +
                                 "' is not a corner; expected vertex x y z, finite numbers");
    if (!inside_ && loop_.empty()) begun_ = line;
    loop_.push_back(weld_.at(p.value_or(Vector3d::Zero())));   // a wrong one counts as well
    if (!inside_ && !looped_ && loop_.size() == 3) endLoop();  // the file has corners alone
  }

  /// Makes a facet of the corners since the last loop. A file without the word loop has a loop in each facet.
  void endLoop() {
    if (loop_.empty()) return;
    ++loops_;
    if (loop_.size() < 3)
      wrong_lines_.add(begun_, at(begun_) + "the facet has " + counted(loop_.size(), "corner") +
                                   "; expected three lines vertex x y z");
    else if (loop_.size() == 3)
      mesh_.corners.push_back({loop_[0], loop_[1], loop_[2]});
    else if (++polygons_; !cutPolygon(mesh_.points, std::move(loop_), mesh_.corners))
      wrong_lines_.add(begun_, at(begun_) + kPolygonTooLarge);
    loop_.clear();
  }

  void endFacet() {
    endLoop();
    if (inside_ && loops_ == 0)
      wrong_lines_.add(begun_, at(begun_) + "the facet has no corners; expected three lines vertex x y z");
    inside_ = false;
  }

  Words words_;
  const std::string& name_;
  MeshFile mesh_;
  Weld weld_{mesh_.points};
  std::string word_;
  std::vector<std::uint32_t> loop_;  ///< the corners since the last loop
  std::size_t begun_ = 0, loops_ = 0, polygons_ = 0;
  bool inside_ = false, looped_ = false, ended_ = false;
  WrongLines wrong_lines_;
};

/// Returns true if the first bytes are those of a text.
bool isText(std::string_view bytes) {
  constexpr std::size_t kFirst = 512;
  return bytes.substr(0, kFirst).find('\0') == std::string_view::npos;
}

}  // namespace

Result<MeshFile> parseStlMesh(std::string_view bytes, const std::string& name) {
  std::uint32_t count = 0;
  if (bytes.size() >= kStlHead) std::memcpy(&count, bytes.data() + 80, sizeof count);
  const std::size_t whole = kStlHead + kStlTriangle * std::size_t{count};
  if (count > 0 && bytes.size() >= whole) return parseBinaryStl(bytes, count, name);
  if (isText(bytes)) return TextStl(bytes, name).run();
  if (bytes.size() < kStlHead)
    return Error{name + ": has " + std::to_string(bytes.size()) +
                 " bytes, but a binary STL has at least 84; the file is damaged, or not an STL"};
  if (bytes.size() == whole) return Error{name + ": the file has no triangles; it is an empty binary STL"};
  return Error{name + ": a binary STL of " + counted(count, "triangle") + " has " + std::to_string(whole) +
               " bytes, but this file has " + std::to_string(bytes.size()) + "; it is damaged, or not an STL"};
}

}  // namespace hapticd::importing
