#include "radiosity/part_balance.h"

#include <Eigen/LU>
#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "mesh/patches/patch_sampler.h"
#include "mesh/patches/translucency.h"
#include "radiosity/emitters/free_source.h"
#include "radiosity/gather/patch_power.h"
#include "radiosity/refine/error_reference.h"
#include "radiosity/solution/light_channel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr std::size_t most_parts = 32;
// Sample points in each part of up to eight. Even independent points leave less than 1/sqrt(512) =
// 4 % of the spread of light in the part, and stratified ones are better. Among more parts, most
// are insides of furniture that matter to nothing else, and all share the points of eight.
constexpr int points_of_part = 512, parts_with_all = 8;
// Parts with less of the brightest part's mean radiosity are dark.
constexpr double least_light = 1e-7;

struct BalanceSample {
  PatchPoint point{};
  double weight = 0.0;  // m^2
};

// Channels whose light is gathered together.
struct ChannelRange {
  int first = 0, count = 1;
};

// Light of a channel at vertices, vertices x bands.
struct ChannelLight {
  BandArray reflected{};  // radiosity, W/m^2
  BandArray caustic{};    // irradiance, W/m^2; empty: none
};

// A s = b for the parts of a scene, in one band of one channel.
struct BalanceEquations {
  explicit BalanceEquations(Eigen::Index parts)
      : matrix(Eigen::MatrixXd::Zero(parts, parts)),
        right(Eigen::VectorXd::Zero(parts)),
        variance(Eigen::ArrayXd::Zero(parts)) {}

  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;
  Eigen::ArrayXd variance;  // of A s - b where all s are 1
};

// The power that parts reflect, and where it comes from.
class ReflectedPower {
 public:
  // Radiosity of all channels, vertices x columns, without `emitted` and with it.
  ReflectedPower(const LitScene& lit, const PartBalance& balance, const BandArray& emitted,
                 const BandArray& radiosity)
      : lit_(lit),
        mesh_(lit.mesh()),
        balance_(balance),
        bands_(lit.scene.bands.count()),
        patch_(vertex_patches(mesh_)),
        emitted_(emitted),
        radiosity_(radiosity) {
    choose_parts(channel_sum(radiosity_ - emitted_, bands_));
  }

  // The parts that have light, in rising order.
  const std::vector<int>& parts() const { return chosen_; }

  // The scale of each chosen part, parts x columns of all channels.
  Eigen::ArrayXXd scales() const {
    Eigen::ArrayXXd scales(static_cast<Eigen::Index>(chosen_.size()), radiosity_.cols());
    const int channels = static_cast<int>(radiosity_.cols()) / bands_;
    // Columns that take no more memory than those of most_parts, or twice those of all channels.
    const int most =
        std::max(1, std::max(1 + static_cast<int>(most_parts), 2 * channels) / blocks());
    for (int first = 0; first < channels; first += most) {
      const ChannelRange range{first, std::min(most, channels - first)};
      const std::vector<BalanceEquations> equations = equations_of(range);
      for (std::size_t j = 0; j < equations.size(); ++j) {
        scales.col(first * bands_ + static_cast<Eigen::Index>(j)) = solved(equations[j]);
      }
    }
    return scales;
  }

  // Index into parts() of the part that a vertex belongs to; -1: none of them. The light of sheets
  // comes from both sides and is not scaled.
  int part_of_vertex(int v) const {
    if (is_translucent(patch_[static_cast<std::size_t>(v)])) return -1;
    return place_[static_cast<std::size_t>(balance_.parts.judged_with(patch_[v]))];
  }

