// SPDX-License-Identifier: MIT
#include "host/describe.hpp"

#include <algorithm>
#include <cstring>
#include <set>
#include <stdexcept>
#include <utility>

#include "host/child.hpp"
#include "host/class_params.hpp"
#include "host/class_table.hpp"
#include "host/library.hpp"
#include "host/wire.hpp"

namespace hapticd::host {
namespace {

/// [ms] longest time to load a plugin or module for its description. The daemon loads it later in its own process, and
/// slow constructors would delay it there.
constexpr int kLimitMs = 5000;
constexpr uint32_t kMaxParams = 4096;  ///< a table that claims more is damaged
constexpr uint32_t kMaxChoices = 4096;

/// Returns a text for people without control characters, because it is written to terminals.
std::string plainText(const char* text) {
  std::string plain = textOf(text);
  std::replace_if(plain.begin(), plain.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  return plain;
}

/// Copies a parameter of any minor version of the ABI. Members that the file does not have stay zero.
ParamInfo copyParam(const hsp_param& given) {
  hsp_param p{};
  std::memcpy(&p, &given, std::min<size_t>(given.struct_size, sizeof p));
  ParamInfo info{textOf(p.id), plainText(p.unit), plainText(p.doc), p.kind,      p.flags,     p.min, p.max, p.def,
                 {},           p.columns,         p.min_count,      p.max_count, std::nullopt};
  if (p.def_text != nullptr) info.def_text = p.def_text;
  if (p.choices == nullptr || p.choice_count > kMaxChoices) return info;
  for (uint32_t i = 0; i < p.choice_count; ++i) info.choices.emplace_back(textOf(p.choices[i]));
  return info;
}

/// Returns "", or the reason why this entry of a table cannot be used to check files.
std::string wrongIn(const ParamInfo& p) {
  if (p.id.empty()) return "a parameter has no id";
  if (p.kind < HSP_REAL || p.kind > HSP_DATA)
    return p.id + ": its kind " + std::to_string(p.kind) + " is unknown, expected HSP_REAL to HSP_DATA";
  const bool numeric = p.kind == HSP_REAL || p.kind == HSP_INT || p.kind == HSP_ARRAY;
  if (numeric && !(p.min <= p.max)) return p.id + ": its smallest value (min) is above its largest (max)";
  const bool given = (p.flags & HSP_P_REQUIRED) == 0 && (p.kind == HSP_REAL || p.kind == HSP_INT);
  if (given && !(p.def >= p.min && p.def <= p.max))
    return p.id + ": its default is outside of its range; expected a number between its smallest and its largest value";
  if (p.kind == HSP_ENUM && p.choices.empty()) return p.id + ": it has no choices";
  return "";
}

/// True if the text has no control characters. Names are written to terminals, and to files of one name per line.
bool isPlain(const std::string& text) {
  return std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; });
}

/// Throws if recordings and messages could not name the class.
template <class Class>
void checkNames(const Class& given, const ClassInfo& info) {
  if (info.name.empty()) throw std::runtime_error("one of its classes has no name");
  if (!isPlain(info.name) || !isPlain(info.id))
    throw std::runtime_error(
        "one of its classes has an id or a name that is not plain text; expected no control characters");
  for (const auto& [text, what] : {std::pair{given.id, "id"}, {given.version, "version"}})
    if (text == nullptr)
      throw std::runtime_error("class '" + info.name + "' has no " + what + "; expected a text, not NULL");
}

template <class Class>
ClassInfo copyClass(const Class& given, Kind kind, const std::filesystem::path& file, uint32_t minor) {
  ClassInfo info{kind,
                 textOf(given.id),
                 textOf(given.name),
                 plainText(given.version),
                 plainText(given.license),
                 plainText(given.doc),
                 given.flags,
                 minor,
                 {},
                 file};
  checkNames(given, info);
  if (!complete(given))
    throw std::runtime_error("class '" + info.name +
                             "' lacks a required function; expected all functions of version 1.0 of the interface");
  if (given.param_count > kMaxParams)
    throw std::runtime_error("class '" + info.name + "' claims " + std::to_string(given.param_count) +
                             " parameters; expected at most 4096");
  std::set<std::string> ids;
  for (uint32_t i = 0; i < given.param_count; ++i) {
    const ParamInfo param = copyParam(paramAt(given, i));
    if (const std::string wrong = wrongIn(param); !wrong.empty())
      throw std::runtime_error("class '" + info.name + "': its parameter table is wrong: " + wrong);
    if (!ids.insert(param.id).second)
      throw std::runtime_error("class '" + info.name + "': its parameter table has '" + param.id + "' twice");
    info.params.push_back(param);
  }
  return info;
}

template <class Class, class Entry>
void copyEntry(const Entry& entry, Kind kind, const std::filesystem::path& file, std::vector<ClassInfo>& out) {
  for (uint32_t i = 0; i < entry.class_count; ++i) {
    const Class* given = entry.classes[i];
    if (given == nullptr || !HSP_HAS(given, params)) throw std::runtime_error("its table of classes is damaged");
    out.push_back(copyClass(*given, kind, file, entry.abi_minor));
  }
}

void pack(Packer& out, const ClassInfo& info) {
  out.number(info.kind == Kind::kDevice ? 1u : 0u);
  for (const std::string* text : {&info.id, &info.name, &info.version, &info.license, &info.doc}) out.text(*text);
  for (const uint32_t number : {info.flags, info.abi_minor, static_cast<uint32_t>(info.params.size())})
    out.number(number);
  for (const ParamInfo& p : info.params) {
    for (const std::string* text : {&p.id, &p.unit, &p.doc}) out.text(*text);
    for (const uint32_t number : {p.kind, p.flags, p.columns, p.min_count, p.max_count}) out.number(number);
    for (const double number : {p.min, p.max, p.def}) out.number(number);
    out.number(static_cast<uint32_t>(p.choices.size()));
    for (const std::string& choice : p.choices) out.text(choice);
    out.number(p.def_text ? 1u : 0u);
    out.text(p.def_text.value_or(""));
  }
}

ParamInfo unpackParam(Unpacker& in) {
  ParamInfo p;
  for (std::string* text : {&p.id, &p.unit, &p.doc}) *text = in.text();
  for (uint32_t* number : {&p.kind, &p.flags, &p.columns, &p.min_count, &p.max_count}) *number = in.count();
  for (double* number : {&p.min, &p.max, &p.def}) *number = in.real();
  p.choices.resize(std::min(in.count(), kMaxParams));
  for (std::string& choice : p.choices) choice = in.text();
  const bool has_text = in.count() != 0;
  const std::string text = in.text();
  if (has_text) p.def_text = text;
  return p;
}

ClassInfo unpackClass(Unpacker& in, const std::filesystem::path& file) {
  ClassInfo info;
  info.kind = in.count() != 0 ? Kind::kDevice : Kind::kShape;
  for (std::string* text : {&info.id, &info.name, &info.version, &info.license, &info.doc}) *text = in.text();
  info.flags = in.count();
  info.abi_minor = in.count();
  info.params.resize(std::min(in.count(), kMaxParams));
  for (ParamInfo& param : info.params) param = unpackParam(in);
  info.file = file;
  return info;
}

std::string packed(const std::filesystem::path& file) {
  Packer out;
  const auto classes = describe(file);
  out.text(classes ? "" : classes.error());
  out.number(classes ? static_cast<uint32_t>(classes->size()) : 0u);
  if (classes)
    for (const ClassInfo& info : *classes) pack(out, info);
  return out.take();
}

Result<std::vector<ClassInfo>> unpacked(const Result<std::string>& told, const std::filesystem::path& file) {
  if (!told) return Error{file.string() + ": while it was loaded it " + told.error()};
  Unpacker in(*told);
  if (const std::string error = in.text(); !error.empty()) return Error{error};
  std::vector<ClassInfo> classes(std::min(in.count(), kMaxParams));
  for (ClassInfo& info : classes) info = unpackClass(in, file);
  if (!in.good())
    return Error{file.string() + ": its description is incomplete; its constructors may have ended the process"};
  return classes;
}

}  // namespace

