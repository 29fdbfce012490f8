#include "radiosity/refine/vertex_gathers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "radiosity/gather/gap_light.h"
#include "radiosity/gather/patch_power.h"
#include "radiosity/refine/effort.h"
#include "radiosity/refine/error_reference.h"
#include "radiosity/refine/gather_noise.h"
#include "radiosity/refine/refine_solution.h"

namespace lightwell {
namespace {

constexpr std::uint64_t first_pilot_replica = 1000;

// Distance of vertices from their elements' corners, as a share of the way to the centre of an
// element of the deepest level (see vertex_gather_points).
constexpr double finest_inset = 0.02;

// Vertices at the start above which half the pilot rays serve as well, since predictions average
// the noise of many neighbours. In a hall with some 50 000 vertices the picture stayed within 1.3 %
// of its reference, in the median over its squares.
constexpr int many_vertices = 1 << 15;

std::vector<int> vertices_of(const PatchMesh& mesh) {
  std::vector<int> all(static_cast<std::size_t>(mesh.vertex_count()));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

// `count` rows, of which row[i] is row i of a gather of indirect light; the others are 0.
GatheredIrradiance spread(GatheredIrradiance found, const std::vector<int>& row,
                          Eigen::Index count) {
  if (found.variance.size() == count) return found;
  GatheredIrradiance all{.indirect = spread_rows(found.indirect, row, count),
                         .variance = Eigen::ArrayXf::Zero(count)};
  for (std::size_t i = 0; i < row.size(); ++i) {
    all.variance[row[i]] = found.variance[static_cast<Eigen::Index>(i)];
  }
  return all;
}

}  // namespace

VertexGathers::VertexGathers(const LitScene& lit, const BandArray& radiosity,
                             const BandArray& caustic, RefinedElements& elements,
                             const GatherOptions& options, const RefineOptions& refine)
    : scene_(lit.scene),
      caster_(lit.caster),
      direct_light_(lit.direct_light),
      radiosity_(radiosity),
      elements_(elements),
      options_(options),
      parts_(refine.parts),
      rays_of_part_(static_cast<std::size_t>(parts_.judged_count()), options.rays),
      has_noise_goal_(!refine.efforts.empty() && refine.efforts.front().noise > 0.0),
      few_rays_suffice_(has_noise_goal_ || elements.base().vertex_count() > many_vertices),
      efforts_(refine.efforts),
      inset_(std::ldexp(finest_inset, -refine.max_level)),
      fineness_(vertex_fineness(elements.base(), parts_)),
      visibility_(lit.direct_light.light_count()),
      unread_patch_(unread_patches(lit.scene, elements.base())),
      shared_(find_shared_gathers(lit.scene, elements.base())) {
  // Refinement of few elements does not get near its tolerance in most scenes, and exact light at
  // all of the start's vertices would be in vain.
  constexpr std::int64_t much_room = 2;
  const bool is_start_large =
      most_elements(elements, refine) < much_room * elements.element_count();
  has_rough_sky_.assign(
      rays_of_part_.size(),
      is_start_large && !has_noise_goal_ && direct_light_.dome() && !efforts_.empty() ? 1 : 0);
  if (options.run.progress) {
    options_.run.progress = [progress = options.run.progress](std::string_view, double share) {
      return progress("refine", share);
    };
  }
  share_pilot_rays();
  sharpen_radiosity(caustic);
  gather_indirect_at(vertices_of(elements.base()));
}

// Rays of each of the two pilot gathers, for a final one of `rays`.
int VertexGathers::pilot_rays(int rays) const {
  // With half as many as an eighth, the predictions made of the pilot gathers showed as faint
  // blotches on walls.
  const int share = few_rays_suffice_ ? 16 : 8;
  // The noise of two gathers of 16 rays hid errors of 11 % (root mean square) in a daylit room that
  // asked for 10 %: the estimate stays above the target, and attempts split elements that are small
  // enough.
  // In a hall with a goal of 5 %, the second attempt had 326, 272, 134 and 141 thousand elements by
  // 16, 32, 64 and 128 rays.
  constexpr int fewest_for_a_goal = 64;
  const int wanted = std::max(rays / share, has_noise_goal_ ? fewest_for_a_goal : 1);
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(wanted)));
}