 private:
  // `reflected`: sums of all channels, vertices x bands.
  void choose_parts(const BandArray& reflected) {
    const auto count = static_cast<std::size_t>(balance_.parts.judged_count());
    std::vector<double> power(count, 0.0), area(count, 0.0);
    const Eigen::ArrayXXd of_patch = patch_integral(mesh_, reflected);
    for (int p = 0; p < mesh_.patch_count(); ++p) {
      const auto part = static_cast<std::size_t>(balance_.parts.judged_with(p));
      power[part] += of_patch.row(p).sum();
      area[part] += mesh_.area[p];
    }
    const auto mean = [&](std::size_t p) { return area[p] > 0.0 ? power[p] / area[p] : 0.0; };
    double brightest = 0.0;
    for (std::size_t p = 0; p < count; ++p) brightest = std::max(brightest, mean(p));
    for (std::size_t p = 0; p < count; ++p) {
      if (mean(p) > least_light * brightest) chosen_.push_back(static_cast<int>(p));
    }
    if (chosen_.size() > most_parts) {
      std::ranges::stable_sort(chosen_, [&](int a, int b) { return power[a] > power[b]; });
      chosen_.resize(most_parts);
      std::ranges::sort(chosen_);
    }
    place_.assign(count, -1);
    for (std::size_t i = 0; i < chosen_.size(); ++i) place_[chosen_[i]] = static_cast<int>(i);
    for (const int part : chosen_) {
      first_sample_.push_back(static_cast<int>(samples_.size()));
      std::ranges::copy(draw(part, reflected), std::back_inserter(samples_));
    }
    first_sample_.push_back(static_cast<int>(samples_.size()));
  }

  // Blocks of columns for each channel in a gather: emission and all that is not scaled, and the
  // light that each part reflects.
  int blocks() const { return 1 + static_cast<int>(chosen_.size()); }

  bool is_all(ChannelRange range) const { return range.count * bands_ == radiosity_.cols(); }

  // The first column of a channel's block in a gather.
  Eigen::Index first_column(int channel, Eigen::Index block) const {
    return (channel * blocks() + block) * bands_;
  }

  std::vector<ChannelLight> light_of(ChannelRange range) const {
    std::vector<ChannelLight> lights;
    for (int c = range.first; c < range.first + range.count; ++c) {
      const Eigen::Index k = c * bands_;
      ChannelLight light{radiosity_.middleCols(k, bands_) - emitted_.middleCols(k, bands_)};
      if (balance_.caustic.size() > 0) light.caustic = balance_.caustic.middleCols(k, bands_);
      lights.push_back(std::move(light));
    }
    return lights;
  }

  // Direct light in the first block of each channel. Other channels have a block behind all.
  EmitterChannels channels_by_block(ChannelRange range) const {
    const int used = range.count * blocks();
    const auto block_of = [&](int channel) {
      const int i = channel - range.first;
      return i >= 0 && i < range.count ? i * blocks() : used;
    };
    EmitterChannels channels;
    for (int i = 0; i < used + (is_all(range) ? 0 : 1); ++i) {
      channels.names.push_back(std::to_string(i));
    }
    channels.of_surface.assign(lit_.scene.surfaces.size(), 0);
    const std::vector<FacetRef> facets = scene_facets(lit_.scene);
    for (std::size_t f = 0; f < facets.size(); ++f) {
      channels.of_surface[static_cast<std::size_t>(facets[f].surface)] =
          block_of(lit_.direct_light.first_column(static_cast<int>(f)) / bands_);
    }
    for (const FreeSource& source : lit_.direct_light.free_sources()) {
      channels.of_source.push_back(block_of(source.channel));
    }
    return channels;
  }

  // Radiosity that gathers read.
  BandArray columns_by_part(ChannelRange range, const std::vector<ChannelLight>& lights) const {
    const int count = range.count * blocks() + (is_all(range) ? 0 : 1);
    BandArray columns = BandArray::Zero(radiosity_.rows(), count * bands_);
    for (int c = 0; c < range.count; ++c) {
      columns.middleCols(first_column(c, 0), bands_) =
          emitted_.middleCols((range.first + c) * bands_, bands_);
      for (int v = 0; v < mesh_.vertex_count(); ++v) {
        columns.row(v).segment(first_column(c, 1 + part_of_vertex(v)), bands_) +=
            lights[static_cast<std::size_t>(c)].reflected.row(v);
      }
    }
    return columns;
  }

  std::vector<BalanceEquations> equations_of(ChannelRange range) const {
    // Without channels all direct light is in the first block.
    std::optional<DirectLight> by_block;
    if (lit_.direct_light.channel_count() > 1) {
      by_block.emplace(lit_.scene, mesh_, channels_by_block(range), &lit_.direct_light);
    }
    const LitScene lit{lit_.scene, lit_.caster, by_block ? *by_block : lit_.direct_light};
    const std::vector<ChannelLight> lights = light_of(range);
    const BandArray by_part = columns_by_part(range, lights);
    const auto count = static_cast<Eigen::Index>(chosen_.size());
    std::vector<BalanceEquations> equations(static_cast<std::size_t>(range.count * bands_),
                                            BalanceEquations(count));
    const GatheredIrradiance found = gather(lit, by_part);
    for (Eigen::Index p = 0; p < count; ++p) {
      if (first_sample_[p] == first_sample_[p + 1]) continue;
      for (int c = 0; c < range.count; ++c) {
        add_rows(p, c, found, lights[static_cast<std::size_t>(c)],
                 std::span(equations).subspan(c * bands_, bands_));
      }
    }
    return equations;
  }

