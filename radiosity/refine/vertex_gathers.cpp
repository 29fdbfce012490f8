#include "radiosity/refine/vertex_gathers.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "radiosity/gather/gatherable_radiosity.h"
#include "radiosity/gather/patch_power.h"
#include "radiosity/gather/vertex_points.h"
#include "radiosity/refine/channel_light.h"
#include "radiosity/refine/error_reference.h"
#include "radiosity/refine/gather_noise.h"

namespace lightwell {
namespace {

constexpr std::uint64_t first_pilot_replica = 1000;

// Distance of vertices from their elements' corners, as a share of the way to the centre of an
// element of the deepest level (see VertexGatherPoints).
constexpr double finest_inset = 0.02;

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
      inset_(std::ldexp(finest_inset, -refine.max_level)),
      visibility_(lit.direct_light.light_count()),
      unread_patch_(unread_patches(lit.scene, elements.base())),
      shared_(find_shared_gathers(lit.scene, elements.base())),
      effort_(elements, options, refine, lit.direct_light.dome() != nullptr, shared_.read),
      parts_(refine.parts) {
  if (options.run.progress) {
    options_.run.progress = [progress = options.run.progress](std::string_view, double share) {
      return progress("refine", share);
    };
  }
  sharpen_radiosity(caustic);
  gather_indirect_at(vertices_of(elements.base()));
}

GatherPoint VertexGathers::gather_point(int vertex) const {
  const PatchPoint at = elements_.inside(vertex, inset_);
  const GatherPoint point{at.position, at.normal, elements_.base().facet[at.element]};
  const Eigen::Vector3d position = elements_.position(vertex);
  const double reach = gap_reach(elements_.base(), at.element, position);
  return moved_into_gap(caster_, position, reach, point);
}

// A gather point with random numbers of the vertex's own.
GatherPoint VertexGathers::keyed_point(int vertex) const {
  GatherPoint point = gather_point(vertex);
  point.key = static_cast<std::uint64_t>(vertex);
  point.sky_noise = effort_.sky_noise(vertex);
  return point;
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
  effort_.make_room();
  visibility_.resize(count);
}

void VertexGathers::shrink_to_fit() {
  for (BandArray* values : {&direct_, &first_, &second_}) {
    values->conservativeResize(elements_.vertex_count(), values->cols());
  }
  has_direct_.shrink_to_fit();
  indirect_.shrink_to_fit();
  effort_.shrink_to_fit();
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

// Direct light at vertices, with the rays to the sky that their noise asks for; vertices x columns
// of `light`.
BandArray VertexGathers::direct_at(const DirectLight& light, const std::vector<int>& vertices,
                                   std::vector<EmitterVisibility>* visibilities) const {
  const auto count = static_cast<Eigen::Index>(vertices.size());
  BandArray direct = BandArray::Zero(count, light.channel_count() * scene_.bands.count());
  if (visibilities) visibilities->assign(vertices.size(), {});
  for (const int multiple : VertexEffort::multiples) {
    std::vector<int> rows;
    std::vector<GatherPoint> points;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (effort_.sky_noise_multiple(vertices[i]) != multiple) continue;
      rows.push_back(static_cast<int>(i));
      points.push_back(keyed_point(vertices[i]));
    }
    if (points.empty()) continue;
    GatherOptions options = options_;
    // The least number of rays falls with the goal.
    options.shadows.sky_rays = (options.shadows.sky_rays + multiple - 1) / multiple;
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
  std::vector<int> vertices;
  for (const VertexEffort::Sharpened& at : effort_.sharpen_sky(left)) {
    const int v = at.vertex;
    if (has_direct_[v] == 0) continue;
    const NoiseGoal goal = effort_.sky_noise(v);
    const double enough = std::max(goal.irradiance, goal.share * double{direct_.row(v).mean()});
    if (visibility_[v].drawn_noise > enough) {
      vertices.push_back(v);
    } else {
      effort_.keep_sky_noise(at);
    }
  }
  set_direct(vertices);
  interpolate_vertices(shared_.unread, direct_);
  return !vertices.empty();
}

Eigen::ArrayXf VertexGathers::noisy_sky_variance(const std::vector<int>& vertices) const {
  Eigen::ArrayXf variance = Eigen::ArrayXf::Zero(static_cast<Eigen::Index>(vertices.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (effort_.sky_noise_multiple(vertices[i]) == 1) continue;
    const double noise = visibility_[vertices[i]].drawn_noise;
    variance[static_cast<Eigen::Index>(i)] = static_cast<float>(noise * noise);
  }
  return variance;
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
    point.rays = effort_.rays(v);
  }
  GatherOptions options = options_;
  options.rays = effort_.pilot_rays(options_.rays);
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
      const auto share = static_cast<float>(effort_.rays(at.ends[i])) /
                         static_cast<float>(effort_.rays(at.vertex) * at.end_count());
      all.variance[at.vertex] += share * all.variance[at.ends[i]];
    }
  }
  return all;
}

// Replaces the radiosity of patches, one value each, by what a gather finds at the base's vertices.
// If the noise is limited, that of this gather decides over the rays of the final gather.
void VertexGathers::sharpen_radiosity(const BandArray& caustic) {
  const PatchMesh& mesh = elements_.base();
  make_room();
  gather_direct_at_base();
  GatheredIrradiance gathered = sharpened_indirect(radiosity_);
  BandArray irradiance = direct_.topRows(mesh.vertex_count()) + gathered.indirect;
  if (caustic.size() > 0) irradiance += caustic;
  radiosity_ =
      with_pools(mesh, radiosity_,
                 gatherable_radiosity(lit(), irradiance, direct_.topRows(mesh.vertex_count())));
  if (!effort_.has_noise_goal()) return;
  Eigen::ArrayXf rays(mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) rays[v] = static_cast<float>(effort_.rays(v));
  const Eigen::ArrayXf variance = vertex_variance(mesh, gathered.variance * rays, rays);
  effort_.choose_rays(rms_noises(mesh, gather_noise(mesh, irradiance, variance, parts_), parts_),
                      shared_.read);
  options_.rays = effort_.most_rays();
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
                    gatherable_radiosity({scene_, caster_, light.direct_light}, irradiance,
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
