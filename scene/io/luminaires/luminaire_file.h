#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/lamp.h"
#include "scene/spectrum_samples.h"

namespace lightwell {

/// Largest intensity that files may have, candela or W/sr. Single precision ends at 3.4e38: 1e18
/// stay below that at a distance of a nanometre.
inline constexpr double most_intensity = 1e18;
/// Sentence on an intensity outside of [0, most_intensity]; `factor` multiplies it. Empty within.
std::string fault_of_intensity(double intensity, double factor);

/// Spectrum of an emitter of a luminaire.
struct EmitterSpectrum {
  std::string name{};
  double flux = 0.0;          ///< lm, the emitter's share of the luminaire's flux
  SpectrumSamples samples{};  ///< power for each nm, in any unit
};

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
  LampBody body{};              ///< of EULUMDAT and TM-33; LM-63 files have none
  std::vector<EmitterSpectrum> spectra{};  ///< TM-33: of all emitters, or none
  std::vector<std::string> notes{};        ///< assumptions and omissions: one sentence each

  double flux() const { return web ? web->integral() : 0.0; }
};

/// Reads IES LM-63 (1986, 1991, 1995, 2002, 2019; .ies), EULUMDAT (.ldt) or IES TM-33 (.xml), by
/// the extension. `lamp_set`, counted from 1, selects among the lamp sets of an EULUMDAT file.
/// Throws InputError naming file, line, fault and remedy.
LuminaireFile read_luminaire(const std::filesystem::path& path, int lamp_set = 1);

/// Sets distribution, opening, body and intensity of `lamp` from a luminaire. The intensity is the
/// spectrum of 1 cd with the hue of `colour` (the brightness of `colour` cancels); for radiometric
/// files 1 in every band. Throws InputError if all intensities of the luminaire are 0.
void place_luminaire(const LuminaireFile& luminaire, const Bands& bands, const Spectrum& colour,
                     Lamp& lamp);

/// Note on luminous sides of `height` metres, whose light leaves from the opening.
std::string sideways_note(double height);

/// Notes of a luminaire for a scene, each prefixed with the name of the file.
std::vector<std::string> luminaire_notes(const LuminaireFile& luminaire);

/// True if read_luminaire() reads files with this extension; of .xml files, if the root element is
/// that of TM-33.
bool is_luminaire_file(const std::filesystem::path& path);

/// Reads IES LM-63, type C photometry. Luminous dimensions follow LM-63-2002, with C0 along the
/// length. TILT factors are those of a level luminaire.
LuminaireFile read_ies(const std::filesystem::path& path);

/// Reads EULUMDAT (Stockmar 1990), every symmetry, with C0 across the length.
LuminaireFile read_eulumdat(const std::filesystem::path& path, int lamp_set = 1);

/// Reads ANSI/IES TM-33-18 and TM-33-23: type C photometry, candela or W/sr. Intensities of several
/// emitters are added. C0 lies along the width of the luminaire. `spectra` are set for candela.
LuminaireFile read_tm33(const std::filesystem::path& path);

/// Full angle in degrees within which intensity is at least `share` of the largest, in the plane
/// through C and C + 180 (`plane`, degrees). Share 0.5 gives the beam angle, 0.1 the field angle. 0
/// for a luminaire without light in that plane.
double beam_angle(const PhotometricWeb& web, double plane, double share);

/// C-planes in degrees, rising in [0, 360), and the intensities in each (one row per plane).
struct PlaneTable {
  std::vector<double> planes{};
  Eigen::ArrayXXd values{};
};
/// Planes that a file leaves out, numbered as in EULUMDAT.
enum class PlaneSymmetry { none, all_around, about_c0, about_c90, quarters };
const char* symmetry_words(PlaneSymmetry symmetry);
/// Symmetry of rising angles C by the rule of LM-63: one plane holds all around, planes from 0 to
/// 90 for a quarter, from 0 to 180 or from 90 to 270 for a half, from 0 to above 180 for all. Empty
/// for others.
std::optional<PlaneSymmetry> symmetry_of_planes(const std::vector<double>& angles);
/// Sentence on angles for which symmetry_of_planes() is empty.
std::string no_symmetry_of_planes(const std::vector<double>& angles);
/// Completes planes (degrees; one row of `rows` each) by their symmetry.
PlaneTable unfolded_planes(PlaneSymmetry symmetry, const std::vector<double>& angles,
                           const Eigen::ArrayXXd& rows);

/// Sorts planes given as pairs of (angle, row of `rows`) into a PlaneTable. Angles are reduced to
/// [0, 360); of equal angles the first is kept. Symmetry is expressed by several angles with one
/// row.
PlaneTable sorted_planes(const std::vector<std::pair<double, Eigen::Index>>& planes,
                         const Eigen::ArrayXXd& rows);

}  // namespace lightwell
