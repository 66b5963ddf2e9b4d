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

  /// A file that this process chose itself, such as that of its arm, so it may be opened by name.
  void allow(const std::string& file) { own_.insert(file); }
  /// The path at which the file can be opened; "" if there is none.
  std::string pathOf(const std::string& file) const;
  /// The text with each path from pathOf replaced by the name that others know.
  std::string named(std::string text) const;

  /// [main] This thread uses the files while this object lives; they must outlive it.
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

/// [main] The path at which a file of that name must be opened: the name itself, unless this thread uses passed files.
/// The error is meant to follow the file's name.
Result<std::string> whereToOpen(const std::string& file);

/// [main] Opens a regular file for another process. One that a program or the kernel keeps (FUSE, proc) becomes a copy
/// in memory, which can be read without asking anybody. The error is meant to follow the file's name.
Result<Descriptor> openToPass(const std::string& file);

}  // namespace hapticd
