#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "radiosity/form_factors/view_factors.h"

namespace lightwell {

/// Radiation of the facets of an uDALES case (Suter et al. 2022, "uDALES 1.0: a large-eddy
/// simulation model for urban environments"), in the order of the facets.
struct UdalesRadiation {
  const ViewFactors& factors;
  const Eigen::ArrayXd& sky_view;  ///< [0, 1]
  const Eigen::ArrayXd& direct;    ///< W/m^2
  const Eigen::ArrayXd& net;       ///< W/m^2
};

/// The files that write_udales() writes, in `folder`, for the case `number` ("001").
std::vector<std::filesystem::path> udales_files(const std::filesystem::path& folder,
                                                const std::string& number);

/// Albedo of each of `count` facets of the case in `folder`: facets.inp has the type of each facet
/// in its first column, factypes.inp numbers of types in the first and albedos in the fifth. Lines
/// that begin with '#' are headings. Throws InputError that names file, line and remedy.
Eigen::ArrayXd read_udales_albedos(const std::filesystem::path& folder, const std::string& number,
                                   int count);

/// Writes the text files that uDALES 2 reads: svf.inp, netsw.inp and vfsparse.inp, with the case's
/// number as extension, and Sdir.txt of its preprocessing. View factors below 5e-7 are left out,
/// which the six digits of the file would show as 0. Returns the number of view factors, which the
/// case's parameter `nnz` gives. Throws std::runtime_error with the file and the reason.
std::int64_t write_udales(const std::filesystem::path& folder, const std::string& number,
                          const UdalesRadiation& radiation);

}  // namespace lightwell
