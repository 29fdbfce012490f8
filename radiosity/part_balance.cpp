#include "radiosity/part_balance.h"

#include <Eigen/LU>
#include <algorithm>
#include <numeric>
#include <optional>

#include "mesh/patches/patch_sampler.h"
#include "mesh/patches/translucency.h"
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

// The power that parts reflect, and where it comes from.
class ReflectedPower {
 public:
  // Radiosity in sums of all channels, vertices x bands.
  ReflectedPower(const LitScene& lit, const PartBalance& balance, BandArray emitted,
                 BandArray reflected)
      : lit_(lit),
        mesh_(lit.mesh()),
        balance_(balance),
        patch_(vertex_patches(mesh_)),
        emitted_(std::move(emitted)),
        reflected_(std::move(reflected)) {
    if (balance.caustic.size() > 0) {
      caustic_ = channel_sum(balance.caustic, static_cast<int>(reflected_.cols()));
    }
    choose_parts();
  }

  // The parts that have light, in rising order.
  const std::vector<int>& parts() const { return chosen_; }

  // The scale of each chosen part, parts x bands.
  Eigen::ArrayXXd scales() const {
    const Eigen::Index bands = reflected_.cols(), count = static_cast<Eigen::Index>(chosen_.size());
    const BandArray by_part = columns_by_part();
    // Rows of parts; the columns of a band are the power, the constant part, and that of each part.
    std::vector<Eigen::MatrixXd> matrix(bands, Eigen::MatrixXd::Zero(count, count));
    std::vector<Eigen::VectorXd> right(bands, Eigen::VectorXd::Zero(count));
    Eigen::ArrayXXd variance = Eigen::ArrayXXd::Zero(count, bands);  // of A s - b where all s are 1
    for (Eigen::Index p = 0; p < count; ++p) {
      const std::vector<BalanceSample> samples = draw(chosen_[p]);
      const GatheredIrradiance found = gather(samples, by_part, chosen_[p]);
      const BandArray direct = from_lamps(found, samples);
      Eigen::ArrayXXd excess(static_cast<Eigen::Index>(samples.size()), bands);
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto& [point, weight] = samples[i];
        const auto row = static_cast<Eigen::Index>(i);
        const auto rho = mesh_.reflectance.row(mesh_.patch[point.element]);
        const Spectrum own = interpolate(mesh_, reflected_, point_on_element(mesh_, point));
        for (Eigen::Index k = 0; k < bands; ++k) {
          const double by_rho = weight * double{rho[k]};
          matrix[k](p, p) += weight * double{own[k]};
          right[k][p] += by_rho * (double{direct(row, k)} + double{found.indirect(row, k)});
          for (Eigen::Index q = 0; q < count; ++q) {
            matrix[k](p, q) -= by_rho * double{found.indirect(row, (1 + q) * bands + k)};
          }
          const double arriving =
              double{direct(row, k)} + found_in(found.indirect.row(row), k, bands);
          excess(row, k) = weight * double{own[k]} - by_rho * arriving;
        }
      }
      if (samples.empty()) continue;
      variance.row(p) = (excess.rowwise() - excess.colwise().mean()).square().colwise().sum();
    }
    Eigen::ArrayXXd scales = Eigen::ArrayXXd::Ones(count, bands);
    for (Eigen::Index k = 0; k < bands; ++k) {
      scales.col(k) = solved(matrix[k], right[k], variance.col(k));
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
  void choose_parts() {
    const auto count = static_cast<std::size_t>(balance_.parts.judged_count());
    std::vector<double> power(count, 0.0), area(count, 0.0);
    const Eigen::ArrayXXd of_patch = patch_integral(mesh_, reflected_);
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
  }

  // Radiosity that gathers read. Its first columns are emission and all that is not scaled; those
  // after them are the light that each part reflects.
  BandArray columns_by_part() const {
    const Eigen::Index bands = reflected_.cols();
    BandArray columns =
        BandArray::Zero(reflected_.rows(), bands * (1 + static_cast<Eigen::Index>(chosen_.size())));
    columns.leftCols(bands) = emitted_;
    for (int v = 0; v < mesh_.vertex_count(); ++v) {
      const Eigen::Index block = 1 + part_of_vertex(v);
      columns.row(v).segment(block * bands, bands) += reflected_.row(v);
    }
    return columns;
  }

  // Sheets scatter light of both sides, which points on one side do not tell.
  bool is_translucent(int patch) const { return mesh_.patch_behind(patch) >= 0; }

  // Points on the surfaces of a part, half of them by area and half by the light that is reflected.
  std::vector<BalanceSample> draw(int part) const {
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
          light += reflected_.row(mesh_.corners[e][c]).sum() / mesh_.corner_count(e);
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

  GatheredIrradiance gather(const std::vector<BalanceSample>& samples, const BandArray& columns,
                            int part) const {
    std::vector<GatherPoint> points;
    for (const auto& [point, weight] : samples) {
      points.push_back({.position = point.position,
                        .normal = point.normal,
                        .facet = mesh_.facet[point.element],
                        .key = random_key(static_cast<std::uint64_t>(part), points.size()),
                        .rays = balance_.rays[static_cast<std::size_t>(part)]});
    }
    return gather_irradiance(lit_, columns, points, balance_.gather);
  }

  // Irradiance from lamps at samples, samples x bands: straight, and the mesh's caustics.
  BandArray from_lamps(const GatheredIrradiance& found,
                       const std::vector<BalanceSample>& samples) const {
    BandArray E = channel_sum(found.direct, static_cast<int>(reflected_.cols()));
    for (std::size_t i = 0; caustic_.size() > 0 && i < samples.size(); ++i) {
      const ElementHit hit = point_on_element(mesh_, samples[i].point);
      E.row(static_cast<Eigen::Index>(i)) += interpolate(mesh_, caustic_, hit).transpose();
    }
    return E;
  }

  // The light of all columns of a band.
  template <class Row>
  static double found_in(const Row& columns, Eigen::Index band, Eigen::Index bands) {
    double sum = 0.0;
    for (Eigen::Index k = band; k < columns.size(); k += bands) sum += double{columns[k]};
    return sum;
  }

  // s of A s = b, drawn towards 1 by how sure the points are of it: the light of lamps within a
  // part is balanced already (see keep_power in reconstruct), while A_pp is in a bright part a
  // small difference between what the part reflects and what comes back. `variance` is that of each
  // row of A s - b. Parts without power in the band keep theirs.
  static Eigen::ArrayXd solved(Eigen::MatrixXd matrix, Eigen::VectorXd right,
                               const Eigen::ArrayXd& variance) {
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
  std::vector<int> patch_;  // of each vertex
  BandArray emitted_{}, reflected_{};
  BandArray caustic_{};                  // irradiance, vertices x bands; empty: none
  std::vector<int> chosen_{}, place_{};  // parts, and the index of each part in chosen_, -1: none
};

}  // namespace

void balance_parts(const LitScene& lit, const PartBalance& balance, BandArray& radiosity) {
  if (balance.parts.judged_count() < 2) return;
  const auto bands = lit.scene.bands.count();
  const BandArray none = BandArray::Zero(radiosity.rows(), radiosity.cols());
  const BandArray emitted = gatherable_radiosity(lit.mesh(), lit.direct_light, none);
  // Gathers here have a column for each part. Light of as many channels would be taken for parts.
  std::optional<DirectLight> together;
  if (lit.direct_light.channel_count() > 1) {
    together.emplace(lit.scene, lit.mesh(), EmitterChannels{}, &lit.direct_light);
  }
  const LitScene whole{lit.scene, lit.caster, together ? *together : lit.direct_light};
  const ReflectedPower power(whole, balance, channel_sum(emitted, bands),
                             channel_sum(radiosity - emitted, bands));
  if (power.parts().size() < 2) return;
  const Eigen::ArrayXXf scales = power.scales().cast<float>();
  for (int v = 0; v < lit.mesh().vertex_count(); ++v) {
    const int part = power.part_of_vertex(v);
    if (part < 0) continue;
    for (Eigen::Index k = 0; k < radiosity.cols(); k += bands) {
      auto at = radiosity.row(v).segment(k, bands);
      const auto own = emitted.row(v).segment(k, bands);
      at = own + (at - own) * scales.row(part);
    }
  }
}

}  // namespace lightwell
