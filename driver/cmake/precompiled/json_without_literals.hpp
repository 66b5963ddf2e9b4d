// SPDX-License-Identifier: MIT
/// nlohmann/json for the headers that g++ precompiles. The library's literal "..."_json calls the parser, and g++
/// instantiates what an inline function of a precompiled header calls in each unit, whether the unit uses it or not:
/// 0.8 s of each. Nobody here uses the literal. So it stays a declaration, and its body goes into a template.
#pragma once
#define _json(text, size) \
  _json(text, size);      \
  template <class = void> \
  nlohmann::json jsonOfLiteral(text, size)
#include <nlohmann/json.hpp>
#undef _json
