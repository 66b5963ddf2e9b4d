/// Words for a model that the guard has silenced.
#pragma once
#include <string>

namespace hapticd::servo {

struct ModelState;

/// [main] Why the model was silenced and what to do; "" if it was not.
std::string whySilenced(const ModelState& model);

}  // namespace hapticd::servo
