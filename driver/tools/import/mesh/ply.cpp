// SPDX-License-Identifier: MIT
/// Reads PLY, the format of Greg Turk and of most scanners: a text header, then text or binary of either byte order.
#include <algorithm>
#include <cmath>

#include "base/short_number.hpp"
#include "mesh_import/mesh_file.hpp"
#include "mesh_import/ply_body.hpp"
#include "mesh_import/ply_colours.hpp"
#include "mesh_import/polygons.hpp"
#include "mesh_import/vertex_colours.hpp"
#include "mesh_import/wrong_lines.hpp"

namespace hapticd::importing {
namespace {

using Eigen::Vector3d;
using ply::Body, ply::Lines, ply::Type, ply::typeOf;

struct Property {
  std::string_view name;
  Type type = Type::kUnknown;   ///< type of the value, or of each value in a list
  Type count = Type::kUnknown;  ///< type of a list's length; kUnknown if it is not a list
};
struct Element {
  std::string_view name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

constexpr const char* kTooMany = "the file has more than 20,000,000 triangles";

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name, Lines lines) : words_(bytes), name_(name), lines_(lines) {}

  Result<MeshFile> run() {
    if (!readHeader() || !judgeHeader())
      return Error{name_ + ":" + std::to_string(words_.lineNumber()) + ": " + wrong_};
    Body body(words_.rest(), form_, lines_);
    has_text_ = body.isText();
    for (const Element& element : elements_)
      if (!element.properties.empty() && !readItems(element, body)) return wrong_lines_.error(name_);
    if (!wrong_lines_.none()) return wrong_lines_.error(name_);
    if (lines_ == Lines::kAnywhere && !body.atEnd()) return Error{name_ + ": more values follow the last element"};
    if (longer_ > 0)
      mesh_.remarks.push_back(
          std::to_string(longer_) +
          (longer_ == 1 ? " line holds more values than the header states; the rest of this line was passed over"
                        : " lines hold more values than the header states; the rest of these lines was passed over"));
    if (lines_ == Lines::kAnywhere)
      mesh_.remarks.emplace_back("lines and elements do not agree; the values were read one after another");
    if (mesh_.corners.empty()) return Error{name_ + ": " + whatIsMissing()};
    mesh_.colours = std::move(colours_).colours(mesh_.corners.size());
    return std::move(mesh_);
  }
  /// True if the body is text, so that another division of its lines may fit.
  bool hasText() const { return has_text_; }

 private:
  /// Reads all items of an element. @return false if the others cannot be read either
  bool readItems(const Element& element, Body& body) {
    for (std::size_t i = 0; i < element.count; ++i) {
      const bool there = body.nextItem() || failAt(body, "");
      if (there && readItem(element, body)) {
        longer_ += body.passRest() ? 1 : 0;
        if (mesh_.corners.size() <= kMostTriangles) continue;
        fail(kTooMany);
      }
      wrong_lines_.add(body.lineNumber(), where(element, i, body) + wrong_);
      const bool own_lines = body.isText() && lines_ == Lines::kOneAnItem;
      if (body.ended() || !own_lines || mesh_.corners.size() > kMostTriangles) return false;
      if (element.name == "vertex" && points_.size() == i) addPoint(Vector3d::Zero());  // it counts
      body.passRest();
    }
    return true;
  }

  bool fail(std::string wrong) {
    wrong_ = std::move(wrong);
    return false;
  }

  std::string where(const Element& element, std::size_t item, const Body& body) const {
    const std::size_t line = body.lineNumber();
    return name_ + (line > 0 ? ":" + std::to_string(words_.lineNumber() + line) : "") + ": " +
           std::string(element.name) + " " + std::to_string(item) + " (from 0) of " + std::to_string(element.count) +
           ": ";
  }

