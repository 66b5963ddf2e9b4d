// SPDX-License-Identifier: MIT
/// Reads PLY, the format of Greg Turk and of most scanners: a text header, then text or binary of either byte order.
#include <bit>
#include <cstring>

#include "mesh_import/mesh_file.hpp"
#include "mesh_import/mesh_words.hpp"

namespace hapticd::importing {
namespace {

using Eigen::Vector3d;

enum class Type : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble, kUnknown };

Type typeOf(std::string_view word) {
  constexpr std::string_view kNames[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                            {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                            {"float", "float32"}, {"double", "float64"}};
  for (std::size_t i = 0; i < std::size(kNames); ++i)
    if (word == kNames[i][0] || word == kNames[i][1]) return static_cast<Type>(i);
  return Type::kUnknown;
}

std::size_t sizeOf(Type type) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8, 0};
  return kSizes[static_cast<std::size_t>(type)];
}

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

/// Reads the values of the body one after another.
class Body {
 public:
  enum class Form : std::uint8_t { kText, kLittle, kBig };
  Body(std::string_view bytes, Form form) : bytes_(bytes), words_(bytes), form_(form) { words_.nextLine(); }

  std::optional<double> next(Type type) {
    if (form_ == Form::kText) {
      std::string_view word = words_.next();
      while (word.empty() && words_.nextLine()) word = words_.next();
      return finiteNumber(word);
    }
    const std::size_t size = sizeOf(type);
    if (bytes_.size() - place_ < size) return {};
    std::array<char, 8> raw{};
    for (std::size_t i = 0; i < size; ++i) raw[form_ == Form::kBig ? size - 1 - i : i] = bytes_[place_ + i];
    place_ += size;
    return decode(type, raw);
  }

 private:
  template <class T>
  static double as(const std::array<char, 8>& raw) {
    T value;
    std::memcpy(&value, raw.data(), sizeof value);
    return static_cast<double>(value);
  }
  static std::optional<double> decode(Type type, const std::array<char, 8>& raw) {
    switch (type) {
      case Type::kInt8:
        return as<std::int8_t>(raw);
      case Type::kUint8:
        return as<std::uint8_t>(raw);
      case Type::kInt16:
        return as<std::int16_t>(raw);
      case Type::kUint16:
        return as<std::uint16_t>(raw);
      case Type::kInt32:
        return as<std::int32_t>(raw);
      case Type::kUint32:
        return as<std::uint32_t>(raw);
      case Type::kFloat:
        return as<float>(raw);
      case Type::kDouble:
        return as<double>(raw);
      default:
        return {};
    }
  }

  std::string_view bytes_;
  std::size_t place_ = 0;
  Words words_;
  Form form_;
};

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name) : words_(bytes), name_(name) {}

  Result<MeshFile> run() {
    if (!readHeader()) return Error{name_ + ":" + std::to_string(words_.lineNumber()) + ": " + wrong_};
    Body body(words_.rest(), form_);
    for (const Element& element : elements_)
      for (std::size_t i = 0; i < element.count && !element.properties.empty(); ++i)
        if (!readItem(element, body))
          return Error{name_ + ": " + std::string(element.name) + " " + std::to_string(i) + ": " + wrong_};
    if (mesh_.corners.empty()) return Error{name_ + ": has no triangles, expected an element face with vertex_indices"};
    return std::move(mesh_);
  }

 private:
  bool fail(const char* wrong) {
    wrong_ = wrong;
    return false;
  }

  bool readHeader() {
    if (!words_.nextLine() || words_.next() != "ply") return fail("not a PLY, expected its first line to be ply");
    while (words_.nextLine()) {
      const std::string_view word = words_.next();
      if (word == "end_header") return true;
      if (word == "format" && !readForm(words_.next())) return false;
      if (word == "element" && !readElement()) return false;
      if (word == "property" && !readProperty()) return false;
    }
    return fail("the header has no end_header");
  }

  bool readForm(std::string_view word) {
    if (word == "binary_little_endian") form_ = Body::Form::kLittle;
    if (word == "binary_big_endian") form_ = Body::Form::kBig;
    return word == "ascii" || form_ != Body::Form::kText ||
           fail("unknown format, expected ascii, binary_little_endian or binary_big_endian");
  }

  bool readElement() {
    Element element;
    element.name = words_.next();
    const auto count = finiteNumber(words_.next());
    if (!count || *count < 0 || *count > 4e9)
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
      if (property.count == Type::kUnknown) return fail("unknown type of a list's length");
      word = words_.next();
    }
    property.type = typeOf(word);
    property.name = words_.next();
    if (property.type == Type::kUnknown) return fail("unknown type, expected int, float, double, uchar or the like");
    elements_.back().properties.push_back(property);
    return true;
  }

  bool readItem(const Element& element, Body& body) {
    Vector3d p = Vector3d::Zero();
    for (const Property& property : element.properties) {
      if (property.count != Type::kUnknown) {
        const bool corners =
            element.name == "face" && (property.name == "vertex_indices" || property.name == "vertex_index");
        if (!readList(property, corners, body)) return false;
        continue;
      }
      const auto value = body.next(property.type);
      if (!value) return fail("the file ends, or holds something other than a number");
      if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z')
        p[property.name[0] - 'x'] = *value;
    }
    if (element.name != "vertex") return true;
    if (!p.allFinite()) return fail("a coordinate is not finite");
    points_.push_back(weld_.at(p));
    return true;
  }

  bool readList(const Property& property, bool corners, Body& body) {
    const auto count = body.next(property.count);
    if (!count || !(*count >= 0) || *count > 1e6)
      return fail("a list's length is missing, negative or above 1,000,000");
    polygon_.clear();
    for (int k = 0; k < static_cast<int>(*count); ++k) {
      const auto index = body.next(property.type);
      if (!index) return fail("the file ends inside a list, or holds something other than a number");
      if (!corners) continue;
      if (!(*index >= 0) || *index >= static_cast<double>(points_.size())) return fail("its vertex is out of range");
      polygon_.push_back(points_[static_cast<std::size_t>(*index)]);
    }
    for (std::size_t k = 2; k < polygon_.size(); ++k)
      mesh_.corners.push_back({polygon_[0], polygon_[k - 1], polygon_[k]});
    return mesh_.corners.size() <= kMostTriangles || fail("more than 20,000,000 triangles");
  }

  Words words_;
  const std::string& name_;
  Body::Form form_ = Body::Form::kText;
  std::vector<Element> elements_;
  MeshFile mesh_;
  Weld weld_{mesh_.points};
  std::vector<std::uint32_t> points_, polygon_;
  std::string wrong_;
};

}  // namespace

Result<MeshFile> parsePlyMesh(std::string_view bytes, const std::string& name) {
  return Reader(bytes, name).run();
}

}  // namespace hapticd::importing
