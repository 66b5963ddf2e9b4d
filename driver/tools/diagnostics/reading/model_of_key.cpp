// SPDX-License-Identifier: MIT
#include "diagnostics/reading/model_of_key.hpp"

#include <cstdlib>
#include <string_view>

namespace hapticd::diagnostics {

std::optional<size_t> modelOf(const std::string& key) {
  constexpr std::string_view kModels = "models[";
  if (!key.starts_with(kModels)) return std::nullopt;
  return std::strtoul(key.c_str() + kModels.size(), nullptr, 10);
}

std::vector<document::Problems> problemsOfModels(const document::Problems& problems, size_t count) {
  std::vector<document::Problems> of_models(count);
  for (const document::Problem& one : problems)
    if (const auto model = modelOf(one.key); model && *model < count) of_models[*model].push_back(one);
  return of_models;
}

}  // namespace hapticd::diagnostics
