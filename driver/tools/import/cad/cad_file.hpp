// SPDX-License-Identifier: MIT
/// A CAD file as Open CASCADE reads it: a tree of assemblies and shapes with names, colours and poses. Lengths are in
/// millimetres here, because the readers of Open CASCADE give millimetres whatever the unit of the file is.
#pragma once
#include <TopoDS_Shape.hxx>
#include <cstdint>
#include <gp_Trsf.hxx>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

#include "kernels/part/part.hpp"

namespace hapticd::cad {

/// The reason why a file cannot be imported, as a text for the user.
struct CadError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An assembly, or a shape at its place.
struct Node {
  std::string name;
  std::string body_name;     ///< name of the shape itself; instances have their own names
  std::uint32_t colour = 0;  ///< as in brep::Face
  int parent = -1;           ///< index of the assembly that holds it
  TopoDS_Shape shape;        ///< null for an assembly; a shape has no location of its own
  gp_Trsf pose;              ///< from the frame of the shape to the frame of the file [mm]
};

struct CadFile {
  std::vector<Node> nodes;    ///< parents come before their children
  std::string unit;           ///< unit of length in the file, such as "mm" or "in"
  bool unit_assumed = false;  ///< true if the file does not state its unit
  /// Colours of faces and other shapes; the key is the address of the TShape.
  std::unordered_map<const void*, std::uint32_t> colours;
  std::vector<brep::Loss> losses;    ///< faces of the file that the reader could not make
  std::vector<std::string> remarks;  ///< warnings about the file, such as a unit that had to be assumed
};

/// [main] Reads .step, .stp, .iges, .igs, .brep, .brp and .rle. @throws CadError
CadFile readCad(const std::string& file);

}  // namespace hapticd::cad