int ClassInfo::indexOf(const std::string& param) const {
  for (size_t i = 0; i < params.size(); ++i)
    if (params[i].id == param) return static_cast<int>(i);
  return -1;
}

std::string ClassInfo::unitOf(const std::string& param) const {
  const int index = indexOf(param);
  return index < 0 ? "" : params[static_cast<size_t>(index)].unit;
}

std::vector<std::string> ClassInfo::paramIds() const {
  std::vector<std::string> ids;
  for (const ParamInfo& param : params) ids.push_back(param.id);
  return ids;
}

Result<std::vector<ClassInfo>> describe(const std::filesystem::path& file) {
  auto library = Library::open(file);
  if (!library) return Error{library.error()};
  const auto shapes = (*library)->shapes();
  const auto devices = (*library)->devices();
  if (!shapes && !devices) {
    const std::string folder = file.parent_path().filename();
    if (folder == "devices") return Error{devices.error()};
    if (folder == "plugins") return Error{shapes.error()};
    if (!(*library)->exports("hsp_plugin_entry") && !(*library)->exports("hdv_module_entry"))
      return Error{
          file.string() +
          " is neither a plugin of shapes nor a device module: it exports no hsp_plugin_entry and no "
          "hdv_module_entry\n  fix: write HAPTICD_SHAPES(...) or HAPTICD_DEVICES(...) at the end of its source file"};
    return Error{(*library)->exports("hdv_module_entry") ? devices.error() : shapes.error()};
  }
  std::vector<ClassInfo> classes;
  try {
    if (shapes) copyEntry<hsp_class>(**shapes, Kind::kShape, file, classes);
    if (devices) copyEntry<hdv_class>(**devices, Kind::kDevice, file, classes);
  } catch (const std::exception& e) {
    return Error{file.string() + ": " + e.what()};
  }
  return classes;
}

Result<std::vector<ClassInfo>> describeInChild(const std::filesystem::path& file) {
  return unpacked(runInChild([&] { return packed(file); }, kLimitMs), file);
}

Result<std::vector<ClassInfo>> describeByProgram(const std::filesystem::path& program,
                                                 const std::filesystem::path& file) {
  return unpacked(runProgram({program.string(), kDescribeForParent, file.string()}, kLimitMs), file);
}

void describeForParent(const std::filesystem::path& file) {
  answerParent([&] { return packed(file); });
}

}  // namespace hapticd::host
