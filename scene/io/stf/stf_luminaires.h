#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scene/io/lighting_design.h"
#include "scene/io/luminaires/luminaire_file.h"
#include "scene/io/numbered_names.h"
#include "scene/io/remarks.h"
#include "scene/io/stf/stf_file.h"
#include "scene/scene.h"

namespace lightwell {

/// Rotation about the fixed axes x, then y, then z, by angles in degrees.
Eigen::Matrix3d stf_rotation(const Eigen::Vector3d& angles);

/// Converts the luminaires of rooms to lamps. A luminaire has the photometric file beside the scene
/// that is named like its order number, its name or its section, `.ldt` or `.ies`. Without a file
/// it is an even opening of the size of its box, I = (Phi / pi) cos(gamma) below.
class StfLuminaires {
 public:
  /// Keeps references.
  StfLuminaires(StfFile& file, Scene& scene, LightingDesign& design, Remarks& remarks)
      : file_(file), scene_(scene), design_(design), remarks_(remarks) {}

  /// Adds the luminaires of a room whose floor lies at `floor`, m. Those that cannot be used are
  /// left out, with a remark.
  void add(StfSection& room, double floor);
  /// Remarks on keys of luminaires that were not read.
  void remark_unread() const;

 private:
  struct Type {
    SharedLuminaireFile file{};  // null: an even opening
    std::string name{};
    double lumens = 0.0;  // of the luminaire
    double watts = 0.0;   // 0: unknown
    LampOpening opening{};
    bool is_known = false;  // false: gives no light
  };
  const Type& type_of(const std::string& reference);
  Type read_type(const std::string& reference, StfSection& section);
  void read_values(StfSection& section, Type& type);
  SharedLuminaireFile find_file(const std::vector<std::string>& names);
  const SharedLuminaireFile& read_file(const std::filesystem::path& path);
  void add_one(StfSection& room, const std::string& key, double floor);

  StfFile& file_;
  Scene& scene_;
  LightingDesign& design_;
  Remarks& remarks_;
  NumberedNames names_;
  std::map<std::string, Type> types_{};  // by the reference of the room
  std::map<std::filesystem::path, SharedLuminaireFile> files_{};
  SharedWeb even_{};  // cos(gamma) below, 1 at gamma = 0
};

}  // namespace lightwell