// Vertices of small elements cast fewer rays, but a quarter at least: with fewer, noise would hide
// the differences that the gathers are made for. Vertices that share gathers cast an eighth: what
// the noise hides is left out for the whole group.
void VertexGathers::share_pilot_rays() {
  const PatchMesh& mesh = elements_.base();
  std::vector<int> rays;
  for (const int of_part : rays_of_part_) rays.push_back(pilot_rays(of_part));
  rays_ = share_rays(mesh, {}, parts_, rays);
  const std::vector<int> patch = vertex_patches(mesh);
  std::vector<char> shares(static_cast<std::size_t>(mesh.vertex_count()), 0);
  for (const InterpolatedVertex& at : shared_.read) shares[at.vertex] = 1;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const int times = shares[v] != 0 ? 1 : 2;
    rays_[v] = std::min(times * rays_[v], rays[parts_.judged_with(patch[v])]);
  }
}

GatherPoint VertexGathers::gather_point(int vertex) const {
  const PatchPoint at = elements_.inside(vertex, inset_);
  const GatherPoint point{at.position, at.normal, elements_.base().facet[at.element]};
  const Eigen::Vector3d center = element_center(elements_.base(), at.element).position;
  return moved_into_gap(caster_, elements_.position(vertex), center, point);
}

// A gather point with random numbers of the vertex's own.
GatherPoint VertexGathers::keyed_point(int vertex) const {
  GatherPoint point = gather_point(vertex);
  point.key = static_cast<std::uint64_t>(vertex);
  point.sky_noise = sky_noise_at(vertex);
  return point;
}

// The number of the scene's part that a vertex is judged with.
int VertexGathers::part_of(int vertex) const {
  return parts_.judged_with(elements_.base().patch[elements_.inside(vertex, 0.0).element]);
}

// Rays of a part's typical vertices over those of a vertex, or its fineness; 1 or more.
double VertexGathers::fewness(int vertex) const {
  const auto v = static_cast<std::size_t>(vertex);
  const double typical = pilot_rays(rays_of_part_[static_cast<std::size_t>(part_of(vertex))]);
  return std::max({1.0, typical / rays_[v], static_cast<double>(fineness_[v])});
}

// The noise that the sky's light may have: more where fewer rays are cast than at a part's typical
// vertices, and where errors matter less for what somebody looks at.
NoiseGoal VertexGathers::sky_noise_at(int vertex) const {
  // Interpolation averages vertices, so that half of the square is left on surfaces.
  constexpr double averaged = 0.7;
  constexpr float least_importance = 1.0f / 64.0f;
  if (efforts_.empty()) return {};
  const int patch = elements_.base().patch[elements_.inside(vertex, 0.0).element];
  const auto part = static_cast<std::size_t>(part_of(vertex));
  const float importance = std::max(parts_.importance_of(patch), least_importance);
  const double times = roughness_[static_cast<std::size_t>(vertex)] *
                       std::sqrt(fewness(vertex) / static_cast<double>(importance));
  NoiseGoal goal =
      noise_goal(efforts_[part].irradiance, averaged * times * efforts_[part].sky_noise);
  // Without an accuracy the goal saves rays, and asks for no more than the options do.
  if (!has_noise_goal_) goal.most_times = 1;
  return goal;
}

Spectrum VertexGathers::total(int vertex) const {
  return (direct_.row(vertex) + 0.5f * (first_.row(vertex) + second_.row(vertex))).transpose();
}

