// SPDX-License-Identifier: MIT
/// Reads OBJ, the format of Wavefront: the lines `v`, `f`, `o`, `mtllib` and `usemtl`. Others are passed over.
#include <map>

#include "kernels/part/names.hpp"
#include "mesh_import/mesh_colours.hpp"
#include "mesh_import/mesh_file.hpp"
#include "mesh_import/mesh_text.hpp"
#include "mesh_import/obj_materials.hpp"
#include "mesh_import/polygons.hpp"
#include "mesh_import/vertex_colours.hpp"
#include "mesh_import/wrong_lines.hpp"

namespace hapticd::importing {
namespace {

class ObjReader {
 public:
  ObjReader(std::string_view bytes, const std::string& name, const ReadBeside& read_beside)
      : words_(bytes), name_(name), materials_(read_beside) {}

  Result<MeshFile> run() {
    while (words_.nextLine()) {
      const std::string_view kind = words_.next();
      if (kind == "v") readPoint();
      if (kind == "o") object_ = plainLine();
      if (kind == "mtllib") materials_.addLibrary(words_.restOfLine());
      if (kind == "usemtl") materials_.use(words_.restOfLine());
      groups_ += kind == "g" ? 1 : 0;
      if ((kind == "f" || kind == "fo") && !readFace()) tell(line_);
      if (mesh_.corners.size() > kMostTriangles)
        return Error{at(line_) + "the file has more than 20,000,000 triangles"};
      free_form_ = free_form_ || kind == "surf" || kind == "curv";
      lines_ += kind == "l" ? 1 : 0;
    }
    for (const Late& late : late_) {
      object_ = late.object;
      materials_.goBackTo(late.material);
      if (!addFace(late.indices, late.line)) tell(late.line);
    }
    if (!wrong_lines_.none()) return wrong_lines_.error(name_);
    tellWhatIsDropped();
    if (mesh_.corners.empty()) return Error{name_ + ": " + whatIsMissing()};
    mesh_.colours = materials_.colours(mesh_.remarks);
    if (mesh_.colours.empty()) mesh_.colours = std::move(colours_).colours(mesh_.corners.size());
    return std::move(mesh_);
  }

 private:
  /// A face that stands before one of its points.
  struct Late {
    std::vector<std::int64_t> indices;
    std::size_t line;
    std::string object;
    std::uint32_t material;
  };

  std::string at(std::size_t line) const { return name_ + ":" + std::to_string(line) + ": "; }
  bool fail(std::string wrong) {
    wrong_ = std::move(wrong);
    return false;
  }

  void tell(std::size_t line) { wrong_lines_.add(line, at(line) + wrong_); }

  /// Reads a point. A wrong one is kept as well, because the faces count it.
  void readPoint() {
    const auto p = nextPoint(words_);
    points_.push_back(weld_.at(p.value_or(Eigen::Vector3d::Zero())));
    colours_.add(nextColour());
    if (p) return;
    fail("'" + plainWord(words_.wholeLine()) + "' is not a point; expected v x y z, finite numbers");
    tell(words_.lineNumber());
  }

  /// Reads the colour that some programs write after a point: red, green and blue, from 0 to 1. 0 if there is none; a
  /// single number is a weight.
  std::uint32_t nextColour() {
    const auto red = finiteNumber(words_.next()), green = finiteNumber(words_.next()),
               blue = finiteNumber(words_.next());
    return red && green && blue ? colourWord(*red, *green, *blue) : 0;
  }