  // The equation of part p in each band of a channel, which is number `channel` of those gathered.
  void add_rows(Eigen::Index p, int channel, const GatheredIrradiance& found,
                const ChannelLight& light, std::span<BalanceEquations> equations) const {
    const Eigen::Index first = first_sample_[p];
    Eigen::ArrayXXd excess(first_sample_[p + 1] - first, bands_);
    for (Eigen::Index i = first; i < first + excess.rows(); ++i) {
      const auto& [point, weight] = samples_[static_cast<std::size_t>(i)];
      const auto rho = mesh_.reflectance.row(mesh_.patch[point.element]);
      const ElementHit hit = point_on_element(mesh_, point);
      const Spectrum own = interpolate(mesh_, light.reflected, hit);
      const Spectrum caustic = light.caustic.size() > 0 ? interpolate(mesh_, light.caustic, hit)
                                                        : Spectrum(Spectrum::Zero(bands_));
      for (Eigen::Index k = 0; k < bands_; ++k) {
        auto& [matrix, right, variance] = equations[static_cast<std::size_t>(k)];
        const Eigen::Index at = first_column(channel, 0) + k;
        const double by_rho = weight * double{rho[k]};
        double arriving =
            double{found.direct(i, at)} + double{found.indirect(i, at)} + double{caustic[k]};
        right[p] += by_rho * arriving;
        matrix(p, p) += weight * double{own[k]};
        for (Eigen::Index q = 0; q < matrix.cols(); ++q) {
          const double of_part = double{found.indirect(i, at + (1 + q) * bands_)};
          matrix(p, q) -= by_rho * of_part;
          arriving += of_part;
        }
        excess(i - first, k) = weight * double{own[k]} - by_rho * arriving;
      }
    }
    for (Eigen::Index k = 0; k < bands_; ++k) {
      const auto of_band = excess.col(k);
      equations[static_cast<std::size_t>(k)].variance[p] =
          (of_band - of_band.mean()).square().sum();
    }
  }

  // Sheets scatter light of both sides, which points on one side do not tell.
  bool is_translucent(int patch) const { return mesh_.patch_behind(patch) >= 0; }

  // Points on the surfaces of a part, half of them by area and half by the light that is reflected.
  std::vector<BalanceSample> draw(int part, const BandArray& reflected) const {
    struct Candidate {
      int element;
      double area, power, up_to;
    };
    std::vector<Candidate> candidates;
    double area = 0.0, power = 0.0;
    for (int p = 0; p < mesh_.patch_count(); ++p) {
      if (balance_.parts.judged_with(p) != part || !(mesh_.reflectance.row(p) > 0.0f).any() ||
          is_translucent(p) || lit_.caster.hidden_elements(p) > 0) {
        continue;
      }
      for (int e = mesh_.first_element[p]; e < mesh_.first_element[p + 1]; ++e) {
        double light = 0.0;
        for (int c = 0; c < mesh_.corner_count(e); ++c) {
          light += reflected.row(mesh_.corners[e][c]).sum() / mesh_.corner_count(e);
        }
        const double of_element = mesh_.element_area[e] * std::max(light, 0.0);
        candidates.push_back({e, mesh_.element_area[e], of_element, 0.0});
        area += mesh_.element_area[e];
        power += of_element;
      }
    }
    std::vector<BalanceSample> samples;
    if (candidates.empty() || !(power > 0.0)) return samples;
    double sum = 0.0;
    const auto chance = [&](const Candidate& c) { return 0.5 * (c.area / area + c.power / power); };
    for (Candidate& c : candidates) c.up_to = sum += chance(c);
    const int points_per_part = points_of_part * parts_with_all /
                                std::max(parts_with_all, static_cast<int>(chosen_.size()));
    const SobolPoints sobol(points_per_part);
    const std::uint64_t key = random_key(static_cast<std::uint64_t>(part),
                                         RandomPurpose::balance_points, balance_.gather.replica);
    for (int i = 0; i < points_per_part; ++i) {
      const Eigen::Array4f u = sobol.point(i, key);
      const auto at = std::ranges::upper_bound(candidates.begin(), candidates.end() - 1,
                                               double{u[0]} * sum, {}, &Candidate::up_to);
      const int e = at->element;
      samples.push_back({PatchSampler(mesh_, mesh_.patch[e], e).point(u[1], u[2]),
                         at->area / (chance(*at) * points_per_part)});
    }
    return samples;
  }

