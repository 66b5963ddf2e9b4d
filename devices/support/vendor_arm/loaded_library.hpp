// SPDX-License-Identifier: MIT
/// A vendor's library, found at run time.
#pragma once
#include <string>

namespace hapticd::vendor_arm {

class LoadedLibrary {
 public:
  LoadedLibrary() = default;
  LoadedLibrary(const LoadedLibrary&) = delete;
  LoadedLibrary& operator=(const LoadedLibrary&) = delete;
  ~LoadedLibrary();
  /// [main] Throws std::runtime_error that names the cure where the library cannot be loaded.
  void load(const std::string& file);
  bool isLoaded() const { return library_ != nullptr; }
  /// [main] Throws std::runtime_error where the library lacks it. @param expected what the library should be
  template <class Function>
  void find(Function*& function, const char* name, const char* expected) const {
    function = reinterpret_cast<Function*>(address(name, expected));
  }

 private:
  void* address(const char* name, const char* expected) const;
  void* library_ = nullptr;
};

}  // namespace hapticd::vendor_arm
