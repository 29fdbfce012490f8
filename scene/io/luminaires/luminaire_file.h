#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/lamp.h"

namespace lightwell {

/// What a photometric file says of a luminaire, in the conventions of Lamp: gamma = 0 is -z, C0 is
/// +x, and the opening lies across that axis.
struct LuminaireFile {
  std::filesystem::path file{};
  std::string format{};  ///< "IES LM-63-1995", "EULUMDAT"
  std::string name{}, maker{};
  /// Candela, with all the file's factors; W/sr if `is_radiometric`.
  SharedWeb web{};
  bool is_radiometric = false;
  double lamp_lumens = 0.0;     ///< of all its lamps; 0: measured absolutely, they are not known
  double watts = 0.0;           ///< input; 0: unknown
  std::string symmetry{};       ///< in words
  LampOpening opening{};        ///< m
  double opening_height = 0.0;  ///< m, which light is not taken to come from
  std::vector<std::string> notes{};  ///< what was assumed or left out: one sentence each

  double flux() const { return web ? web->integral() : 0.0; }
};

/// Reads IES LM-63 (1986, 1991, 1995, 2002, 2019; .ies) or EULUMDAT (.ldt), by the extension.
/// `lamp_set`, from 1, chooses among the sets of lamps of an EULUMDAT file. Throws InputError
/// naming file, line, what is wrong and what would be right.
LuminaireFile read_luminaire(const std::filesystem::path& path, int lamp_set = 1);

/// Gives `lamp` the distribution and opening of a luminaire, and an intensity of that colour: of
/// whatever brightness, light keeps its candela. What is measured in W/sr has as much in every
/// band. Throws InputError if the luminaire gives no light.
void place_luminaire(const LuminaireFile& luminaire, const Bands& bands, const Spectrum& colour,
                     Lamp& lamp);

/// Its notes for a scene: sentences that begin with the name of the file.
std::vector<std::string> luminaire_notes(const LuminaireFile& luminaire);

/// Whether the extension is one that read_luminaire knows.
bool is_luminaire_file(const std::filesystem::path& path);

/// IES LM-63: type C photometry. Sizes are taken as 2002 has them, with C0 along the length; TILT
/// factors are those of a luminaire that hangs level.
LuminaireFile read_ies(const std::filesystem::path& path);

/// EULUMDAT (Stockmar 1990), every symmetry, with C0 across the length.
LuminaireFile read_eulumdat(const std::filesystem::path& path, int lamp_set = 1);

/// Angle in degrees within which intensity is above `share` of the largest, in the plane through C
/// and C + 180: 0.5 is the beam angle, 0.1 the field angle. 0 for a luminaire without light there.
double beam_angle(const PhotometricWeb& web, double plane, double share);

/// Text of a file in whatever 8-bit encoding, as UTF-8: what is no UTF-8 is taken for Latin-1.
std::string as_utf8(std::string_view text);

/// The first `planes` of a measurement and what symmetry says of the others, with rising angles
/// from 0 to below 360. `mirrored`: planes that mirror those there, as pairs of (angle, row).
struct PlaneTable {
  std::vector<double> planes{};
  Eigen::ArrayXXd values{};
};
/// Puts planes of any angles, mirrored ones too, into order; those that come twice are taken once.
PlaneTable sorted_planes(const std::vector<std::pair<double, Eigen::Index>>& planes,
                         const Eigen::ArrayXXd& rows);

}  // namespace lightwell