void VertexGathers::make_room() {
  const int count = elements_.vertex_count();
  if (count > direct_.rows()) {
    // Doubled, as a vector grows.
    const Eigen::Index rows = std::max<Eigen::Index>(count, 2 * direct_.rows());
    for (BandArray* values : {&direct_, &first_, &second_}) {
      values->conservativeResize(rows, scene_.bands.count());
    }
  }
  has_direct_.resize(count, 0);
  indirect_.resize(count, Indirect::unknown);
  // A new vertex casts as many rays as the ends between which it lies: with fewer, noise would hide
  // the differences that decide over the next split.
  for (int v = static_cast<int>(rays_.size()); v < count; ++v) {
    int most = 0;
    float coarsest = std::numeric_limits<float>::max();
    for (const int end : elements_.ends(v)) {
      if (end < 0) continue;
      most = std::max(most, rays_[end]);
      coarsest = std::min(coarsest, fineness_[end]);
    }
    rays_.push_back(most);
    fineness_.push_back(coarsest);
  }
  make_sky_rough(static_cast<int>(roughness_.size()));
  visibility_.resize(count);
}

// Sets the roughness of new vertices, from `first_vertex` on. Small elements bear more noise, and a
// part's typical ones, on which it would be seen, none: vertices at corners of a grid, with a
// quarter of the area of others, have a fineness of 2. Twice and four times the noise begin where a
// vertex has a ninth and a 36th of the typical area: a third and a sixth of the edge, so that the
// multiple times the edge stays below that of typical ones.
void VertexGathers::make_sky_rough(int first_vertex) {
  const int count = elements_.vertex_count();
  roughness_.resize(static_cast<std::size_t>(count), 1);
  for (int v = first_vertex; v < count; ++v) {
    if (has_rough_sky_[static_cast<std::size_t>(part_of(v))] == 0) continue;
    const double few = fewness(v);
    roughness_[static_cast<std::size_t>(v)] = few > 6.0 ? 4 : few > 3.0 ? 2 : 1;
  }
}

void VertexGathers::shrink_to_fit() {
  for (BandArray* values : {&direct_, &first_, &second_}) {
    values->conservativeResize(elements_.vertex_count(), values->cols());
  }
  has_direct_.shrink_to_fit();
  indirect_.shrink_to_fit();
  rays_.shrink_to_fit();
  fineness_.shrink_to_fit();
  roughness_.shrink_to_fit();
  visibility_.shrink_to_fit();
}

// True if no ray reads the light at a vertex.
bool VertexGathers::is_unread(int vertex) const {
  const PatchMesh& mesh = elements_.base();
  return unread_patch_[mesh.patch[elements_.inside(vertex, 0.0).element]] != 0;
}

// Gathers direct light at the base's vertices; on unread crumbs at the records alone.
void VertexGathers::gather_direct_at_base() {
  const auto count = static_cast<std::size_t>(elements_.base().vertex_count());
  gather_direct_at(indices_without(shared_.unread, count));
  interpolate_vertices(shared_.unread, direct_);
  for (const InterpolatedVertex& at : shared_.unread) has_direct_[at.vertex] = 1;
}

// Direct light at vertices, with the rays to the sky that their roughness asks for; vertices x
// columns of `light`.
BandArray VertexGathers::direct_at(const DirectLight& light, const std::vector<int>& vertices,
                                   std::vector<EmitterVisibility>* visibilities) const {
  const auto count = static_cast<Eigen::Index>(vertices.size());
  BandArray direct = BandArray::Zero(count, light.channel_count() * scene_.bands.count());
  if (visibilities) visibilities->assign(vertices.size(), {});
  for (const int roughness : {1, 2, 4}) {
    std::vector<int> rows;
    std::vector<GatherPoint> points;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (roughness_[static_cast<std::size_t>(vertices[i])] != roughness) continue;
      rows.push_back(static_cast<int>(i));
      points.push_back(keyed_point(vertices[i]));
    }
    if (points.empty()) continue;
    GatherOptions options = options_;
    // The least number of rays falls with the goal.
    options.shadows.sky_rays = (options.shadows.sky_rays + roughness - 1) / roughness;
    std::vector<EmitterVisibility> seen;
    const BandArray found =
        gather_direct({scene_, caster_, light}, points, options, visibilities ? &seen : nullptr);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      direct.row(rows[i]) = found.row(static_cast<Eigen::Index>(i));
      if (visibilities) (*visibilities)[static_cast<std::size_t>(rows[i])] = seen[i];
    }
  }
  return direct;
}

