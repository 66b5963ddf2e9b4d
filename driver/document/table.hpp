// SPDX-License-Identifier: MIT
/// Tables of the keys of a file. One line of a table describes one key: its type, unit, range, default and
/// documentation. The parser and the JSON Schema use the same line.
#pragma once
#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "document/reader.hpp"

namespace hapticd::document {

enum class Type : uint8_t {
  kReal,
  kInteger,
  kBool,
  kChoice,
  kName,
  kText,
  kFile,  ///< a path
  kVector3,
  kQuaternion,  ///< w, x, y, z
  kObject,
  kList,  ///< a list of mappings
  kAny    ///< any node; it is read later, with the plugin's own table
};

struct Key {
  const char* name;
  Type type;
  const char* doc;
  const char* def = nullptr;  ///< default value, as YAML; nullptr if there is none
  bool required = false;
  Range range{-1e308, 1e308};
  std::span<const std::string_view> choices{};
  const Table* table = nullptr;  ///< for kObject and kList: the keys of the mapping
  void (*store)(Reader&, const Node&, const std::string& path, const Key&, void* object) = nullptr;
  const char* shape = "";  ///< for kAny: words for messages that say what is expected

  std::string expected() const;  ///< such as "a number, 10 to 20000 Hz"
};

/// Another table to which an unknown key may belong.
struct Elsewhere {
  const Table* table;
  const char* where;  ///< such as "the device file"
};

struct Table {
  std::span<const Key> keys;
  std::span<const Elsewhere> elsewhere{};  ///< tables in which an unknown key is looked for, to say where it belongs

