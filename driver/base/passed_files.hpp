// SPDX-License-Identifier: MIT
/// Files that a client passes to the daemon as open descriptors, together with their names, because the client and the
/// daemon may have different rights. While a Scope object lives, its thread reads these files and no others, so that a
/// client cannot use a name to open a file with the rights of the daemon.
#pragma once
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/descriptors.hpp"
#include "base/result.hpp"

namespace hapticd {

/// What whereToOpen() says of a file that is neither passed nor allowed.
inline constexpr const char* kNotPassed =
    "was not passed along, expected a file that exists and that the asking user may read";

class PassedFiles {
 public:
  static constexpr size_t kMostBytes = 256u << 20;  ///< largest size of all files together

  /// [main] Copies the contents of each descriptor to memory that nobody can change. It refuses a descriptor without
  /// the right to read (O_PATH, O_WRONLY), and a file that can make its reader wait for ever (FUSE, proc).
  /// @param names one name for each descriptor
  static Result<PassedFiles> copy(const std::vector<std::string>& names, std::vector<Descriptor> descriptors);

  /// Allows a file to be opened by name, because this process chose it itself, such as the device file of its arm.
  void allow(const std::string& file) { own_.insert(file); }
  /// Returns the path at which the file can be opened; "" if it was neither passed nor allowed.
  std::string pathOf(const std::string& file) const;
  /// Returns the text with each path of pathOf() replaced by the name that the client gave.
  std::string named(std::string text) const { return naming()(std::move(text)); }
  /// Returns a function that does the same, also after the files are closed.
  std::function<std::string(std::string)> naming() const;

  /// [main] Makes this thread use the files as long as this object lives. The files must outlive the Scope object.
  class Scope {
   public:
    explicit Scope(const PassedFiles& files) noexcept;
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    const PassedFiles* before_;
  };

 private:
  std::map<std::string, Descriptor> copies_;
  std::set<std::string> own_;
};

/// [main] Returns the path at which a file of that name must be opened: the name itself, unless this thread uses passed
/// files. The error is meant to follow the file's name in a message.
Result<std::string> whereToOpen(const std::string& file);

/// [main] Opens a regular file for another process. If a program or the kernel provides the file (FUSE, proc), it is
/// copied to memory, so that the reader depends on nobody. The error is meant to follow the file's name in a message.
Result<Descriptor> openToPass(const std::string& file);

}  // namespace hapticd