  /// Reads the indices of a face. They count from 1, or backward from the last point if they are negative. A line that
  /// ends in \ goes on in the next one.
  bool readFace() {
    indices_.clear();
    line_ = words_.lineNumber();
    const auto last = static_cast<std::int64_t>(points_.size());
    bool late = false;
    for (std::string_view word = words_.next(); !word.empty() && word[0] != '#'; word = words_.next()) {
      if (word == "\\") {
        if (!words_.nextLine()) break;
        continue;
      }
      const bool goes_on = word.back() == '\\';
      if (goes_on) word.remove_suffix(1);
      std::int64_t index = 0;
      const std::string_view digits = word.substr(0, word.find('/'));
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
      if (error != std::errc() || end != digits.data() + digits.size() || index == 0 || index < -last)
        return fail(outOfRange(word));
      late = late || index > last;
      indices_.push_back(index < 0 ? index + last + 1 : index);
      if (goes_on && !words_.nextLine()) break;
    }
    if (late) return late_.push_back({indices_, line_, object_, materials_.present()}), true;
    return addFace(indices_, line_);
  }

  std::string outOfRange(std::string_view word) const {
    const std::string what = "the face names the point '" + plainWord(word) + "'";
    if (points_.empty()) return what + ", but no line v x y z stands before it";
    return what + "; expected 1 to " + std::to_string(points_.size());
  }

  bool addFace(const std::vector<std::int64_t>& indices, std::size_t line) {
    line_ = line;
    const std::size_t first = mesh_.corners.size();
    std::vector<std::uint32_t> polygon;
    std::vector<std::int64_t> vertices;
    for (const std::int64_t index : indices) {
      if (index > static_cast<std::int64_t>(points_.size())) return fail(outOfRange(std::to_string(index)));
      vertices.push_back(index - 1);
      polygon.push_back(points_[static_cast<std::size_t>(index - 1)]);
    }
    if (polygon.size() < 3)
      return fail("the face has " + std::to_string(polygon.size()) + " points; expected f and at least three");
    if (!cutPolygon(mesh_.points, std::move(polygon), mesh_.corners)) return fail(kPolygonTooLarge);
    mesh_.object.resize(mesh_.corners.size(), objectIndex());
    materials_.coverTo(mesh_.corners.size());
    colours_.paint(vertices, points_, mesh_.corners, first);
    return true;
  }

  /// Returns the index of the object to which faces belong now.
  std::uint32_t objectIndex() {
    const auto [known, is_new] = object_numbers_.try_emplace(object_, static_cast<std::uint32_t>(mesh_.objects.size()));
    if (is_new) mesh_.objects.push_back(object_);
    return known->second;
  }

  /// Returns the rest of the line as a name.
  std::string plainLine() {
    std::string name;
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next())
      name += (name.empty() ? "" : " ") + std::string(word);
    return brep::plainText(name);
  }

  /// Notes what the file has and a part has not.
  void tellWhatIsDropped() {
    if (mesh_.objects.size() > 1 || groups_ < 2) return;
    mesh_.remarks.push_back("the file has " + std::to_string(groups_) +
                            " groups (g), which are not kept: its triangles are one body; "
                            "name objects (o) to get one body for each");
  }

  std::string whatIsMissing() const {
    std::string text = "the file has no triangles; expected lines f i j k";
    if (free_form_)
      return text + "; it holds free-form surfaces: convert them to triangles in the program that wrote it";
    if (points_.empty()) return text;
    return text + "; it holds points" + (lines_ > 0 ? " and lines" : "") + ", but no faces";
  }

  Words words_;
  const std::string& name_;
  MeshFile mesh_;
  Weld weld_{mesh_.points};
  std::vector<std::uint32_t> points_;  ///< index of each point of the file after equal points were joined
  std::vector<std::int64_t> indices_;
  std::vector<Late> late_;
  ObjMaterials materials_;
  VertexColours colours_;  ///< count where no material has a colour
  std::string object_;     ///< the object to which faces belong
  std::map<std::string, std::uint32_t> object_numbers_;
  std::size_t line_ = 0, lines_ = 0, groups_ = 0;
  bool free_form_ = false;
  std::string wrong_;
  WrongLines wrong_lines_;
};

}  // namespace

Result<MeshFile> parseObjMesh(std::string_view bytes, const std::string& name, const ReadBeside& read_beside) {
  return ObjReader(bytes, name, read_beside).run();
}

}  // namespace hapticd::importing