  const Key* find(std::string_view name) const;
  std::vector<std::string> names() const;
};

/// Makes the key a required one.
constexpr Key required(Key key) {
  key.required = true;
  return key;
}

/// [any] Returns the elements of a list. Of a mapping in its place, these are its values if all of them are mappings;
/// otherwise the mapping is the only element. So they are judged although the dashes are missing.
std::vector<const Node*> elementsOf(const Node& list);

namespace detail {
template <class T, class C>
C classOf(T C::*);
template <class T>
struct ValueType {
  using Type = T;
};
template <class T>
struct ValueType<std::optional<T>> {
  using Type = T;
};
template <auto M>
using Class = decltype(classOf(M));
template <auto M>
auto& member(void* object) {
  return static_cast<Class<M>*>(object)->*M;
}
/// Stores a value in a member, which may be optional.
template <class Member, class Value>
void assign(Member& member, const Value& value) {
  member = value;
}
std::vector<std::string> texts(std::span<const std::string_view> words);
}  // namespace detail

template <auto M>
constexpr Key real(const char* name, Range range, const char* def, const char* doc) {
  return {.name = name,
          .type = Type::kReal,
          .doc = doc,
          .def = def,
          .range = range,
          .store = [](Reader& in, const Node& node, const std::string& path, const Key& key, void* object) {
            if (const auto value = in.number(node, path, key.range)) detail::assign(detail::member<M>(object), *value);
          }};
}

template <auto M>
constexpr Key integer(const char* name, Range range, const char* def, const char* doc) {
  return {.name = name,
          .type = Type::kInteger,
          .doc = doc,
          .def = def,
          .range = range,
          .store = [](Reader& in, const Node& node, const std::string& path, const Key& key, void* object) {
            using T = typename detail::ValueType<std::remove_cvref_t<decltype(detail::member<M>(object))>>::Type;
            if (const auto value = in.whole(node, path, key.range)) detail::member<M>(object) = static_cast<T>(*value);
          }};
}

template <auto M>
constexpr Key boolean(const char* name, const char* def, const char* doc) {
  return {.name = name,
          .type = Type::kBool,
          .doc = doc,
          .def = def,
          .range = {0, 1},
          .store = [](Reader& in, const Node& node, const std::string& path, const Key&, void* object) {
            if (const auto value = in.boolean(node, path)) detail::assign(detail::member<M>(object), *value);
          }};
}

/// Makes a key whose value is one of the choices. The member M is a std::string, or an enumeration in the order of the
/// choices.
template <auto M>
constexpr Key choice(const char* name, std::span<const std::string_view> choices, const char* def, const char* doc) {
  return {.name = name,
          .type = Type::kChoice,
          .doc = doc,
          .def = def,
          .choices = choices,
          .store = [](Reader& in, const Node& node, const std::string& path, const Key& key, void* object) {
            using T = std::remove_cvref_t<decltype(detail::member<M>(object))>;
            const auto index = in.choice(node, path, detail::texts(key.choices));
            if (!index) return;
            if constexpr (std::is_enum_v<T>)
              detail::member<M>(object) = static_cast<T>(*index);
            else
              detail::member<M>(object) = std::string(key.choices[*index]);
          }};
}

template <auto M>
constexpr Key name(const char* name, const char* doc) {
  return {.name = name,
          .type = Type::kName,
          .doc = doc,
          .store = [](Reader& in, const Node& node, const std::string& path, const Key&, void* object) {
            if (const auto value = in.name(node, path)) detail::assign(detail::member<M>(object), *value);
          }};
}

template <auto M>
constexpr Key file(const char* name, const char* doc) {
  return {.name = name,
          .type = Type::kFile,
          .doc = doc,
          .store = [](Reader& in, const Node& node, const std::string& path, const Key&, void* object) {
            if (const auto value = in.existingFile(node, path)) detail::assign(detail::member<M>(object), *value);
          }};
}

template <auto M>
constexpr Key vector3(const char* name, Range range, const char* def, const char* doc) {
  return {.name = name,
          .type = Type::kVector3,
          .doc = doc,
          .def = def,
          .range = range,
          .store = [](Reader& in, const Node& node, const std::string& path, const Key& key, void* object) {
            if (const auto value = in.vector3(node, path, key.range)) detail::assign(detail::member<M>(object), *value);
          }};
}

template <auto M>
constexpr Key quaternion(const char* name, const char* def, const char* doc) {
  return {.name = name,
          .type = Type::kQuaternion,
          .doc = doc,
          .def = def,
          .range = {-1, 1},
          .store = [](Reader& in, const Node& node, const std::string& path, const Key&, void* object) {
            if (const auto value = in.quaternion(node, path)) detail::assign(detail::member<M>(object), *value);
          }};
}

/// Makes a key whose value is a nested mapping. If the member M is a std::optional, it has a value only if the file
/// contains the mapping.
template <auto M>
constexpr Key object(const char* name, const Table& table, const char* doc) {
  return {.name = name,
          .type = Type::kObject,
          .doc = doc,
          .table = &table,
          .store = [](Reader& in, const Node& node, const std::string& path, const Key& key, void* object) {
            auto& target = detail::member<M>(object);
            if constexpr (requires { target.emplace(); })
              in.object(node, path, *key.table, &target.emplace());
            else
              in.object(node, path, *key.table, &target);
          }};
}

/// Makes a key whose value is a list of mappings. If the elements have a member `node`, it keeps the element's node,
/// with its line and column.
template <auto M>
constexpr Key list(const char* name, const Table& table, Range count, const char* doc) {
  return {.name = name,
          .type = Type::kList,
          .doc = doc,
          .range = count,
          .table = &table,
          .store = [](Reader& in, const Node& node, const std::string& path, const Key& key, void* object) {
            auto& target = detail::member<M>(object);
            const auto most = static_cast<size_t>(key.range.max);
            const bool is_right = node.isSequence() && node.items.size() <= most;
            if (!is_right)
              in.problem(node, path,
                         (node.isSequence() ? "a list of " + std::to_string(node.items.size()) : describe(node)) +
                             ", expected " + key.expected() +
                             (node.isMap() ? "; begin each of them with \"- \", as an element of a list" : ""));
            const std::vector<const Node*> elements = elementsOf(node);
            if (elements.size() > most) return;
            target.reserve(elements.size());
            for (size_t i = 0; i < elements.size(); ++i) {
              auto& item = target.emplace_back();
              if constexpr (requires { item.node = &node; }) item.node = elements[i];
              const size_t before = in.problems().size();
              in.object(*elements[i], path + "[" + std::to_string(i) + "]", *key.table, &item);
              if constexpr (requires { item.name; })  // of a mapping of names to elements
                if (node.isMap() && elements[i] != &node && item.name.empty()) {
                  item.name = node.entries[i].key.scalar;
                  const std::string no_name = path + "[" + std::to_string(i) + "].name";
                  auto& told = in.problems();
                  told.erase(std::remove_if(told.begin() + static_cast<std::ptrdiff_t>(before), told.end(),
                                            [&no_name](const Problem& one) {
                                              return one.key == no_name && one.what.starts_with("missing");
                                            }),
                             told.end());
                }
            }
          }};
}

/// Makes a key whose value may be any node. The node is not checked. The member M points to it, so the node must live
/// longer than the object.
template <auto M>
constexpr Key any(const char* name, const char* shape, const char* doc) {
  return {.name = name,
          .type = Type::kAny,
          .doc = doc,
          .store = [](Reader&, const Node& node, const std::string&, const Key&,
                      void* object) { detail::member<M>(object) = &node; },
          .shape = shape};
}

}  // namespace hapticd::document
