// SPDX-License-Identifier: MIT
/// Reads STL, the format of 3D Systems, as text and binary. Many binary files begin with the word solid as well, so the
/// length decides.
#include <cctype>
#include <cstring>

#include "mesh_import/mesh_file.hpp"
#include "mesh_import/mesh_words.hpp"

namespace hapticd::importing {
namespace {

using Eigen::Vector3d;
constexpr std::size_t kStlHead = 84, kStlTriangle = 50;  ///< [bytes]

Result<MeshFile> parseBinaryStl(std::string_view bytes, std::size_t count, const std::string& name) {
  if (count > kMostTriangles) return Error{name + ": more than 20,000,000 triangles"};
  MeshFile mesh;
  Weld weld(mesh.points);
  mesh.corners.reserve(count);
  for (std::size_t t = 0; t < count; ++t) {
    std::array<float, 9> xyz{};
    std::memcpy(xyz.data(), bytes.data() + kStlHead + kStlTriangle * t + 12, sizeof xyz);
    std::array<std::uint32_t, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d p(xyz[3 * k], xyz[3 * k + 1], xyz[3 * k + 2]);
      if (!p.allFinite()) return Error{name + ": triangle " + std::to_string(t) + ": a coordinate is not finite"};
      corner[k] = weld.at(p);
    }
    mesh.corners.push_back(corner);
  }
  if (const std::size_t rest = bytes.size() - kStlHead - kStlTriangle * count; rest > 0)
    mesh.remarks.push_back(std::to_string(rest) + " bytes after the last triangle were passed over");
  return mesh;
}

class TextStl {
 public:
  TextStl(std::string_view bytes, const std::string& name) : words_(bytes), name_(name) {}

  Result<MeshFile> run() {
    while (nextWord())
      if (!take()) return Error{name_ + ":" + std::to_string(words_.lineNumber()) + ": " + wrong_};
    if (inside_) return Error{at(begun_) + "the file ends inside this facet: it is cut off; expected endfacet"};
    if (mesh_.corners.empty())
      return Error{name_ +
                   ": has no triangles, expected a text STL (solid, facet, vertex x y z) or a whole binary one"};
    if (!ended_) mesh_.remarks.emplace_back("the file does not end with endsolid, so it may be cut off");
    return std::move(mesh_);
  }

 private:
  std::string at(std::size_t line) const { return name_ + ":" + std::to_string(line) + ": "; }
  bool fail(const char* wrong) {
    wrong_ = wrong;
    return false;
  }

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

  bool take() {
    if (word_ == "solid" || word_ == "endsolid") {
      words_.skipLine();  // its name may be any words
      ended_ = word_ == "endsolid";
      return endFacet();
    }
    if (word_ == "facet") {
      if (!endFacet()) return false;
      inside_ = true;
      begun_ = words_.lineNumber();
      return true;
    }
    if (word_ == "endfacet") return endFacet();
    return word_ != "vertex" || takePoint();
  }

  bool takePoint() {
    const auto p = nextPoint(words_);
    if (!p) return fail("expected vertex x y z, finite numbers");
    if (!inside_)
      return fail("a vertex stands outside of a facet; expected facet normal x y z, outer loop, vertex x y z");
    if (count_ == 3) return fail("a facet has more than three corners; expected triangles");
    corner_[count_++] = weld_.at(*p);
    return true;
  }

  bool endFacet() {
    if (!inside_) return true;
    inside_ = false;
    if (count_ < 3) return fail("the facet before this line has less than three corners");
    count_ = 0;
    mesh_.corners.push_back(corner_);
    return mesh_.corners.size() <= kMostTriangles || fail("more than 20,000,000 triangles");
  }

  Words words_;
  const std::string& name_;
  MeshFile mesh_;
  Weld weld_{mesh_.points};
  std::string word_;
  std::array<std::uint32_t, 3> corner_{};
  std::size_t count_ = 0, begun_ = 0;
  bool inside_ = false, ended_ = false;
  const char* wrong_ = "";
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
                 " bytes, and a binary STL has at least 84: it is "
                 "damaged, or no STL"};
  return Error{name + ": a binary STL of " + std::to_string(count) + " triangles has " + std::to_string(whole) +
               " bytes, and this file has " + std::to_string(bytes.size()) + ": it is damaged, or no STL"};
}

}  // namespace hapticd::importing