// Gathers the direct light of vertices.
void VertexGathers::set_direct(const std::vector<int>& vertices) {
  std::vector<EmitterVisibility> visibilities;
  const BandArray direct = direct_at(direct_light_, vertices, &visibilities);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    direct_.row(vertices[i]) = direct.row(static_cast<Eigen::Index>(i));
    visibility_.set(vertices[i], visibilities[i]);
  }
  gathers_ += static_cast<std::int64_t>(vertices.size());
}

void VertexGathers::gather_direct_at(const std::vector<int>& vertices) {
  std::vector<int> fresh;
  for (const int v : vertices) {
    if (has_direct_[v]) continue;
    has_direct_[v] = 1;
    fresh.push_back(v);
  }
  set_direct(fresh);
}

bool VertexGathers::sharpen_sky(const std::vector<double>& left) {
  std::vector<char> is_sharpened(has_rough_sky_.size(), 0);
  for (std::size_t p = 0; p < left.size(); ++p) {
    // The roughest light has four times the noise of the goal, on small elements.
    constexpr double roughest = 4.0;
    if (has_rough_sky_[p] == 0 || left[p] > roughest * efforts_[p].sky_noise) continue;
    has_rough_sky_[p] = 0;
    is_sharpened[p] = 1;
  }
  std::vector<int> vertices;
  for (int v = 0; v < elements_.vertex_count(); ++v) {
    auto& roughness = roughness_[static_cast<std::size_t>(v)];
    if (roughness == 1 || is_sharpened[static_cast<std::size_t>(part_of(v))] == 0) continue;
    const std::uint8_t rough = roughness;
    roughness = 1;
    if (has_direct_[v] == 0) continue;
    const NoiseGoal goal = sky_noise_at(v);
    const double enough = std::max(goal.irradiance, goal.share * double{direct_.row(v).mean()});
    if (visibility_[v].drawn_noise > enough) {
      vertices.push_back(v);
    } else {
      roughness = rough;
    }
  }
  set_direct(vertices);
  interpolate_vertices(shared_.unread, direct_);
  return !vertices.empty();
}

// One gather of indirect light, with the same random numbers all over a side of a surface; 0 where
// no ray reads the light.
GatheredIrradiance VertexGathers::indirect_at(const std::vector<int>& vertices,
                                              std::uint64_t replica,
                                              const BandArray& radiosity) const {
  const PatchMesh& mesh = elements_.base();
  std::vector<int> rows;
  std::vector<GatherPoint> points;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const int v = vertices[i];
    if (is_unread(v)) continue;
    rows.push_back(static_cast<int>(i));
    GatherPoint& point = points.emplace_back(gather_point(v));
    const int patch = mesh.patch[elements_.inside(v, 0.0).element];
    point.key = random_key(static_cast<std::uint64_t>(mesh.surface[patch]),
                           mesh.is_back[patch] != 0 ? 1 : 0);
    point.rays = rays_[static_cast<std::size_t>(v)];
  }
  GatherOptions options = options_;
  options.rays = pilot_rays(options_.rays);
  options.replica = options_.replica + first_pilot_replica + replica;
  GatheredIrradiance found =
      gather_indirect({scene_, caster_, direct_light_}, radiosity, points, options);
  return spread(std::move(found), rows, static_cast<Eigen::Index>(vertices.size()));
}

