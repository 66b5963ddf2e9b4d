#include "servo/silenced.hpp"

#include "servo/core.hpp"

namespace hapticd::servo {

std::string whySilenced(const ModelState& model) {
  if (model.shape == nullptr) return "";
  const std::string who = "model " + model.shape->name() + ": its plugin ";
  switch (model.guard.trouble()) {
    case Trouble::kNone:
    case Trouble::kLost:
      return "";
    case Trouble::kNotFinite:
      return who + "answered a force, pose or foot that is not a number; it was silenced";
    case Trouble::kBadStatus:
      return who + "answered status " + std::to_string(model.failed_status) +
             ", which a step may not answer; it was silenced";
    case Trouble::kOverrun:
      return who +
             "took longer than all shapes may take in a tick, again and again; it was silenced; measure it with: "
             "hapticd plugin check FILE.so";
    case Trouble::kJump:
      return who +
             "answered forces that jumped beyond the stiffness it claims; it was silenced; look at it with: "
             "hapticd plugin check FILE.so";
  }
  return "";
}

}  // namespace hapticd::servo
