// SPDX-License-Identifier: MIT
#include "session/replay/model_description.hpp"

#include <nlohmann/json.hpp>

#include "document/json_text.hpp"
#include "record/scene_json.hpp"
#include "session/replay/former_defaults.hpp"

namespace hapticd::servo {

namespace {

using Json = nlohmann::ordered_json;

Json filesJson(const scene::Model& model, const scene::Model& readable) {
  const std::vector<std::string> names = filesOf(model), paths = filesOf(readable);
  Json list = Json::array();
  for (size_t i = 0; i < names.size(); ++i) list.push_back({{"path", names[i]}, {"hash", fingerprint(paths[i])}});
  return list;
}

/// Returns a path as rows [t, x, y, z], with w, x, y, z of the orientation behind them where it is turned: a third of
/// the text.
Json pathRows(const Json& path) {
  Json rows = Json::array();
  for (const Json& point : path) {
    Json row = Json::array({point.at("t")});
    const Json &position = point.at("pose").at("position"), &turn = point.at("pose").at("orientation");
    row.insert(row.end(), position.begin(), position.end());
    if (turn.dump() != "[1.0,0.0,0.0,0.0]") row.insert(row.end(), turn.begin(), turn.end());
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

std::string describeModel(const scene::Model& model, const scene::Model& readable, const hsp_class& plugin,
                          size_t most) {
  Json json = document::parseJsonOrThrow(record::modelToJson(model));
  json["path"] = pathRows(json["path"]);
  json["id"] = plugin.id;
  json["version"] = plugin.version;
  json["files"] = filesJson(model, readable);
  const auto text = [&] { return json.dump(-1, ' ', true, Json::error_handler_t::replace); };
  if (text().size() <= most) return text();
  json.erase("files");
  json["path"] = Json::array();
  if (text().size() > most) json["parameters"] = Json::array();
  return text();
}

Result<ModelDescription> readModelDescription(const std::string& json_text) {
  auto model = record::modelFromJson(json_text);
  if (!model) return Error{model.error()};
  ModelDescription description{std::move(*model), {}, false};
  try {
    const Json json = document::parseJsonOrThrow(json_text);
    description.whole = json.contains("files");
    if (!description.whole) return description;
    for (const Json& file : json.at("files")) description.files.push_back({file.at("path"), file.at("hash")});
    useFormerDefaults(description.model, json.at("id"), json.at("version"));
    return description;
  } catch (const std::exception& error) {
    return Error{std::string("the description of a model cannot be read: ") + error.what()};
  }
}

}  // namespace hapticd::servo
