#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "radiosity/form_factors/view_factor_rows.h"
#include "radiosity/form_factors/view_factors.h"

namespace lightwell {

/// Names of the files that write_openfoam() writes.
std::vector<std::string> openfoam_file_names();

/// Writes the lists that OpenFOAM's radiation model viewFactor reads from a case's folder constant,
/// as text of FoamFile version 2.0, counted from 0. Face k of the model is row `first` + k of the
/// matrix; factors to rows before `first` are left out.
///   - F: the factors above 0 of each face, 9 significant digits; globalFaceFaces: the faces that
///     each of the factors belongs to.
///   - finalAgglom: for each run of rows of one surface, which is a patch, the faces 0, 1, 2 ...;
///     no faces are agglomerated.
///   - subMap, constructMap, constructMapDim: the map of one processor, whose faces stay in place.
/// Throws std::runtime_error naming the file and the system's reason if writing fails.
void write_openfoam(const std::filesystem::path& folder, const ViewFactors& view_factors,
                    const ViewFactorRows& rows, int first = 0);

/// View factors between surfaces: those of their rows, added by area.
struct SurfaceViewFactors {
  std::vector<std::string> name{};            ///< as a word without blanks, unique
  std::vector<double> area{};                 ///< m^2
  std::vector<std::vector<double>> factor{};  ///< F_IJ = sum_(i in I) A_i sum_(j in J) F_ij / A_I
};

/// Rows of one name are a surface. Rows without area are left out. Throws InputError naming `file`
/// for more than `most_moose_surfaces` surfaces.
SurfaceViewFactors surface_view_factors(const std::filesystem::path& file,
                                        const ViewFactors& view_factors,
                                        const ViewFactorRows& rows);
inline constexpr int most_moose_surfaces = 2000;

/// Writes the surface_view_factors() for MOOSE: a user object SpecifiedViewFactor in a file that
/// ends in .i, for `!include`; otherwise a table with commas and the columns boundary, area (m^2)
/// and one for each surface. 9 significant digits. Throws as write_openfoam() and
/// surface_view_factors() do.
void write_moose(const std::filesystem::path& path, const ViewFactors& view_factors,
                 const ViewFactorRows& rows);

}  // namespace lightwell
