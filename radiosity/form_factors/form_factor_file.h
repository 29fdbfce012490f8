#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "radiosity/form_factors/view_factors.h"

namespace lightwell {

/// Writes a Matrix Market file (coordinate real general, counted from 1, ordered by row): F_ij > 0
/// with 9 significant digits, which restore a float exactly. `comment` is written into the header,
/// each line after a '%'. The file is written under a temporary name and renamed. Throws
/// std::runtime_error naming the file and the system's reason if writing fails.
void write_matrix_market(const std::filesystem::path& path, const ViewFactors& view_factors,
                         const std::string& comment);

/// Header of a View3D result file.
struct View3dHeader {
  std::string program = "Lightwell";  ///< without blanks
  std::string version = "0";          ///< without blanks
  bool is_enclosure = false;          ///< "surfaces form an enclosure"
};

/// Writes View3D's text result: a line `program version 0 enclosure 0 rows` of 30 characters, then
/// all areas (in units of `metres_per_unit` squared), the square matrix of factors with six
/// decimals, and the emittances, one per row. Throws as write_matrix_market, and InputError for
/// more than `most_view3d_rows` rows, because every zero is written out.
void write_view3d(const std::filesystem::path& path, const ViewFactors& view_factors,
                  const std::vector<double>& emittance, double metres_per_unit,
                  const View3dHeader& header);
inline constexpr int most_view3d_rows = 30000;

/// Writes VTK PolyData (.vtp): the elements as polygons with cell data `view_factor` (F_ij of row
/// `i`, what ParaView colours), `row` (counted from 1; 0: none), `is_row` (1 on the row itself) and
/// `area` (m^2, of the row). Throws as write_matrix_market.
void write_row(const std::filesystem::path& path, const PatchMesh& mesh,
               const std::vector<int>& row_of_patch, const ViewFactors& view_factors, int i);

}  // namespace lightwell