// A gather at the base's vertices, of each group of crumbs at the records alone. Their variance
// times the rays of a vertex is that of a ray of theirs.
GatheredIrradiance VertexGathers::sharpened_indirect(const BandArray& radiosity) const {
  const auto count = static_cast<Eigen::Index>(elements_.base().vertex_count());
  const std::vector<int> own = indices_without(shared_.read, static_cast<std::size_t>(count));
  GatheredIrradiance all = spread(indirect_at(own, 2, radiosity), own, count);
  interpolate_vertices(shared_.read, all.indirect);
  for (const InterpolatedVertex& at : shared_.read) {
    for (int i = 0; i < at.end_count(); ++i) {
      const auto share = static_cast<float>(rays_[at.ends[i]]) /
                         static_cast<float>(rays_[at.vertex] * at.end_count());
      all.variance[at.vertex] += share * all.variance[at.ends[i]];
    }
  }
  return all;
}

// Replaces the radiosity of patches, one value each, by what a gather finds at the base's vertices.
// Where the noise is limited, that of this gather decides over the rays of the final gather.
void VertexGathers::sharpen_radiosity(const BandArray& caustic) {
  const PatchMesh& mesh = elements_.base();
  make_room();
  gather_direct_at_base();
  GatheredIrradiance gathered = sharpened_indirect(radiosity_);
  BandArray irradiance = direct_.topRows(mesh.vertex_count()) + gathered.indirect;
  if (caustic.size() > 0) irradiance += caustic;
  radiosity_ = with_pools(
      mesh, radiosity_,
      gatherable_radiosity(mesh, direct_light_, irradiance, direct_.topRows(mesh.vertex_count())));
  if (!has_noise_goal_) return;
  const Eigen::ArrayXf rays =
      Eigen::Map<const Eigen::ArrayXi>(rays_.data(), mesh.vertex_count()).cast<float>();
  const std::vector<double> found = rms_noises(
      mesh, gather_noise(mesh, irradiance, gathered.variance * rays, rays, parts_), parts_);
  for (std::size_t p = 0; p < rays_of_part_.size(); ++p) {
    rays_of_part_[p] = rays_for_noise(pilot_rays(rays_of_part_[p]), found[p], efforts_[p].noise);
  }
  options_.rays = *std::ranges::max_element(rays_of_part_);
  share_pilot_rays();
}

void VertexGathers::gather_indirect_at(const std::vector<int>& vertices) {
  std::vector<int> fresh;
  for (const int v : vertices) {
    if (indirect_[v] == Indirect::gathered) continue;
    indirect_[v] = Indirect::gathered;
    fresh.push_back(v);
  }
  const BandArray first = indirect_at(fresh, 0, radiosity_).indirect,
                  second = indirect_at(fresh, 1, radiosity_).indirect;
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    first_.row(fresh[i]) = first.row(static_cast<Eigen::Index>(i));
    second_.row(fresh[i]) = second.row(static_cast<Eigen::Index>(i));
  }
}

void VertexGathers::interpolate_indirect(int vertex) {
  if (indirect_[vertex] != Indirect::unknown) return;
  indirect_[vertex] = Indirect::interpolated;
  Eigen::RowVectorXf first = Eigen::RowVectorXf::Zero(first_.cols()), second = first;
  int count = 0;
  for (const int end : elements_.ends(vertex)) {
    if (end < 0) continue;
    interpolate_indirect(end);
    first += first_.row(end).matrix();
    second += second_.row(end).matrix();
    ++count;
  }
  first_.row(vertex) = first.array() / static_cast<float>(count);
  second_.row(vertex) = second.array() / static_cast<float>(count);
}

GatheredIrradiance VertexGathers::values(const std::vector<int>& vertices) const {
  const auto count = static_cast<Eigen::Index>(vertices.size());
  GatheredIrradiance result{.direct = BandArray(count, scene_.bands.count()),
                            .indirect = BandArray(count, scene_.bands.count())};
  for (Eigen::Index i = 0; i < count; ++i) {
    result.direct.row(i) = direct_.row(vertices[i]);
    result.indirect.row(i) = 0.5f * (first_.row(vertices[i]) + second_.row(vertices[i]));
  }
  return result;
}