  // At the sample points of all parts.
  GatheredIrradiance gather(const LitScene& lit, const BandArray& columns) const {
    std::vector<GatherPoint> points;
    for (std::size_t p = 0; p < chosen_.size(); ++p) {
      const auto part = static_cast<std::size_t>(chosen_[p]);
      for (int i = first_sample_[p]; i < first_sample_[p + 1]; ++i) {
        const PatchPoint& point = samples_[static_cast<std::size_t>(i)].point;
        points.push_back({.position = point.position,
                          .normal = point.normal,
                          .facet = mesh_.facet[point.element],
                          .key = random_key(part, i - first_sample_[p]),
                          .rays = balance_.rays[part]});
      }
    }
    return gather_irradiance(lit, columns, points, balance_.gather);
  }

  // s of A s = b, drawn towards 1 by how sure the points are of it: the light of lamps within a
  // part is balanced already (see keep_power in reconstruct), while A_pp is in a bright part a
  // small difference between what the part reflects and what comes back. Parts without power in the
  // band keep theirs.
  static Eigen::ArrayXd solved(BalanceEquations equations) {
    auto& [matrix, right, variance] = equations;
    for (Eigen::Index p = 0; p < right.size(); ++p) {
      if (matrix(p, p) > 0.0) continue;
      matrix.row(p).setZero();
      matrix(p, p) = right[p] = 1.0;
    }
    const auto within_limits = [](const Eigen::VectorXd& scales) -> Eigen::ArrayXd {
      constexpr double most = 4.0;  // a larger factor is not to be trusted
      return scales.array().max(1.0 / most).min(most);
    };
    const Eigen::ArrayXd rough = within_limits(matrix.partialPivLu().solve(right));
    // Errors to expect before. Rows of 512 rays have a noise of 1/sqrt(512), of which a fifteenth
    // is left in the mean over 200 patches or more. Without balance, light behind two doors was off
    // by 27 to 40 % with any mesh.
    constexpr double of_own = 0.003, through_doors = 0.3;
    for (Eigen::Index p = 0; p < right.size(); ++p) {
      const double own = matrix(p, p);
      const double from_others = std::max(own * rough[p] - matrix.row(p).dot(rough.matrix()), 0.0);
      const double all = from_others + std::max(right[p], 0.0);
      const double expected =
          of_own + (all > 0.0 ? through_doors * from_others / all : through_doors);
      const double weight = expected * expected / (expected * expected + variance[p] / (own * own));
      matrix.row(p) *= weight / own;
      matrix(p, p) = 1.0;
      right[p] = 1.0 - weight + weight * right[p] / own;
    }
    return within_limits(matrix.partialPivLu().solve(right));
  }

  const LitScene& lit_;
  const PatchMesh& mesh_;
  const PartBalance& balance_;
  int bands_;
  std::vector<int> patch_;  // of each vertex
  const BandArray &emitted_, &radiosity_;
  std::vector<int> chosen_{}, place_{};   // parts, and the index of each part in chosen_, -1: none
  std::vector<BalanceSample> samples_{};  // of one chosen part after another
  std::vector<int> first_sample_{};       // of each chosen part, and the number of all
};

}  // namespace

void balance_parts(const LitScene& lit, const PartBalance& balance, BandArray& radiosity) {
  if (balance.parts.judged_count() < 2) return;
  const BandArray emitted = gatherable_radiosity(
      lit.mesh(), lit.direct_light, BandArray::Zero(radiosity.rows(), radiosity.cols()));
  const ReflectedPower power(lit, balance, emitted, radiosity);
  if (power.parts().size() < 2) return;
  const Eigen::ArrayXXf scales = power.scales().cast<float>();
  for (int v = 0; v < lit.mesh().vertex_count(); ++v) {
    const int part = power.part_of_vertex(v);
    if (part < 0) continue;
    const auto own = emitted.row(v);
    radiosity.row(v) = own + (radiosity.row(v) - own) * scales.row(part);
  }
}

}  // namespace lightwell
