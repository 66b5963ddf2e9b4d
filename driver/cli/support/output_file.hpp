// SPDX-License-Identifier: MIT
/// Decides which existing files a command may overwrite. It may overwrite only files of the kind that it writes itself,
/// and none of its inputs. Otherwise a wrong name could destroy a scene or a mesh.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hapticd::cli {

/// A kind of file, recognised by its first bytes.
struct OutputKind {
  const char* name;                          ///< name with article, such as "a picture (SVG)"
  std::vector<std::string_view> beginnings;  ///< the file must begin with one of these
  /// text that the file must contain within its first 8 KiB; empty for no such condition
  std::string_view within = {};
  bool file_only = false;  ///< true if it never goes to standard output, so that - is no name for it
};

const OutputKind& pictureKind();                                       ///< SVG
const OutputKind& recordingKind();                                     ///< HDF5 of `run --record`
const OutputKind& reportKind();                                        ///< JSON of `run --report`
const OutputKind& mcapKind();                                          ///< MCAP
constexpr const char* kObjBeginning = "# hapticd ctl geometry, in m";  ///< first line of such an OBJ file
const OutputKind& objKind();                                           ///< triangles of `ctl geometry --obj`
const OutputKind& partKind();                                          ///< part of `import`
const OutputKind& modelKind();                                         ///< model file of `import`, YAML or JSON
/// Returns the kind of CSV files whose header begins with these columns. @param header must live as long as the kind
OutputKind tableKind(std::string_view header);

/// The files that a command reads, each with a name for it, such as "the recording".
using Inputs = std::vector<std::pair<std::string, const char*>>;

/// [main] Returns why a file must not be written: it is one of the inputs, or it exists and is of another kind. Returns
/// "" if it may be written. New files, empty files and names that are not regular files (devices, pipes, and - where it
/// means standard output) may always be written.
std::string whyNotWritten(const std::string& out, const OutputKind& kind, const Inputs& inputs = {});

/// [main] Returns why a file cannot be written; "" if it can, or if it is "". Leaves no new file behind, in case the
/// command does not go on.
std::string whyNotWritable(const std::string& file);

}  // namespace hapticd::cli
