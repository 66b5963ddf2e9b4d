// SPDX-License-Identifier: MIT
/// Parameter tables for plugins and device modules in C++. One line per parameter gives its row in the C table, its
/// default, its checks and the member that gets the value. shape.hpp and device.hpp include this header.
#pragma once
#if __cplusplus < 202002L
#error "the C++ headers of hapticd need C++20: compile with -std=c++20"
#endif
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "abi.h"

namespace hapticd {

/// Names the member of class T that holds a value: exactly one of the pointers is set.
template <class T>
struct Member {
  double T::* real = nullptr;
  int T::* integer = nullptr;
  bool T::* boolean = nullptr;
  std::string T::* text = nullptr;
  std::vector<double> T::* array = nullptr;
  std::array<double, 3> T::* vector3 = nullptr;

  constexpr Member() = default;
  constexpr Member(double T::* m) : real(m) {}   // NOLINT: implicit on purpose, so that a table line can name a member
  constexpr Member(int T::* m) : integer(m) {}   // NOLINT
  constexpr Member(bool T::* m) : boolean(m) {}  // NOLINT
  constexpr Member(std::string T::* m) : text(m) {}               // NOLINT
  constexpr Member(std::vector<double> T::* m) : array(m) {}      // NOLINT
  constexpr Member(std::array<double, 3> T::* m) : vector3(m) {}  // NOLINT
};

/// A parameter of class T, and the member that holds its value.
template <class T>
struct Field {
  hsp_param param{};
  Member<T> member;
};

/// Each function makes one line of the table: id (a dot nests keys), member, unit, range, default, and one sentence of
/// documentation.
template <class T>
struct Fields {
  static constexpr hsp_param blank(uint32_t kind, const char* id, const char* unit, uint32_t flags, const char* doc) {
    hsp_param p{};
    p.struct_size = sizeof(hsp_param);
    p.kind = kind;
    p.flags = flags;
    p.id = id;
    p.unit = unit;
    p.doc = doc;
    return p;
  }
  static constexpr Field<T> real(const char* id, double T::* member, const char* unit, double min, double max,
                                 double def, const char* doc, uint32_t flags = 0) {
    hsp_param p = blank(HSP_REAL, id, unit, flags, doc);
    p.min = min, p.max = max, p.def = def;
    return {p, member};
  }
  static constexpr Field<T> integer(const char* id, int T::* member, const char* unit, int min, int max, int def,
                                    const char* doc, uint32_t flags = 0) {
    hsp_param p = blank(HSP_INT, id, unit, flags, doc);
    p.min = min, p.max = max, p.def = def;
    return {p, member};
  }
  static constexpr Field<T> boolean(const char* id, bool T::* member, bool def, const char* doc, uint32_t flags = 0) {
    hsp_param p = blank(HSP_BOOL, id, "", flags, doc);
    p.min = 0, p.max = 1, p.def = def ? 1 : 0;
    return {p, member};
  }
  /// Makes a parameter that is one word of `choices`, which must have static storage. The member holds the index of the
  /// word.
  template <size_t N>
  static constexpr Field<T> choice(const char* id, int T::* member, const char* const (&choices)[N], int def,
                                   const char* doc, uint32_t flags = 0) {
    hsp_param p = blank(HSP_ENUM, id, "", flags, doc);
    p.min = 0, p.max = N - 1, p.def = def;
    p.choices = choices;
    p.choice_count = N;
    return {p, member};
  }
  static constexpr Field<T> path(const char* id, std::string T::* member, const char* doc, uint32_t flags = 0) {
    return {blank(HSP_PATH, id, "", flags, doc), member};
  }
  static constexpr Field<T> text(const char* id, std::string T::* member, const char* def, const char* doc,
                                 uint32_t flags = 0) {
    hsp_param p = blank(HSP_TEXT, id, "", flags, doc);
    p.def_text = def;
    return {p, member};
  }
  /// Makes a parameter that may be any structure of lists and mappings. The member holds it as JSON text, and the
  /// module itself checks it.
  static constexpr Field<T> data(const char* id, std::string T::* member, const char* def, const char* doc,
                                 uint32_t flags = 0) {
    hsp_param p = blank(HSP_DATA, id, "", flags, doc);
    p.def_text = def;
    return {p, member};
  }
  /// Makes a parameter of three numbers. `def` is their default as text, such as "[0, 1, 0]".
  static constexpr Field<T> vector3(const char* id, std::array<double, 3> T::* member, const char* unit, double min,
                                    double max, const char* def, const char* doc, uint32_t flags = 0) {
    return {arrayParam(id, unit, 3, 3, 3, min, max, def, doc, flags), member};
  }
  /// Makes a parameter of rows of `columns` numbers each, with min_count to max_count numbers in all.
  static constexpr Field<T> array(const char* id, std::vector<double> T::* member, const char* unit, uint32_t columns,
                                  uint32_t min_count, uint32_t max_count, double min, double max, const char* def,
                                  const char* doc, uint32_t flags = 0) {
    return {arrayParam(id, unit, columns, min_count, max_count, min, max, def, doc, flags), member};
  }