std::vector<VertexPrediction> VertexGathers::shared_predictions() const {
  std::vector<VertexPrediction> predictions;
  const std::vector<InterpolatedVertex>& read = shared_.read;
  const auto off = [](const BandArray& values, const InterpolatedVertex& at) -> Eigen::ArrayXd {
    Eigen::ArrayXd mean = Eigen::ArrayXd::Zero(values.cols());
    for (int i = 0; i < at.end_count(); ++i) {
      mean += values.row(at.ends[i]).transpose().cast<double>() / at.end_count();
    }
    return values.row(at.vertex).transpose().cast<double>() - mean;
  };
  for (std::size_t begin = 0, end = 0; begin < read.size(); begin = end) {
    double spread = 0.0, noise = 0.0;
    for (; end < read.size() && read[end].ends == read[begin].ends; ++end) {
      // The noise of the two gathers is independent, so the mean of their product has none.
      const Eigen::ArrayXd a = off(first_, read[end]), b = off(second_, read[end]);
      spread += (a * b).mean();
      noise += 0.25 * (a - b).square().mean();
    }
    const auto count = static_cast<double>(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      predictions.push_back({.at = read[i],
                             .is_shared = true,
                             .spread = static_cast<float>(std::max(spread / count, 0.0)),
                             .noise = static_cast<float>(noise / count)});
    }
  }
  return predictions;
}

// The radiosity of sharpen_radiosity() for the light of channels; `direct` begins with the base's
// vertices.
BandArray VertexGathers::sharpened_by_channel(const BandArray& direct,
                                              const ChannelLight& light) const {
  const PatchMesh& mesh = elements_.base();
  BandArray irradiance =
      direct.topRows(mesh.vertex_count()) + sharpened_indirect(light.radiosity).indirect;
  if (light.caustic.size() > 0) irradiance += light.caustic;
  return with_pools(mesh, light.radiosity,
                    gatherable_radiosity(mesh, light.direct_light, irradiance,
                                         direct.topRows(mesh.vertex_count())));
}

GatheredIrradiance VertexGathers::values_by_channel(
    const std::vector<int>& vertices, std::span<const InterpolatedVertex> interpolated,
    const ChannelLight& light) const {
  // Direct light is gathered at the base's vertices, then at the others of the list.
  std::vector<int> lit_vertices = vertices_of(elements_.base());
  std::vector<int> row_of(elements_.vertex_count(), -1);
  std::copy(lit_vertices.begin(), lit_vertices.end(), row_of.begin());
  for (const int v : vertices) {
    if (row_of[v] >= 0) continue;
    row_of[v] = static_cast<int>(lit_vertices.size());
    lit_vertices.push_back(v);
  }
  const std::vector<int> own = indices_without(shared_.unread, lit_vertices.size());
  std::vector<int> own_vertices;
  for (const int i : own) own_vertices.push_back(lit_vertices[i]);
  BandArray direct = spread_rows(direct_at(light.direct_light, own_vertices, nullptr), own,
                                 static_cast<Eigen::Index>(lit_vertices.size()));
  interpolate_vertices(shared_.unread, direct);
  const BandArray sharpened = sharpened_by_channel(direct, light);

  const std::vector<int> gathered = indices_without(interpolated, vertices.size());
  std::vector<int> at;
  for (const int index : gathered) at.push_back(vertices[index]);
  const BandArray indirect =
      0.5f * (indirect_at(at, 0, sharpened).indirect + indirect_at(at, 1, sharpened).indirect);
  GatheredIrradiance result;
  result.indirect = spread_rows(indirect, gathered, static_cast<Eigen::Index>(vertices.size()));
  interpolate_vertices(interpolated, result.indirect);
  result.direct.resize(result.indirect.rows(), direct.cols());
  for (Eigen::Index i = 0; i < result.direct.rows(); ++i) {
    result.direct.row(i) = direct.row(row_of[vertices[static_cast<std::size_t>(i)]]);
  }
  return result;
}

}  // namespace lightwell
