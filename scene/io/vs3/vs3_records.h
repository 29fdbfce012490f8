#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/io/polygon.h"
#include "scene/io/text_file.h"

namespace lightwell {

/// An S, M, N or O record of View3D's geometry.
struct Vs3Record {
  enum class Kind : char { radiating = 'S', mask = 'M', null = 'N', obstruction = 'O' };
  Kind kind = Kind::radiating;
  int line = 0;
  Loop loop{};      ///< three or four corners, counter-clockwise seen from the front
  int base = 0;     ///< number, from 1, of the base surface in whose plane it lies; 0: none
  int combine = 0;  ///< number, from 1, of the surface it is combined with; 0: none
  double emittance = 1.0;
  std::string name{};
};

/// The records of a .vs3 file in file order, numbers checked.
struct Vs3Content {
  std::string title{};
  std::vector<Vs3Record> surfaces{};  ///< number n is at n - 1
  bool encl = false, emit = false;    ///< control words
  bool has_transformation = false;    ///< an X record, which View3D ignores
};

/// Reads formats 3 (vertices and surfaces) and 3a (a plane and a shape in it). Throws InputError
/// naming file, line, value and remedy.
Vs3Content read_vs3_records(const TextFile& file);

}  // namespace lightwell