  /// A value was missing: says why.
  bool failAt(const Body& body, const std::string& expected) {
    if (body.ended())
      return fail(
          "the file ends here, but the header states more; "
          "the file is cut off, or the number in the header is wrong");
    if (body.lastWord().empty()) return fail("the line ends before " + expected);
    return fail("'" + plainWord(body.lastWord()) + "' is not a number; expected " + expected);
  }

  /// Says what is there if there are no triangles.
  std::string whatIsMissing() const {
    std::string text = "the file has no triangles; expected an element face with vertex_indices";
    if (!points_.empty()) text += "; it holds points, but no faces";
    return text;
  }

  bool readHeader() {
    if (!words_.nextLine() || words_.next() != "ply")
      return fail("this is not a PLY file; expected ply as its first line");
    while (words_.nextLine()) {
      const std::string_view word = words_.next();
      if (word == "end_header") return true;
      if (word == "format" && !readForm(words_.next())) return false;
      if (word == "element" && !readElement()) return false;
      if (word == "property" && !readProperty()) return false;
    }
    return fail(
        "the header has no end; expected a line end_header, and each element and property on a line of its own");
  }

  /// Refuses vertices without a place, and faces that stand before their vertices.
  bool judgeHeader() {
    bool vertices = false;
    for (const Element& element : elements_) {
      if (element.name == "face" && element.count > 0 && !vertices)
        return fail("the faces stand before the vertices; expected element vertex first");
      if (element.name != "vertex") continue;
      vertices = true;
      for (const char* axis : {"x", "y", "z"})
        if (std::none_of(element.properties.begin(), element.properties.end(),
                         [&](const Property& p) { return p.name == axis && p.count == Type::kUnknown; }))
          return fail(std::string("the element vertex has no property ") + axis + "; expected x, y and z");
    }
    return true;
  }

  bool readForm(std::string_view word) {
    if (word == "binary_little_endian") form_ = Body::Form::kLittle;
    if (word == "binary_big_endian") form_ = Body::Form::kBig;
    return word == "ascii" || form_ != Body::Form::kText ||
           fail("the format '" + plainWord(word) +
                "' is unknown; expected ascii, binary_little_endian or binary_big_endian");
  }

  bool readElement() {
    Element element;
    element.name = words_.next();
    const auto count = finiteNumber(words_.next());
    if (!count || *count < 0 || *count > 4e9 || *count != std::floor(*count))
      return fail(
          "this line has no name or no valid count; expected \"element NAME COUNT\", such as \"element vertex 8\"");
    element.count = static_cast<std::size_t>(*count);
    elements_.push_back(std::move(element));
    return true;
  }

  bool readProperty() {
    if (elements_.empty()) return fail("a property comes before the first element");
    Property property;
    std::string_view word = words_.next();
    if (word == "list") {
      property.count = typeOf(words_.next());
      if (property.count == Type::kUnknown)
        return fail("the type of the list's length is unknown; expected uchar or the like");
      word = words_.next();
    }
    property.type = typeOf(word);
    property.name = words_.next();
    if (property.type == Type::kUnknown)
      return fail("the type '" + plainWord(word) + "' is unknown; expected int, float, double, uchar or the like");
    elements_.back().properties.push_back(property);
    return true;
  }

  bool readItem(const Element& element, Body& body) {
    Vector3d p = Vector3d::Zero();
    const std::size_t first = mesh_.corners.size();
    colour_.beginItem();
    for (const Property& property : element.properties) {
      if (property.count != Type::kUnknown) {
        const bool corners = property.name == "vertex_indices" || property.name == "vertex_index";
        if (!readList(property, corners && (element.name == "face" || element.name == "tristrips"), body)) return false;
        if (corners && element.name == "face" && !addPolygon()) return false;
        if (corners && element.name == "tristrips" && !addStrip()) return false;
        continue;
      }
      const auto value = body.next(property.type);
      if (!value) return failAt(body, "the value of the property " + std::string(property.name));
      if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z')
        p[property.name[0] - 'x'] = *value;
      colour_.see(property.name, property.type, *value);
    }
    if ((element.name == "face" || element.name == "tristrips") && colour_.word() != 0)
      colours_.fill(first, mesh_.corners.size(), colour_.word());  // it comes before those of its vertices
    if (element.name != "vertex") return true;
    if (!p.allFinite()) return fail("a coordinate is not a finite number");
    addPoint(p);
    return true;
  }

