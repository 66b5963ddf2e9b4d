// SPDX-License-Identifier: MIT
/// What a command may write over: a file of the kind that it writes itself, never one of another program or one that it
/// reads. A name that was typed by habit or completed by the shell has cost people scenes and meshes.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hapticd::cli {

/// A kind of file, known by how it begins.
struct OutputKind {
  const char* name;                          ///< "a picture (SVG)"
  std::vector<std::string_view> beginnings;  ///< any of them
  std::string_view within = {};              ///< and this somewhere in the first kilobytes
};

const OutputKind& pictureKind();                                       ///< SVG
const OutputKind& recordingKind();                                     ///< HDF5 of `run --record`
const OutputKind& reportKind();                                        ///< JSON of `run --report`
const OutputKind& mcapKind();                                          ///< MCAP
constexpr const char* kObjBeginning = "# hapticd ctl geometry, in m";  ///< the first line of such triangles
const OutputKind& objKind();                                           ///< triangles of `ctl geometry --obj`
/// CSV with a header that begins with these columns. @param header lives as long as the kind
OutputKind tableKind(std::string_view header);

/// What a command reads, each with what it is: "the recording".
using Inputs = std::vector<std::pair<std::string, const char*>>;

/// [main] Why a file must not be written: it is one of those that are read, or it is there and of another kind. "": it
/// may be. Names that are no regular file (-, devices, pipes), new ones and empty files may.
std::string whyNotWritten(const std::string& out, const OutputKind& kind, const Inputs& inputs = {});

}  // namespace hapticd::cli
