// SPDX-License-Identifier: MIT
/// A vendor's library that is loaded at run time.
#pragma once
#include <string>

namespace hapticd::vendor_arm {

class LoadedLibrary {
 public:
  LoadedLibrary() = default;
  LoadedLibrary(const LoadedLibrary&) = delete;
  LoadedLibrary& operator=(const LoadedLibrary&) = delete;
  ~LoadedLibrary();
  /// [main] Throws std::runtime_error, whose text says how to fix it, if the library cannot be loaded.
  void load(const std::string& file);
  bool isLoaded() const { return library_ != nullptr; }
  /// [main] Finds a function of the library. Throws std::runtime_error if the library does not have it.
  /// @param expected which library is needed, for the message
  template <class Function>
  void find(Function*& function, const char* name, const char* expected) const {
    function = reinterpret_cast<Function*>(address(name, expected));
  }

 private:
  void* address(const char* name, const char* expected) const;
  void* library_ = nullptr;
};

}  // namespace hapticd::vendor_arm
