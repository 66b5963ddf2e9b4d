// SPDX-License-Identifier: MIT
/// What instances and features of a part are called.
#pragma once
#include <string>

#include "kernels/brep/part.hpp"

namespace hapticd::brep {

/// [main] UTF-8 text whose control characters became spaces: names of foreign files are shown in terminals, which would
/// obey them.
std::string plainText(std::string text);

/// [main] The name of an instance, else that of its body, else its number as "#3".
std::string instanceName(const Part& part, std::uint32_t instance);

/// [main] The names from the outermost assembly down to an instance, with slashes; its number if it has no name.
std::string instancePath(const Part& part, std::uint32_t instance);

/// [main] Instance and face of a feature in words, as "bolt: face 3 'head'"; features count over all instances of the
/// file. "" if there is no such feature.
std::string featureName(const Part& part, std::uint32_t feature);

/// [main] A face (index in the part) in the words of featureName(), at the first place of its body.
std::string faceName(const Part& part, std::uint32_t face);

}  // namespace hapticd::brep