 private:
  static constexpr hsp_param arrayParam(const char* id, const char* unit, uint32_t columns, uint32_t min_count,
                                        uint32_t max_count, double min, double max, const char* def, const char* doc,
                                        uint32_t flags) {
    hsp_param p = blank(HSP_ARRAY, id, unit, flags, doc);
    p.min = min, p.max = max;
    p.columns = columns, p.min_count = min_count, p.max_count = max_count;
    p.def_text = def;
    return p;
  }
};

/// Joins tables, so that a class can add its own lines to those of a base class: `join(Base::fields<T>(),
/// std::array{...})`.
template <class T, size_t... N>
constexpr auto join(const std::array<Field<T>, N>&... tables) {
  std::array<Field<T>, (N + ...)> all{};
  size_t i = 0;
  (
      (void)[&] {
        for (const Field<T>& field : tables) all[i++] = field;
      }(),
      ...);
  return all;
}

namespace detail {

/// Returns the numbers of a default such as "[[0, 1], [2, 3]]" in reading order.
inline std::vector<double> numbersIn(const char* text) {
  std::vector<double> numbers;
  while (text != nullptr && *text != '\0') {
    char* end = nullptr;
    const double value = std::strtod(text, &end);
    if (end == text) {
      ++text;
    } else {
      numbers.push_back(value);
      text = end;
    }
  }
  return numbers;
}

inline void writeLog(const hsp_host* host, int32_t level, const std::string& text) {
  if (host != nullptr && host->log != nullptr) host->log(host, level, text.c_str());
}
inline void logError(const hsp_host* host, const std::string& text) {
  writeLog(host, HSP_LOG_ERROR, text);
}

/// [main] Calls `action`. The text of an exception, after `before`, becomes the error that the user reads. Returns
/// HSP_OK, HSP_E_NOMEM, or `failed` after any other exception. @param what the function that `action` calls
template <class Action>
hsp_status guarded(const hsp_host* host, const char* before, const char* what, hsp_status failed, Action action) {
  try {
    action();
    return HSP_OK;
  } catch (const std::bad_alloc&) {
    return HSP_E_NOMEM;
  } catch (const std::exception& e) {
    logError(host, std::string(before) + e.what());
  } catch (...) {
    logError(host, std::string(before) + what +
                       " threw an object that is not a std::exception; "
                       "expected std::runtime_error with a text for the user");
  }
  return failed;
}

/// [main] Puts the defaults of the table into the members of a new object. This function is not inlined, because g++ 12
/// would then warn about members that the object does not have.
template <class T, size_t N>
[[gnu::noinline]] void applyDefaults(T& object, const std::array<Field<T>, N>& fields) {
  for (const Field<T>& field : fields) {
    const hsp_param& p = field.param;
    if (const auto m = field.member.real) object.*m = p.def;
    if (const auto m = field.member.integer) object.*m = static_cast<int>(p.def);
    if (const auto m = field.member.boolean) object.*m = p.def != 0;
    if (const auto m = field.member.text) object.*m = p.def_text != nullptr ? p.def_text : "";
    if (const auto m = field.member.array) object.*m = numbersIn(p.def_text);
    if (const auto m = field.member.vector3) {
      const std::vector<double> numbers = numbersIn(p.def_text);
      for (size_t i = 0; i < 3; ++i) (object.*m)[i] = i < numbers.size() ? numbers[i] : 0;
    }
  }
}

/// [main] Makes an object with the defaults of its table. Returns nullptr if that fails, after it has logged why.
template <class T, size_t N>
T* make(const hsp_host* host, const std::array<Field<T>, N>& fields) {
  T* object = nullptr;
  const std::string before = std::string(T::kInfo.name) + ": ";
  const hsp_status made = guarded(host, before.c_str(), "the constructor", HSP_E_ARG, [&] {
    object = new T;
    applyDefaults(*object, fields);
  });
  if (made == HSP_E_NOMEM) logError(host, before + "there is not enough memory");
  return made == HSP_OK ? object : nullptr;
}

inline bool inRange(const hsp_param& p, double x) {
  return std::isfinite(x) && x >= p.min && x <= p.max;
}

/// Returns what is wrong with `value` for parameter `p`, or an empty text if it is valid.
inline std::string complaint(const hsp_param& p, const hsp_value& value) {
  char text[256] = "";
  const bool numeric = p.kind == HSP_REAL || p.kind == HSP_INT || p.kind == HSP_BOOL || p.kind == HSP_ENUM;
  if (value.kind != p.kind) {
    std::snprintf(text, sizeof text, "%s: value of kind %u, expected kind %u", p.id, value.kind, p.kind);
  } else if (numeric && !inRange(p, value.number)) {
    std::snprintf(text, sizeof text, "%s: %g %s, expected %g to %g", p.id, value.number, p.unit, p.min, p.max);
  } else if (numeric && p.kind != HSP_REAL && value.number != std::floor(value.number)) {
    std::snprintf(text, sizeof text, "%s: %g, expected a whole number", p.id, value.number);
  } else if (p.kind == HSP_ARRAY) {
    const bool ragged = p.columns != 0 && value.count % p.columns != 0;
    if (ragged || value.count < p.min_count || value.count > p.max_count || (value.count > 0 && !value.numbers))
      std::snprintf(text, sizeof text, "%s: %u numbers, expected %u to %u in rows of %u", p.id, value.count,
                    p.min_count, p.max_count, p.columns);
    for (uint32_t i = 0; text[0] == '\0' && i < value.count; ++i)
      if (!inRange(p, value.numbers[i]))
        std::snprintf(text, sizeof text, "%s: %g %s, expected %g to %g", p.id, value.numbers[i], p.unit, p.min, p.max);
  } else if (!numeric && value.text == nullptr) {
    std::snprintf(text, sizeof text, "%s: no text given", p.id);
  }
  return text;
}

/// [rt] Assigns a number, which the caller has checked, to the member of a numeric parameter.
template <class T>
void assignNumber(T& object, const Field<T>& field, double number) noexcept {
  if (const auto m = field.member.real) object.*m = number;
  if (const auto m = field.member.integer) object.*m = static_cast<int>(number);
  if (const auto m = field.member.boolean) object.*m = number != 0;
}

/// [main] Checks a value and assigns it. If the value is wrong, logs why and returns HSP_E_ARG.
template <class T, size_t N>
hsp_status assign(T& object, const std::array<Field<T>, N>& fields, const hsp_host* host, uint32_t index,
                  const hsp_value* value) {
  if (index >= N || value == nullptr) return HSP_E_ARG;
  const Field<T>& field = fields[index];
  if (const std::string wrong = complaint(field.param, *value); !wrong.empty()) {
    logError(host, wrong);
    return HSP_E_ARG;
  }
  if (const auto m = field.member.text) {
    object.*m = value->text;
  } else if (const auto v = field.member.array) {
    (object.*v).assign(value->numbers, value->numbers + value->count);
  } else if (const auto a = field.member.vector3) {
    for (size_t i = 0; i < 3; ++i) (object.*a)[i] = value->numbers[i];
  } else {
    assignNumber(object, field, value->number);
  }
  return HSP_OK;
}

/// [main] Fetches the current value of one parameter. The pointers in `value` are valid until the object changes.
template <class T, size_t N>
hsp_status fetch(const T& object, const std::array<Field<T>, N>& fields, uint32_t index, hsp_value* value) {
  if (index >= N || value == nullptr) return HSP_E_ARG;
  const Field<T>& field = fields[index];
  *value = hsp_value{field.param.kind, 0, 0, nullptr, nullptr};
  if (const auto m = field.member.real) value->number = object.*m;
  if (const auto m = field.member.integer) value->number = object.*m;
  if (const auto m = field.member.boolean) value->number = (object.*m) ? 1 : 0;
  if (const auto m = field.member.text) value->text = (object.*m).c_str();
  if (const auto m = field.member.array) {
    value->numbers = (object.*m).data();
    value->count = static_cast<uint32_t>((object.*m).size());
  }
  if (const auto m = field.member.vector3) {
    value->numbers = (object.*m).data();
    value->count = 3;
  }
  return HSP_OK;
}

template <class T, size_t N>
constexpr std::array<hsp_param, N> tableOf(const std::array<Field<T>, N>& fields) {
  std::array<hsp_param, N> table{};
  for (size_t i = 0; i < N; ++i) table[i] = fields[i].param;
  return table;
}

}  // namespace detail
}  // namespace hapticd
