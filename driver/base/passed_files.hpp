// SPDX-License-Identifier: MIT
/// Files that a program of other rights hands over open, under the names that it knows them by. While they are in
/// force, a thread reads these and no others: a name alone opens nothing with the rights of this process.
#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/descriptors.hpp"
#include "base/result.hpp"

namespace hapticd {

class PassedFiles {
 public:
  static constexpr size_t kMostBytes = 256u << 20;  ///< of all files together

  /// [main] Copies what each descriptor lets this process read into memory that does not change any more. A descriptor
  /// that gives no right to read (O_PATH, O_WRONLY) is refused, as is what may let a reader wait for ever.
  /// @param names one for each descriptor
  static Result<PassedFiles> copy(const std::vector<std::string>& names, std::vector<Descriptor> descriptors);

  /// A file that this process chose by itself, such as that of its arm: it may be opened by name.
  void allow(const std::string& file) { own_.insert(file); }
  /// Where the file can be opened; "": nowhere.
  std::string pathOf(const std::string& file) const;
  /// The text with the names that others know in place of those from pathOf.
  std::string named(std::string text) const;

  /// [main] The files are in force on this thread as long as this lives; they must live longer.
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

/// [main] Where a file of that name is to be opened: itself, unless passed files are in force. The error is meant to
/// follow the file's name.
Result<std::string> whereToOpen(const std::string& file);

/// [main] Opens a regular file for another process. One that a program or the kernel keeps (FUSE, proc) becomes a
/// copy in memory: reading it asks nobody. The error is meant to follow the file's name.
Result<Descriptor> openToPass(const std::string& file);

}  // namespace hapticd
