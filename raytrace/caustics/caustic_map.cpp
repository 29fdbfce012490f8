#include "raytrace/caustics/caustic_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "raytrace/caustics/photon_tree.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

// Standard deviation of the noise of independent photons, W/m^2, in the brightest band: that of the
// bands' mean, as the band's light is to the mean's. A coloured light is in few bands.
double noise_of(const PhotonDensity& density) {
  const double mean = double{density.irradiance.mean()};
  return mean > 0.0 ? std::sqrt(density.variance) * double{density.irradiance.maxCoeff()} / mean
                    : 0.0;
}

// The greatest difference of any band, W/m^2.
double difference(const PhotonDensity& a, const PhotonDensity& b) {
  return double{(a.irradiance - b.irradiance).abs().maxCoeff()};
}

// 1 up to `whole` times `noise`, falling to 0 at `none` times `noise`.
double fade(double difference, double whole, double none, double noise) {
  if (!(noise > 0.0)) return 0.0;
  return std::clamp((none - difference / noise) / (none - whole), 0.0, 1.0);
}

}  // namespace

int CausticMap::neighbours(std::size_t count) {
  // The scale is measured on the focus of the glass sphere in the Cornell box.
  constexpr double scale = 0.04;
  constexpr int least = 16;
  return std::max(least, static_cast<int>(scale * std::pow(static_cast<double>(count), 2.0 / 3.0)));
}

CausticMap::CausticMap(const PatchMesh& mesh, const CausticPhotons& photons)
    : regions_(light_regions(mesh)), bands_(static_cast<int>(mesh.emission.cols())) {
  if (photons.count() == 0) return;
  const int k = neighbours(photons.count());
  const PhotonSums each = each_photon(photons);
  PhotonTree tree = build_photon_tree(mesh, regions_, each);
  // Discs of a quarter of the neighbours cost a quarter of the time, and ripple little.
  const int fewer = neighbours(photons.count() / 8);
  constexpr int clustered_photons = 4 * DiscTree::leaf_size;
  const PhotonSums small = clustered(tree, each, clustered_photons),
                   large = clustered(tree, each, 4 * clustered_photons);
  layers_.emplace_back(regions_, std::move(tree), each, k);
  for (const PhotonSums* clusters : {&small, &large}) {
    // A disc of more than a quarter of a region would be folded more than once.
    const int fewest = 4 * fewer;
    layers_.emplace_back(regions_, build_photon_tree(mesh, regions_, *clusters), *clusters, fewer,
                         fewest);
  }
  measure_noise(mesh, small, fewer);
}

// Photons of stratified samples have less noise than independent ones, and those by way of few
// facets may have more. Measured at pairs of clusters a disc apart: the blur of the wider discs is
// about the same at both, so that noise alone differs. The median of a normal
// distribution's deviations is 0.6745 of its standard deviation.
void CausticMap::measure_noise(const PatchMesh& mesh, const PhotonSums& clusters, int k) {
  constexpr double median_of_normal = 0.6745;
  constexpr std::size_t most_samples = 512;
  noise_.assign(static_cast<std::size_t>(regions_.count()), 0.0f);
  // Clusters follow each other in space, those of a region together.
  std::vector<std::vector<std::size_t>> of_region(noise_.size());
  for (std::size_t i = 0; i < clusters.element.size(); ++i) {
    const auto element = static_cast<std::size_t>(clusters.element[i]);
    of_region[static_cast<std::size_t>(regions_.of_element[element])].push_back(i);
  }
  // Wide discs hold k clusters, and narrow ones a tenth of that. Narrow discs of two radii apart
  // share no photon.
  const auto apart = static_cast<std::size_t>(std::max(1, k / 2));
  parallel_for(regions_.count(), 1, [&](int begin, int end) {
    for (int region = begin; region < end; ++region) {
      const std::vector<std::size_t>& own = of_region[static_cast<std::size_t>(region)];
      if (!layers_.back().cover(region) || own.size() <= apart) continue;
      const std::size_t pairs = own.size() - apart, samples = std::min(most_samples, pairs);
      std::vector<double> ratios;
      for (std::size_t s = 0; s < samples; ++s) {
        Spectrum both = Spectrum::Zero(bands_);
        double noise2 = 0.0;
        for (const std::size_t end_of_pair : {std::size_t{0}, apart}) {
          const std::size_t i = own[s * pairs / samples + end_of_pair];
          const Eigen::Vector3d normal = element_center(mesh, clusters.element[i]).normal;
          const PhotonDensity narrow = layers_[0].at(clusters.position[i], normal, region),
                              wide = layers_[1].at(clusters.position[i], normal, region);
          const float sign = end_of_pair == 0 ? 1.0f : -1.0f;
          both += sign * (narrow.irradiance - wide.irradiance);
          noise2 += std::pow(noise_of(narrow), 2);
        }
        if (noise2 > 0.0) ratios.push_back(double{both.abs().maxCoeff()} / std::sqrt(noise2));
      }
      if (ratios.empty()) continue;
      const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
      std::ranges::nth_element(ratios, middle);
      noise_[static_cast<std::size_t>(region)] = static_cast<float>(*middle / median_of_normal);
    }
  });
}

Spectrum CausticMap::irradiance(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                int element, double besides) const {
  if (layers_.empty()) return Spectrum::Zero(bands_);
  const int region = regions_.of_element[static_cast<std::size_t>(element)];
  const PhotonDensity narrow = layers_[0].at(point, normal, region);
  if (!layers_.back().cover(region)) return narrow.irradiance;
  // Something sharp that both wider discs blur alike shows against the narrow one.
  constexpr double sure = 3.0, excluded = 4.0;
  const double measured = double{noise_[static_cast<std::size_t>(region)]};
  const double noise = measured * noise_of(narrow);
  constexpr double faint = 0.005;
  const double all = double{narrow.irradiance.mean()} + besides;
  const double visible = std::clamp(noise / (faint * all) - 1.0, 0.0, 1.0);
  if (!(visible > 0.0)) return narrow.irradiance;
  const PhotonDensity wide = layers_[1].at(point, normal, region);
  double share = visible * fade(difference(narrow, wide), sure, excluded, noise);
  if (!(share > 0.0)) return narrow.irradiance;
  // The error of the blur grows with the square of the radius, so that the wide disc has a third of
  // the difference from the widest one, with twice the radius.
  constexpr double whole = 0.5, none = 1.5;
  const PhotonDensity widest = layers_[2].at(point, normal, region);
  const double blur = difference(wide, widest);
  // A blur of a few percent of all light would be seen, as at the focus of a lens.
  constexpr double visible_blur = 0.04;
  share *= fade(blur, whole, none, std::min(noise, visible_blur * all));
  const double of_widest = fade(blur, whole, none, measured * noise_of(wide));
  const Spectrum smooth =
      wide.irradiance + static_cast<float>(of_widest) * (widest.irradiance - wide.irradiance);
  return narrow.irradiance + static_cast<float>(share) * (smooth - narrow.irradiance);
}

std::shared_ptr<const CausticMap> trace_caustics(const Scene& scene, const ElementCaster& caster,
                                                 const DirectLight& direct_light, int photons,
                                                 int max_specular_depth, const Progress& progress) {
  return std::make_shared<const CausticMap>(
      caster.mesh(),
      shoot_photons({scene, caster, direct_light}, photons, max_specular_depth, progress));
}

}  // namespace lightwell
