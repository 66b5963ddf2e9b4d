// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "document/json_text.hpp"
#include "hapticd/abi.h"
#include "scene/format.hpp"
#include "scene/load.hpp"

namespace hapticd::scene {

using namespace document;
namespace {

using Json = nlohmann::ordered_json;

/// Converts a default value of the tables from YAML to JSON.
Json defaultOf(const std::string& yaml) {
  Problems none;
  const auto node = parseText(yaml, "default", none);
  return node ? document::parseJson(toJson(*node)) : Json();
}

void addBounds(Json& json, double min, double max) {
  if (min > -1e300) json["minimum"] = min;
  if (max < 1e300) json["maximum"] = max;
}

Json numbers(size_t count, double min, double max) {
  Json item{{"type", "number"}};
  addBounds(item, min, max);
  return {{"type", "array"}, {"items", item}, {"minItems", count}, {"maxItems", count}};
}

Json schemaOf(const Table& table);

Json schemaOf(const Key& key) {
  Json json;
  switch (key.type) {
    case Type::kReal:
      json["type"] = "number";
      break;
    case Type::kInteger:
      json["type"] = "integer";
      break;
    case Type::kBool:
      json["type"] = "boolean";
      break;
    case Type::kChoice:
      json["enum"] = std::vector<std::string>(key.choices.begin(), key.choices.end());
      break;
    case Type::kName:
    case Type::kText:
    case Type::kFile:
      json["type"] = "string";
      break;
    case Type::kVector3:
      json = numbers(3, key.range.min, key.range.max);
      break;
    case Type::kQuaternion:
      json = numbers(4, -1, 1);
      break;
    case Type::kObject:
      json = schemaOf(*key.table);
      break;
    case Type::kList:
      json = {{"type", "array"}, {"items", schemaOf(*key.table)}, {"maxItems", key.range.max}};
      break;
    case Type::kAny:
      break;
  }
  if (key.type == Type::kReal || key.type == Type::kInteger) addBounds(json, key.range.min, key.range.max);
  json["description"] = key.range.unit[0] != '\0' ? std::string(key.doc) + " [" + key.range.unit + "]" : key.doc;
  if (key.def != nullptr) json["default"] = defaultOf(key.def);
  return json;
}

Json schemaOf(const Table& table) {
  Json json{{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
  for (const Key& key : table.keys) {
    json["properties"][key.name] = schemaOf(key);
    if (key.required) json["required"].push_back(key.name);
  }
  return json;
}

/// Returns the JSON Schema type of a parameter, without its bounds, default and description.
Json typeOf(const host::ParamInfo& param) {
  Json json = Json::object();
  switch (param.kind) {
    case HSP_REAL:
      json["type"] = "number";
      break;
    case HSP_INT:
      json["type"] = "integer";
      break;
    case HSP_BOOL:
      json["type"] = "boolean";
      break;
    case HSP_ENUM:
      json["enum"] = param.choices;
      break;
    case HSP_PATH:
    case HSP_TEXT:
      json["type"] = "string";
      break;
    case HSP_ARRAY:
      json["type"] = param.min_count <= 1 ? Json{"array", "number"} : Json("array");
      break;
    case HSP_DATA:
      if (!param.choices.empty()) json = document::parseJson(param.choices[0]);
      if (!json.is_object()) json = Json::object();
      break;
    default:
      break;
  }
  return json;
}

Json schemaOf(const host::ParamInfo& param) {
  Json json = typeOf(param);
  if (param.kind == HSP_REAL || param.kind == HSP_INT) {
    addBounds(json, param.min, param.max);
    json["default"] = param.def;
  }
  if (param.kind == HSP_BOOL) json["default"] = param.def != 0;
  if (param.kind == HSP_ENUM && param.def >= 0 && param.def < static_cast<double>(param.choices.size()))
    json["default"] = param.choices[static_cast<size_t>(param.def)];
  if (param.def_text && param.kind == HSP_ARRAY) json["default"] = defaultOf(*param.def_text);
  json["description"] = param.unit.empty() ? param.doc : param.doc + " [" + param.unit + "]";
  return json;
}

/// Puts a parameter at the place for its id, whose parts are separated by dots.
void place(Json& object, const std::string& id, const host::ParamInfo& param) {
  Json& properties = object["properties"];
  const size_t dot = id.find('.');
  if (dot == std::string::npos) {
    properties[id] = schemaOf(param);
    if ((param.flags & HSP_P_REQUIRED) != 0) object["required"].push_back(id);
    return;
  }
  Json& group = properties[id.substr(0, dot)];
  if (group.is_null()) group = {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
  place(group, id.substr(dot + 1), param);
}

Json parametersOf(const host::ClassInfo& info) {
  Json json{
      {"type", "object"}, {"additionalProperties", false}, {"description", info.doc}, {"properties", Json::object()}};
  for (const host::ParamInfo& param : info.params) place(json, param.id, param);
  if (info.indexOf("motion") >= 0) json["properties"]["path"] = {{"type", "string"}};
  return json;
}

/// Writes "if plugin is X, then parameters are those of X" for every class in the catalog.
Json choicesOf(host::Catalog& catalog, host::Kind kind, const char* selector) {
  Json rules = Json::array();
  for (const host::CatalogFile* file : catalog.files(kind))
    for (const host::ClassInfo& info : file->classes)
      if (info.kind == kind)
        rules.push_back({{"if", {{"properties", {{selector, {{"const", info.name}}}}}}},
                         {"then", {{"properties", {{"parameters", parametersOf(info)}}}}}});
  return rules;
}

void addPaths(Json& scene) {
  const Json file{{"type", "string"}};
  Json& properties = scene["properties"];
  Json reference = schemaOf(kDeviceReferenceTable);
  const Json one{{"anyOf", {file, reference}}};
  properties["device"].update(one);
  properties["devices"].update({{"type", "array"}, {"items", one}, {"minItems", 1}, {"maxItems", kMaxDevices}});
  Json modes = Json::array();
  for (const std::string_view mode : kClientModes) modes.push_back(std::string(mode));
  properties["clients"].update(Json{{"anyOf", {Json{{"enum", modes}}, schemaOf(kClientsTable)}}});
  Json& model = properties["models"]["items"]["properties"];
  model["motion"]["enum"] = {"static", "kinematic", "dynamic"};
  model["path"]["type"] = "string";
}

/// Adds the contents of the lists in `hd` to the schema of a device.
void addHd(Json& device) {
  Json& hd = device["properties"]["hd"]["properties"];
  const Json joint{{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 1}, {"maxItems", 3}};
  hd["joints"].update(Json{{"type", "array"}, {"items", joint}, {"maxItems", 6}});
  hd["buttons"].update(Json{{"type", "array"}, {"items", {{"type", "integer"}, {"minimum", 0}, {"maximum", 31}}}});
}

}  // namespace

std::string jsonSchema(const std::string& format, host::Catalog* catalog) {
  for (const Format& known : kFormats) {
    if (format != known.name) continue;
    Json json{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", known.doc}};
    json.update(schemaOf(*known.table));
    if (known.table == &kSceneTable) addPaths(json);
    if (known.table == &kDeviceTable) addHd(json);
    if (catalog != nullptr && known.table == &kSceneTable)
      json["properties"]["models"]["items"]["allOf"] = choicesOf(*catalog, host::Kind::kShape, "plugin");
    if (catalog != nullptr && known.table == &kDeviceTable)
      json["allOf"] = choicesOf(*catalog, host::Kind::kDevice, "module");
    return json.dump(2) + "\n";
  }
  return "";
}

}  // namespace hapticd::scene
