// SPDX-License-Identifier: MIT
#include "vendor_arm/loaded_library.hpp"

#include <dlfcn.h>

#include <stdexcept>

namespace hapticd::vendor_arm {

LoadedLibrary::~LoadedLibrary() {
  if (library_ != nullptr) dlclose(library_);
}

void LoadedLibrary::load(const std::string& file) {
  if (isLoaded()) return;
  library_ = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!isLoaded())
    throw std::runtime_error("the vendor's library cannot be loaded: " + std::string(dlerror()) +
                             "\n  fix: install the vendor's driver, or name its file in parameters.library");
}

void* LoadedLibrary::address(const char* name, const char* expected) const {
  void* found = dlsym(library_, name);
  if (found == nullptr)
    throw std::runtime_error(std::string("the vendor's library has no function ") + name + ", expected " + expected);
  return found;
}

}  // namespace hapticd::vendor_arm
