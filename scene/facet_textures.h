#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "scene/rgb_basis.h"
#include "scene/scene.h"

namespace lightwell {

/// Pictures of materials on the facets of a scene, where facets have texture coordinates. Facets
/// are numbered through the scene (see scene_facets). Keeps no reference to the scene.
class FacetTextures {
 public:
  explicit FacetTextures(const Scene& scene);

  /// True if no facet shows a picture.
  bool is_empty() const { return entry_of_.empty(); }
  /// True if some facet has holes.
  bool has_holes() const { return has_holes_; }
  /// Hash of all that decides where the holes are; 0 without holes.
  std::uint64_t hash_of_holes() const { return hash_of_holes_; }
  /// True if rho varies over the facet, by a texture or a pattern.
  bool is_textured(int facet) const {
    return varying(facet) && (materials_of(facet).texture || materials_of(facet).patterned);
  }
  /// True if some facet has a pattern.
  bool has_patterns() const { return has_patterns_; }
  bool has_pattern(int facet) const { return varying(facet) && materials_of(facet).patterned; }
  bool has_holes(int facet) const { return varying(facet) && materials_of(facet).mask; }
  /// True if some facet shines by a picture.
  bool has_emission() const { return has_emission_; }
  bool has_emission(int facet) const { return varying(facet) && materials_of(facet).emission; }

  /// Diffuse rho at `point` (metres) in the plane of a textured facet, unfiltered.
  Spectrum reflectance(int facet, const Eigen::Vector3d& point) const;
  /// Mean diffuse rho about `point` over the parallelogram with sides `footprint` (columns,
  /// metres).
  Spectrum reflectance(int facet, const Eigen::Vector3d& point,
                       const Eigen::Matrix<double, 3, 2>& footprint) const;
  /// The same of the exitance M, W/m^2, of a facet that shines by a picture.
  Spectrum emission(int facet, const Eigen::Vector3d& point) const;
  Spectrum emission(int facet, const Eigen::Vector3d& point,
                    const Eigen::Matrix<double, 3, 2>& footprint) const;
  /// The numbers of the material at `point` of a facet that has a pattern, unfiltered, and about
  /// `point` (see material_at()).
  Material material(int facet, const Eigen::Vector3d& point) const;
  Material material(int facet, const Eigen::Vector3d& point,
                    const Eigen::Matrix<double, 3, 2>& footprint) const;
  /// GGX alpha at `point` (metres) of a facet that has a pattern, unfiltered.
  float roughness(int facet, const Eigen::Vector3d& point) const;
  /// The picture by which a facet shines, and its coordinates.
  const EmissionTexture& emission_texture(int facet) const { return *materials_of(facet).emission; }
  const UvMap& uv_map(int facet) const { return entry(facet).uv; }
  /// Largest number of texels of a facet's texture, pattern or picture of emission along `vector`
  /// (metres) in the facet's plane.
  double texels_along(int facet, const Eigen::Vector3d& vector) const;
  /// True if light passes at `point` (metres) of a facet that has holes.
  bool is_hole(int facet, const Eigen::Vector3d& point) const;

 private:
  struct Pictures {
    std::optional<ReflectanceTexture> texture{};
    std::optional<EmissionTexture> emission{};
    std::optional<Mask> mask{};
    std::shared_ptr<const Material> patterned{};  // null: no pattern
  };
  struct Entry {
    int pictures = 0;
    UvMap uv{};
  };
  void add_to_hash(int facet);
  bool varying(int facet) const { return !entry_of_.empty() && entry_of_[std::size_t(facet)] >= 0; }
  const Entry& entry(int facet) const {
    return entries_[static_cast<std::size_t>(entry_of_[static_cast<std::size_t>(facet)])];
  }
  const Pictures& materials_of(int facet) const {
    return pictures_[static_cast<std::size_t>(entry(facet).pictures)];
  }

  std::vector<Pictures> pictures_{};
  std::vector<Entry> entries_{};  // one for each UvMap of a surface that has pictures
  std::vector<int> entry_of_{};   // by facet; -1: no picture; empty: no facet has one
  RgbBasis basis_{};
  bool has_holes_ = false, has_emission_ = false, has_patterns_ = false;
  std::uint64_t hash_of_holes_ = 0;
};

}  // namespace lightwell
