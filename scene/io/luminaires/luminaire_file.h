#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/lamp.h"

namespace lightwell {

/// Contents of a photometric file in the conventions of Lamp: gamma = 0 is -z, C0 is +x, and the
/// opening lies perpendicular to the axis.
struct LuminaireFile {
  std::filesystem::path file{};
  std::string format{};  ///< "IES LM-63-1995", "EULUMDAT"
  std::string name{}, maker{};
  /// Candela, all factors of the file applied; W/sr if `is_radiometric`.
  SharedWeb web{};
  bool is_radiometric = false;
  double lamp_lumens = 0.0;     ///< sum over its lamps; 0: absolute photometry, lamp flux unknown
  double watts = 0.0;           ///< input; 0: unknown
  std::string symmetry{};       ///< in words
  LampOpening opening{};        ///< m
  double opening_height = 0.0;  ///< m; light leaves from the opening, none from the sides
  LampBody body{};              ///< of EULUMDAT; IES files have none
  std::vector<std::string> notes{};  ///< assumptions and omissions: one sentence each

  double flux() const { return web ? web->integral() : 0.0; }
};

/// Reads IES LM-63 (1986, 1991, 1995, 2002, 2019; .ies) or EULUMDAT (.ldt), by the extension.
/// `lamp_set`, counted from 1, selects among the lamp sets of an EULUMDAT file. Throws InputError
/// naming file, line, fault and remedy.
LuminaireFile read_luminaire(const std::filesystem::path& path, int lamp_set = 1);

/// Sets distribution, opening, body and intensity of `lamp` from a luminaire. The intensity is the
/// spectrum of 1 cd with the hue of `colour` (the brightness of `colour` cancels); for radiometric
/// files 1 in every band. Throws InputError if all intensities of the luminaire are 0.
void place_luminaire(const LuminaireFile& luminaire, const Bands& bands, const Spectrum& colour,
                     Lamp& lamp);

/// Notes of a luminaire for a scene, each prefixed with the name of the file.
std::vector<std::string> luminaire_notes(const LuminaireFile& luminaire);

/// True if read_luminaire() reads files with this extension.
bool is_luminaire_file(const std::filesystem::path& path);

/// Reads IES LM-63, type C photometry. Luminous dimensions follow LM-63-2002, with C0 along the
/// length. TILT factors are those of a level luminaire.
LuminaireFile read_ies(const std::filesystem::path& path);

/// Reads EULUMDAT (Stockmar 1990), every symmetry, with C0 across the length.
LuminaireFile read_eulumdat(const std::filesystem::path& path, int lamp_set = 1);

/// Full angle in degrees within which intensity is at least `share` of the largest, in the plane
/// through C and C + 180 (`plane`, degrees). Share 0.5 gives the beam angle, 0.1 the field angle. 0
/// for a luminaire without light in that plane.
double beam_angle(const PhotometricWeb& web, double plane, double share);

/// C-planes in degrees, rising in [0, 360), and the intensities in each (one row per plane).
struct PlaneTable {
  std::vector<double> planes{};
  Eigen::ArrayXXd values{};
};
/// Sorts planes given as pairs of (angle, row of `rows`) into a PlaneTable. Angles are reduced to
/// [0, 360); of equal angles the first is kept. Symmetry is expressed by several angles with one
/// row.
PlaneTable sorted_planes(const std::vector<std::pair<double, Eigen::Index>>& planes,
                         const Eigen::ArrayXXd& rows);

}  // namespace lightwell
