#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace lightwell {

/// Contents of the files in validation/data and of the Cornell box, embedded by CMake
/// (cmake/EmbedFile.cmake).
namespace validation_data {

extern const std::string_view viewfactors_json, enclosures_json, cie171_json, optics_json,
    photometry_json;
extern const std::string_view axial_lambert_ies, quadrant_mult_ies, spot_ies, isym1_ldt, isym2_ldt,
    isym4_ldt;
extern const std::string_view ugr_tables_json;
extern const std::string_view cornell_toml, cornell_irradiance_csv;

}  // namespace validation_data

/// Key and value of a reference case, as in validation/data/README.md.
using ReferenceValue = nlohmann::ordered_json;

/// The cases of an embedded JSON file.
ReferenceValue reference_cases(std::string_view json);

Eigen::Vector3d reference_point(const ReferenceValue& value);
std::vector<Eigen::Vector3d> reference_polygon(const ReferenceValue& value);

/// The failure of this machine, and of no case, to hold a file.
struct NoFolder : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Embedded text as a file of its own, for readers that take a path. The destructor removes the
/// file.
class EmbeddedFile {
 public:
  /// Writes `text` to a new file of that name in a new folder for temporary files. Throws
  /// NoFolder that names the folder.
  EmbeddedFile(std::string_view name, std::string_view text);
  ~EmbeddedFile();
  EmbeddedFile(const EmbeddedFile&) = delete;
  EmbeddedFile& operator=(const EmbeddedFile&) = delete;

  const std::filesystem::path& path() const { return file_; }

 private:
  std::filesystem::path folder_{}, file_{};
};

}  // namespace lightwell