  void addPoint(const Vector3d& p) {
    points_.push_back(weld_.at(p));
    colours_.add(colour_.word());
  }

  /// Reads a list into `list_`, or passes over it.
  bool readList(const Property& property, bool kept, Body& body) {
    constexpr double kLongest = 1e8;
    const auto count = body.next(property.count);
    if (!count) return failAt(body, "the length of a list");
    if (!(*count >= 0) || *count > kLongest || *count != std::floor(*count))
      return fail("the length of a list is negative, not whole or above 100,000,000");
    list_.clear();
    for (auto left = static_cast<std::size_t>(*count); left > 0; --left) {
      const auto value = body.next(property.type);
      if (!value) return failAt(body, "an entry of a list");
      if (kept) list_.push_back(*value);
    }
    return true;
  }

  bool isPoint(double index) {
    if (index >= 0 && index < static_cast<double>(points_.size()) && index == std::floor(index)) return true;
    const std::string vertex = "its vertex " + withDigits(index, 9);
    if (points_.empty()) return fail(vertex + " is not there: the file has no vertices");
    return fail(vertex + " is out of range, expected 0 to " + std::to_string(points_.size() - 1));
  }

  bool addPolygon() {
    const std::size_t first = mesh_.corners.size();
    std::vector<std::uint32_t> polygon;
    for (const double index : list_) {
      if (!isPoint(index)) return false;
      polygon.push_back(points_[static_cast<std::size_t>(index)]);
    }
    if (!cutPolygon(mesh_.points, std::move(polygon), mesh_.corners)) return fail(kPolygonTooLarge);
    colours_.paint(list_, points_, mesh_.corners, first);
    return true;
  }

  /// Adds the triangles of strips, each of which uses the last two points again, in turns with one and the other sense.
  /// A -1 begins a new strip.
  bool addStrip() {
    const std::size_t first = mesh_.corners.size();
    std::size_t begin = 0;
    for (std::size_t i = 0; i < list_.size(); ++i) {
      if (list_[i] == -1) {
        begin = i + 1;
        continue;
      }
      if (!isPoint(list_[i])) return false;
      if (i < begin + 2) continue;
      const auto at = [&](std::size_t k) { return points_[static_cast<std::size_t>(list_[k])]; };
      const std::size_t odd = (i - begin) % 2;
      mesh_.corners.push_back({at(i - 2 + odd), at(i - 1 - odd), at(i)});
      if (mesh_.corners.size() > kMostTriangles) return fail(kTooMany);
    }
    colours_.paint(list_, points_, mesh_.corners, first);
    return true;
  }

  Words words_;
  const std::string& name_;
  Lines lines_;
  bool has_text_ = false;
  Body::Form form_ = Body::Form::kText;
  std::vector<Element> elements_;
  MeshFile mesh_;
  Weld weld_{mesh_.points};
  std::vector<std::uint32_t> points_;  ///< index of each vertex after equal points were joined
  std::vector<double> list_;
  ply::ItemColour colour_;
  VertexColours colours_;
  std::size_t longer_ = 0;  ///< number of lines with more values than the header states
  std::string wrong_;
  WrongLines wrong_lines_;
};

}  // namespace

Result<MeshFile> parsePlyMesh(std::string_view bytes, const std::string& name) {
  Reader by_line(bytes, name, Lines::kOneAnItem);
  auto mesh = by_line.run();
  if (mesh || !by_line.hasText()) return mesh;
  auto anywhere = Reader(bytes, name, Lines::kAnywhere).run();
  return anywhere ? std::move(anywhere) : std::move(mesh);
}

}  // namespace hapticd::importing
