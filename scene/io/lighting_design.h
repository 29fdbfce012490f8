#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

struct LuminaireFile;
using SharedLuminaireFile = std::shared_ptr<const LuminaireFile>;

/// Heading of a report (the [report] table): text for people, each empty unless given.
struct ReportHeading {
  std::string project{}, client{}, author{}, date{}, remarks{};
};

/// A plane over a surface of a scene on which illuminance is calculated (a [[grids]] table).
struct CalculationGrid {
  std::string name{};
  int surface = 0;                 ///< index into Scene::surfaces
  double height = 0.0;             ///< m above the surface, >= 0
  std::optional<double> margin{};  ///< m, width of the outline strip without points; empty: usual
  double spacing = 0.0;            ///< m between points, at most; 0: the usual spacing
};

/// The part of a scene file that describes the lighting design. A LightingDesign changes no
/// solution.
struct LightingDesign {
  std::vector<CalculationGrid> grids{};
  // Indexed like Scene::lamps; empty without lamps, or where the format holds no such data.
  std::vector<double> watts{};  ///< electric power; 0: unknown
  /// Height in m of the luminous sides in the lamp's photometric file.
  std::vector<double> luminous_height{};
  std::vector<SharedLuminaireFile> files{};  ///< photometric file; null: none
  ReportHeading heading{};
};

/// Reads the design from the file of `scene`: the [[grids]] tables, the [report] table and the
/// photometric files and electric power of the [[lamps]] tables. The power of a lamp is its key
/// `watts`, else the power in its photometric file. The photometric file's power is ignored where
/// the key `lumens` rescales the flux, since the lamp is another luminaire then. Empty for formats
/// other than the native one. Throws what read_scene throws.
LightingDesign read_lighting_design(const Scene& scene);

}  // namespace lightwell
