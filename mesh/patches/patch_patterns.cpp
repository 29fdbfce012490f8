#include "mesh/patches/patch_patterns.h"

#include "mesh/patches/texture_cells.h"
#include "scene/parallel.h"

namespace lightwell {

struct PatchPatterns::Sums {
  Sums(int bands, const CoatLevels* rough_coat)
      : coat(rough_coat),
        specular(Eigen::ArrayXd::Zero(bands)),
        by_coat(specular),
        bare(specular),
        straight(specular),
        transmittance(specular) {}

  void add(const Material& m, double weight) {
    area += weight;
    add(m.specular, weight, specular);
    if (coat) add(m.specular, weight * coat->at(m.specular_roughness).mean_mirrored(), by_coat);
    if (m.coat) {
      cover += weight * double{m.coat->cover};
      add(m.coat->bare, weight, bare);
    }
    add(m.regular_transmittance, weight, straight);
    add(m.transmittance, weight, transmittance);
    roughness += weight * double{m.dielectric ? m.dielectric->roughness : m.specular_roughness};
  }

  const CoatLevels* coat;  // of a coat whose roughness varies; null: none
  double area = 0.0, cover = 0.0, roughness = 0.0;
  Eigen::ArrayXd specular, by_coat, bare, straight, transmittance;

 private:
  static void add(const Spectrum& share, double weight, Eigen::ArrayXd& sum) {
    if (share.size() > 0) sum += weight * share.cast<double>();
  }
};

PatchPatterns::PatchPatterns(const Scene& scene, const PatchMesh& mesh)
    : row_(static_cast<std::size_t>(mesh.patch_count()), -1) {
  int rows = 0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    int& row = row_[static_cast<std::size_t>(mesh.patch[e])];
    if (row < 0 && mesh.textures->has_pattern(mesh.facet[e])) row = rows++;
  }
  const int bands = scene.bands.count();
  for (BandArray* of : {&specular_, &bare_, &straight_, &transmittance_}) of->setZero(rows, bands);
  cover_.setZero(rows);
  roughness_.setZero(rows);
  coat_.resize(static_cast<std::size_t>(rows));
  constexpr int grain = 16;
  parallel_for(mesh.patch_count(), grain, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      if (!is_given(p)) continue;
      const Material& material = scene.materials[static_cast<std::size_t>(mesh.material[p])];
      coat_[static_cast<std::size_t>(row_[p])] = material.pattern->coat_levels;
      Sums sums(bands, material.pattern->roughness ? material.pattern->coat_levels.get() : nullptr);
      for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
        add_element(scene, mesh, e, sums);
      }
      keep(p, sums);
    }
  });
}

void PatchPatterns::add_element(const Scene& scene, const PatchMesh& mesh, int element,
                                Sums& sums) const {
  const FacetTextures& textures = *mesh.textures;
  const int facet = mesh.facet[element];
  const auto corner = corners_of(mesh, element);
  const bool has_pattern = textures.has_pattern(facet), has_holes = textures.has_holes(facet);
  const Material& even =
      scene.materials[static_cast<std::size_t>(mesh.material[mesh.patch[element]])];
  const CellGrid grid = has_holes     ? finest_cells
                        : has_pattern ? cells_over(textures, facet, corner)
                                      : CellGrid{.along = 1, .across = 1};
  for (int i = 0; i < grid.along; ++i) {
    for (int j = 0; j < grid.across; ++j) {
      const TextureCell cell = texture_cell(corner, grid, i, j);
      if (has_holes && textures.is_hole(facet, cell.middle)) continue;
      if (has_pattern) {
        sums.add(textures.material(facet, cell.middle, filter_of(cell)), cell.area);
      } else {
        sums.add(even, cell.area);
      }
    }
  }
}

void PatchPatterns::keep(int patch, const Sums& sums) {
  const int row = row_[static_cast<std::size_t>(patch)];
  if (!(sums.area > 0.0)) return;  // all hole
  const auto mean = [&](const Eigen::ArrayXd& sum, BandArray& of) {
    of.row(row) = (sum / sums.area).cast<float>().min(1.0f).transpose();
  };
  mean(sums.specular, specular_);
  mean(sums.bare, bare_);
  mean(sums.straight, straight_);
  mean(sums.transmittance, transmittance_);
  cover_[row] = static_cast<float>(sums.cover / sums.area);
  roughness_[row] = static_cast<float>(sums.roughness / sums.area);
  if (!sums.coat) return;
  // A coat of the mean roughness mirrors another share than the mean of the points does.
  const double at_mean = sums.coat->at(roughness_[row]).mean_mirrored();
  if (at_mean > 0.0) {
    specular_.row(row) = (sums.by_coat / (sums.area * at_mean)).cast<float>().transpose();
  }
}

Material PatchPatterns::mirror_of(const Material& material, int patch) const {
  const int row = row_[static_cast<std::size_t>(patch)];
  Material mirror{.specular = specular_.row(row).transpose(),
                  .specular_roughness = roughness_[row],
                  .coat = material.coat,
                  .metal = material.metal,
                  .dielectric = material.dielectric,
                  .one_sided = material.one_sided,
                  .pattern = material.pattern};
  if (mirror.dielectric) mirror.dielectric->roughness = roughness_[row];
  if (mirror.coat) mirror.coat->cover = cover_[row];
  if (mirror.coat && mirror.coat->bare.size() > 0) mirror.coat->bare = bare_.row(row).transpose();
  if (material.passes_straight()) mirror.regular_transmittance = straight_.row(row).transpose();
  return mirror;
}

std::optional<CoatedBase> PatchPatterns::base_of(int patch) const {
  const int row = row_[static_cast<std::size_t>(patch)];
  const auto& coat = coat_[static_cast<std::size_t>(row)];
  if (!coat) return std::nullopt;
  return coat->at(roughness_[row]).covering(cover_[row]);
}

void PatchPatterns::set_transmittance(PatchMesh& mesh) const {
  if (mesh.transmittance.size() == 0) return;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (is_given(p)) mesh.transmittance.row(p) = transmittance_.row(row_[std::size_t(p)]);
  }
}

}  // namespace lightwell
