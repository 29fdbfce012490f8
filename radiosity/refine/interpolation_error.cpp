#include "radiosity/refine/interpolation_error.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "radiosity/gather/patch_power.h"
#include "radiosity/refine/effort.h"
#include "radiosity/refine/gather_noise.h"
#include "radiosity/refine/refine_solution.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"

namespace lightwell {
namespace {

constexpr std::uint64_t first_pilot_replica = 1000;
constexpr int probe_count = 16;
// Of it, what may hide in an indirect light that is taken for even: the product of two gathers has
// none in the mean, and most of what it hides is nothing.
constexpr double share_of_noise = 0.25;

// Vertices lie this far inside the elements of the deepest level (see vertex_gather_points).
constexpr double finest_inset = 0.02;

// A squared difference counts from this multiple of its noise on.
constexpr double beyond_doubt = 2.0;

// Of each of two gathers, for a final one of `rays`. Where that is as exact as is asked for, fewer
// do; else predictions made of them show.
int pilot_rays(int rays, bool has_noise_goal) {
  const int share = has_noise_goal ? 16 : 8;
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(1, rays / share))));
}

// A straight shadow edge crosses at most 2 sqrt(n) of n stratified rays' cells, each of which is
// off by 0.3 in the mean square.
double mixed_shadow_noise(int rays) {
  return 0.3 * std::sqrt(2.0 * std::sqrt(static_cast<double>(rays))) / rays;
}

double mean_square(const Spectrum& difference) {
  return difference.cast<double>().square().mean();
}

}  // namespace

double error_reference(double mean_irradiance, double own_irradiance) {
  constexpr double bright = 4.0;
  return std::max(mean_irradiance, own_irradiance / bright);
}

Eigen::ArrayXd error_references(const PatchMesh& mesh, const BandArray& irradiance) {
  Eigen::ArrayXd own(mesh.element_count());
  double sum = 0.0, area = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int n = mesh.corner_count(e);
    own[e] = 0.0;
    for (int c = 0; c < n; ++c) {
      own[e] += irradiance.row(mesh.corners[e][c]).cast<double>().mean() / n;
    }
    if (!(mesh.reflectance.row(mesh.patch[e]) > 0.0f).any()) continue;
    sum += mesh.element_area[e] * own[e];
    area += mesh.element_area[e];
  }
  const double mean = area > 0.0 ? sum / area : 0.0;
  own = own.unaryExpr([mean](double E) { return error_reference(mean, E); });
  return own;
}

InterpolationError::InterpolationError(const LitScene& lit, const BandArray& radiosity,
                                       const BandArray& caustic, RefinedElements& elements,
                                       const GatherOptions& options, const RefineOptions& refine,
                                       double noise)
    : scene_(lit.scene),
      caster_(lit.caster),
      direct_light_(lit.direct_light),
      radiosity_(radiosity),
      elements_(elements),
      options_(options),
      has_noise_goal_(noise > 0.0),
      inset_(std::ldexp(finest_inset, -refine.max_level)),
      visibility_(lit.direct_light.light_count()),
      probes_(probe_count) {
  if (options.run.progress) {
    options_.run.progress = [progress = options.run.progress](std::string_view, double share) {
      return progress("refine", share);
    };
  }
  set_tolerance(refine.tolerance);
  share_pilot_rays();
  sharpen_radiosity(caustic, noise);
  std::vector<int> all(static_cast<std::size_t>(elements.base().vertex_count()));
  std::iota(all.begin(), all.end(), 0);
  gather_indirect_at(all);
  find_what_matters();
}

void InterpolationError::set_tolerance(double tolerance) {
  constexpr double share = 0.3;  // a tenth of the squared error that is allowed, at worst
  even_ = std::pow(share * tolerance, 2);
}

// Crumbs take fewer, but none so few that noise hides what there is to be seen.
void InterpolationError::share_pilot_rays() {
  const int rays = pilot_rays(options_.rays, has_noise_goal_);
  rays_ = share_rays(elements_.base(), {}, rays);
  for (int& share : rays_) share = std::min(2 * share, rays);
}

GatherPoint InterpolationError::gather_point(int vertex) const {
  const PatchPoint at = elements_.inside(vertex, inset_);
  return {at.position, at.normal, elements_.base().facet[at.element]};
}

void InterpolationError::find_what_matters() {
  const PatchMesh& mesh = elements_.base();
  matters_.assign(mesh.element_count(), 0);
  double sum = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int p = mesh.patch[e];
    const bool is_back = mesh.is_back[p] != 0;
    const int front = is_back && mesh.twin[e] >= 0 ? mesh.twin[e] : e;
    if (!(mesh.reflectance.row(p) > 0.0f).any() || caster_.is_hidden(front, is_back)) continue;
    matters_[e] = 1;
    area_ += mesh.element_area[e];
    double E = 0.0;
    for (int i = 0; i < mesh.corner_count(e); ++i) E += total(mesh.corners[e][i]).mean();
    sum += mesh.element_area[e] * E / mesh.corner_count(e);
  }
  mean_ = area_ > 0.0 ? sum / area_ : 0.0;
}

Spectrum InterpolationError::total(int vertex) const {
  return (direct_.row(vertex) + 0.5f * (first_.row(vertex) + second_.row(vertex))).transpose();
}

// Room for all vertices there are now; as a vector grows.
void InterpolationError::make_room() {
  const int count = elements_.vertex_count();
  if (count > direct_.rows()) {
    const Eigen::Index rows = std::max<Eigen::Index>(count, 2 * direct_.rows());
    for (BandArray* values : {&direct_, &first_, &second_}) {
      values->conservativeResize(rows, scene_.bands.count());
    }
  }
  has_direct_.resize(count, 0);
  indirect_.resize(count, Indirect::unknown);
  // As many as where it lies between: fewer would hide in noise what the next split is about.
  for (int v = static_cast<int>(rays_.size()); v < count; ++v) {
    int most = 0;
    for (const int end : elements_.ends(v)) most = end < 0 ? most : std::max(most, rays_[end]);
    rays_.push_back(most);
  }
  visibility_.resize(count);
  sides_.resize(elements_.side_total());
}

void InterpolationError::shrink_to_fit() {
  for (BandArray* values : {&direct_, &first_, &second_}) {
    values->conservativeResize(elements_.vertex_count(), values->cols());
  }
  has_direct_.shrink_to_fit();
  indirect_.shrink_to_fit();
  rays_.shrink_to_fit();
  visibility_.shrink_to_fit();
  sides_.shrink_to_fit();
}

void InterpolationError::gather_direct_at(const std::vector<int>& vertices) {
  std::vector<int> fresh;
  std::vector<GatherPoint> points;
  for (const int v : vertices) {
    if (has_direct_[v]) continue;
    has_direct_[v] = 1;
    fresh.push_back(v);
    points.push_back(gather_point(v));
    points.back().key = static_cast<std::uint64_t>(v);
  }
  std::vector<EmitterVisibility> visibilities;
  const BandArray direct =
      gather_direct({scene_, caster_, direct_light_}, points, options_, &visibilities);
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    direct_.row(fresh[i]) = direct.row(static_cast<Eigen::Index>(i));
    visibility_.set(fresh[i], visibilities[i]);
  }
  gathers_ += static_cast<std::int64_t>(points.size());
}

GatheredIrradiance InterpolationError::indirect_at(const std::vector<int>& vertices,
                                                   std::uint64_t replica,
                                                   const BandArray& radiosity) const {
  const PatchMesh& mesh = elements_.base();
  std::vector<GatherPoint> points;
  for (const int v : vertices) {
    GatherPoint& point = points.emplace_back(gather_point(v));
    const int patch = mesh.patch[elements_.inside(v, 0.0).element];
    point.key = random_key(static_cast<std::uint64_t>(mesh.surface[patch]),
                           mesh.is_back[patch] != 0 ? 1 : 0);
    point.rays = rays_[static_cast<std::size_t>(v)];
  }
  GatherOptions options = options_;
  options.rays = pilot_rays(options_.rays, has_noise_goal_);
  options.replica = options_.replica + first_pilot_replica + replica;
  return gather_indirect({scene_, caster_, direct_light_}, radiosity, points, options);
}

// With `noise`, it also says what the final gather takes to leave no more of that.
void InterpolationError::sharpen_radiosity(const BandArray& caustic, double noise) {
  const PatchMesh& mesh = elements_.base();
  std::vector<int> all(mesh.vertex_count());
  std::iota(all.begin(), all.end(), 0);
  make_room();
  gather_direct_at(all);
  GatheredIrradiance gathered = indirect_at(all, 2, radiosity_);
  BandArray irradiance = direct_.topRows(mesh.vertex_count()) + gathered.indirect;
  if (caustic.size() > 0) irradiance += caustic;
  radiosity_ = with_pools(mesh, radiosity_, gatherable_radiosity(mesh, direct_light_, irradiance));
  if (!(noise > 0.0)) return;
  const Eigen::ArrayXf rays =
      Eigen::Map<const Eigen::ArrayXi>(rays_.data(), mesh.vertex_count()).cast<float>();
  const double found =
      rms_noise(mesh, gather_noise(mesh, irradiance, gathered.variance * rays, rays));
  options_.rays = rays_for_noise(pilot_rays(options_.rays, has_noise_goal_), found, noise);
  share_pilot_rays();
}

void InterpolationError::gather_indirect_at(const std::vector<int>& vertices) {
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

// Unless it is known already.
void InterpolationError::interpolate_indirect(int vertex) {
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

// Null: of a cell that was made since.
const InterpolationError::CellSide* InterpolationError::known_of(int cell, int side) const {
  const auto number = static_cast<std::size_t>(elements_.side_number(cell, side));
  return number < sides_.size() ? &sides_[number] : nullptr;
}

// Whether corners tell the indirect light in a cell, or in one that it is part of.
bool InterpolationError::is_even(int cell, int side) const {
  for (int c = cell; c >= 0; c = elements_.parent(c)) {
    const CellSide* known = known_of(c, side);
    if (known && known->indirect <= even_) return true;
  }
  return false;
}

bool InterpolationError::is_interpolated(int cell, int side) const {
  return elements_.parent(cell) >= 0 && is_even(elements_.parent(cell), side);
}

bool InterpolationError::is_stale(int cell) const {
  for (int side = 0; side < elements_.side_count(cell); ++side) {
    const CellSide* known = known_of(cell, side);
    if (known && known->was_interpolated && !is_interpolated(cell, side)) return true;
  }
  return false;
}

// Those in the middle of its edges, and in its own.
template <class Visit>
void InterpolationError::for_each_inner_vertex(int cell, int side, Visit&& visit) const {
  const int n = elements_.corner_count(cell);
  for (int i = 0; i < n; ++i) visit(elements_.edge_vertex(cell, side, i));
  if (n == 4) visit(elements_.center_vertex(cell, side));
}

template <class Visit>
void InterpolationError::for_each_vertex(int cell, int side, Visit&& visit) const {
  for (int i = 0; i < elements_.corner_count(cell); ++i) {
    visit(elements_.corner_vertex(cell, side, i));
  }
  for_each_inner_vertex(cell, side, visit);
}

double InterpolationError::direct_range(int cell, int side) const {
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (int i = 0; i < elements_.corner_count(cell); ++i) {
    const double E = direct_.row(elements_.corner_vertex(cell, side, i)).mean();
    low = std::min(low, E);
    high = std::max(high, E);
  }
  return high - low;
}

template <class Visit>
void InterpolationError::for_each_with_ends(const std::vector<int>& vertices, Visit&& visit) const {
  std::vector<int> index(elements_.vertex_count(), -1);
  for (std::size_t i = 0; i < vertices.size(); ++i) index[vertices[i]] = static_cast<int>(i);
  for (int v = 0; v < elements_.vertex_count(); ++v) {
    if (index[v] < 0 || elements_.ends(v)[0] < 0) continue;
    InterpolatedVertex at{.vertex = index[v]};
    bool has_ends = true;
    for (int i = 0; i < 4; ++i) {
      const int end = elements_.ends(v)[i];
      if (end < 0) continue;
      at.ends[i] = index[end];
      has_ends = has_ends && index[end] >= 0;
    }
    if (has_ends) visit(v, at);
  }
}

std::vector<InterpolatedVertex> InterpolationError::interpolated(const std::vector<int>& vertices) {
  // Told is what no cell asks for that was split, and whose indirect light its corners do not tell.
  std::vector<char> is_asked_for(elements_.vertex_count(), 0);
  for (int cell = 0; cell < elements_.cell_count(); ++cell) {
    if (!elements_.is_split(cell)) continue;
    for (int side = 0; side < elements_.side_count(cell); ++side) {
      if (is_even(cell, side)) continue;
      for_each_inner_vertex(cell, side, [&](int v) {
        is_asked_for.resize(elements_.vertex_count(), 0);
        is_asked_for[v] = 1;
      });
    }
  }
  make_room();
  is_asked_for.resize(elements_.vertex_count(), 0);
  std::vector<InterpolatedVertex> interpolated;
  for_each_with_ends(vertices, [&](int v, const InterpolatedVertex& at) {
    if (!is_asked_for[v]) interpolated.push_back(at);
  });
  return interpolated;
}

std::vector<VertexPrediction> InterpolationError::predictions(
    const std::vector<int>& vertices, std::span<const InterpolatedVertex> interpolated) {
  // The worst of what the cells say that a vertex is inside of.
  struct Said {
    float spread = -1.0f, noise = 0.0f;  // spread below 0: none is
  };
  std::vector<Said> said(elements_.vertex_count());
  for (int cell = 0; cell < elements_.cell_count(); ++cell) {
    if (!elements_.is_split(cell)) continue;
    for (int side = 0; side < elements_.side_count(cell); ++side) {
      const CellSide* found = known_of(cell, side);
      const CellSide known = found ? *found : CellSide{};
      const auto unit = static_cast<float>(std::pow(reference(cell, side), 2));
      for_each_inner_vertex(cell, side, [&](int v) {
        if (said.size() <= static_cast<std::size_t>(v)) said.resize(elements_.vertex_count());
        said[v].spread = std::max(said[v].spread, unit * known.indirect);
        said[v].noise = std::max(said[v].noise, unit * known.noise);
      });
    }
  }
  make_room();
  said.resize(elements_.vertex_count());
  std::vector<char> is_interpolated(vertices.size(), 0);
  for (const InterpolatedVertex& t : interpolated) is_interpolated[t.vertex] = 1;
  std::vector<VertexPrediction> predictions;
  predictions.reserve(vertices.size());
  for_each_with_ends(vertices, [&](int v, const InterpolatedVertex& at) {
    VertexPrediction b{.at = at, .is_interpolated = is_interpolated[at.vertex] != 0};
    if (said[v].spread >= 0.0f && indirect_[v] == Indirect::gathered) {
      b.spread = said[v].spread;
      b.noise = said[v].noise;
    }
    predictions.push_back(b);
  });
  return predictions;
}

namespace {

// The places in a list of `count` that are not told by others.
std::vector<int> without(std::span<const InterpolatedVertex> interpolated, std::size_t count) {
  std::vector<char> is_interpolated(count, 0);
  for (const InterpolatedVertex& t : interpolated) is_interpolated[t.vertex] = 1;
  std::vector<int> others;
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_interpolated[i]) others.push_back(static_cast<int>(i));
  }
  return others;
}

}  // namespace

void InterpolationError::gather(const std::vector<int>& vertices,
                                std::span<const InterpolatedVertex> interpolated) {
  make_room();
  gather_direct_at(vertices);
  std::vector<int> others = without(interpolated, vertices.size());
  for (int& index : others) index = vertices[index];
  gather_indirect_at(others);
  for (const int v : vertices) interpolate_indirect(v);
}

GatheredIrradiance InterpolationError::values(const std::vector<int>& vertices) const {
  const auto count = static_cast<Eigen::Index>(vertices.size());
  GatheredIrradiance result{.direct = BandArray(count, scene_.bands.count()),
                            .indirect = BandArray(count, scene_.bands.count())};
  for (Eigen::Index i = 0; i < count; ++i) {
    result.direct.row(i) = direct_.row(vertices[i]);
    result.indirect.row(i) = 0.5f * (first_.row(vertices[i]) + second_.row(vertices[i]));
  }
  return result;
}

GatheredIrradiance InterpolationError::values_by_channel(
    const std::vector<int>& vertices, std::span<const InterpolatedVertex> interpolated,
    const ChannelLight& light) {
  const PatchMesh& mesh = elements_.base();
  std::vector<int> base(mesh.vertex_count());
  std::iota(base.begin(), base.end(), 0);
  std::vector<int> places = base, row_of(elements_.vertex_count(), -1);
  std::copy(base.begin(), base.end(), row_of.begin());
  for (const int v : vertices) {
    if (row_of[v] >= 0) continue;
    row_of[v] = static_cast<int>(places.size());
    places.push_back(v);
  }
  std::vector<GatherPoint> points;
  for (const int v : places) {
    points.push_back(gather_point(v));
    points.back().key = static_cast<std::uint64_t>(v);
  }
  const BandArray direct = gather_direct({scene_, caster_, light.direct_light}, points, options_);
  BandArray irradiance =
      direct.topRows(mesh.vertex_count()) + indirect_at(base, 2, light.radiosity).indirect;
  if (light.caustic.size() > 0) irradiance += light.caustic;
  const BandArray sharpened =
      with_pools(mesh, light.radiosity, gatherable_radiosity(mesh, light.direct_light, irradiance));

  const std::vector<int> gathered = without(interpolated, vertices.size());
  std::vector<int> at;
  for (const int index : gathered) at.push_back(vertices[index]);
  const BandArray indirect =
      0.5f * (indirect_at(at, 0, sharpened).indirect + indirect_at(at, 1, sharpened).indirect);
  GatheredIrradiance result;
  result.indirect.resize(static_cast<Eigen::Index>(vertices.size()), indirect.cols());
  for (std::size_t i = 0; i < at.size(); ++i) {
    result.indirect.row(gathered[i]) = indirect.row(static_cast<Eigen::Index>(i));
  }
  interpolate_vertices(interpolated, result.indirect);
  result.direct.resize(result.indirect.rows(), direct.cols());
  for (Eigen::Index i = 0; i < result.direct.rows(); ++i) {
    result.direct.row(i) = direct.row(row_of[vertices[static_cast<std::size_t>(i)]]);
  }
  return result;
}

double InterpolationError::expected(int cell, int side) const {
  if (!matters(elements_.element(cell, side)) || !(mean_ > 0.0)) return 0.0;
  Spectrum low = total(elements_.corner_vertex(cell, side, 0)), high = low;
  for (int i = 1; i < elements_.corner_count(cell); ++i) {
    const Spectrum E = total(elements_.corner_vertex(cell, side, i));
    low = low.min(E);
    high = high.max(E);
  }
  constexpr double unseen = 0.05;
  return mean_square(high - low) / std::pow(reference(cell, side), 2) + std::pow(unseen, 2);
}

// W/m^2 that differences are relative to.
double InterpolationError::reference(int cell, int side) const {
  double sum = 0.0;
  for (int i = 0; i < elements_.corner_count(cell); ++i) {
    sum += total(elements_.corner_vertex(cell, side, i)).mean();
  }
  return error_reference(mean_, sum / elements_.corner_count(cell));
}

namespace {

// Weighted sums of the squares of differences between gathered and interpolated irradiance.
struct Differences {
  double direct = 0.0, both = 0.0;  // the latter without the noise of the indirect light
  double indirect = 0.0, noise = 0.0;

  void add(double weight, const Spectrum& of_direct, const Spectrum& first,
           const Spectrum& second) {
    const Eigen::ArrayXd d = of_direct.cast<double>(), a = first.cast<double>(),
                         b = second.cast<double>();
    // The noise of two gathers is independent: it is not in the mean of their product.
    const double product = (a * b).mean();
    direct += weight * d.square().mean();
    indirect += weight * product;
    both += weight * (d.square().mean() + (d * (a + b)).mean() + product);
    noise += weight * 0.25 * (a - b).square().mean();
  }
};

}  // namespace

// Simpson's rule in both directions: 16/36 in the centre, 4/36 at each edge, nothing at the
// corners, where interpolation is exact. In triangles a third at each edge.
InterpolationError::Squares InterpolationError::lattice_error(int cell, int side) {
  const int n = elements_.corner_count(cell);
  const double at_edge = n == 4 ? 4.0 / 36.0 : 1.0 / 3.0, at_center = 16.0 / 36.0;
  Differences differences;
  double shadow_noise = 0.0;
  const double of_one = mixed_shadow_noise(options_.shadows.max_rays);
  const auto add_shadow_noise = [&](int v, double weight) {
    shadow_noise += weight * std::pow(of_one * visibility_[v].noisy, 2);
  };
  Spectrum direct = Spectrum::Zero(scene_.bands.count()), first = direct, second = direct;
  for (int i = 0; i < n; ++i) {
    const int a = elements_.corner_vertex(cell, side, i);
    const int b = elements_.corner_vertex(cell, side, (i + 1) % n);
    const int v = elements_.edge_vertex(cell, side, i);
    const auto off = [&](const BandArray& values) -> Spectrum {
      return (values.row(v) - 0.5f * (values.row(a) + values.row(b))).transpose();
    };
    differences.add(at_edge, off(direct_), off(first_), off(second_));
    add_shadow_noise(v, at_edge);
    // Each corner's share in the two edges and in the centre, squared.
    add_shadow_noise(a, 2 * at_edge * 0.25 + (n == 4 ? at_center / 16.0 : 0.0));
    direct += direct_.row(a).transpose() / static_cast<float>(n);
    first += first_.row(a).transpose() / static_cast<float>(n);
    second += second_.row(a).transpose() / static_cast<float>(n);
  }
  if (n == 4) {
    const int v = elements_.center_vertex(cell, side);
    differences.add(at_center, direct_.row(v).transpose() - direct,
                    first_.row(v).transpose() - first, second_.row(v).transpose() - second);
    add_shadow_noise(v, at_center);
  }
  // Of two independent gathers alone, the product over a cell would be off by about the noise.
  const bool indirect_counts = differences.indirect > beyond_doubt * differences.noise;
  const double error = indirect_counts ? differences.both : differences.direct;
  const bool shadow_counts = error > beyond_doubt * shadow_noise;
  return {.error = shadow_counts ? error - shadow_noise : 0.0,
          .hidden = (indirect_counts ? 0.0 : differences.noise) +
                    (shadow_counts ? 0.0 : std::clamp(error, 0.0, shadow_noise)),
          .direct = differences.direct,
          .shadow_noise = shadow_noise,
          .indirect = std::max(differences.indirect, 0.0) + share_of_noise * differences.noise,
          .noise = differences.noise};
}

bool InterpolationError::has_edge(int cell, int side) const {
  EmitterVisibility some, all{.whole = ~std::uint64_t{0}, .hidden = ~std::uint64_t{0}};
  for_each_vertex(cell, side, [&](int v) {
    const EmitterVisibility visibility = visibility_[v];
    some.whole |= visibility.whole;
    some.hidden |= visibility.hidden;
    all.whole &= visibility.whole;
    all.hidden &= visibility.hidden;
  });
  return some.whole != all.whole || some.hidden != all.hidden;
}

InterpolationError::CellPoint InterpolationError::point_in(int cell, int side, double u,
                                                           double v) const {
  const int n = elements_.corner_count(cell);
  Eigen::Vector4d weights;
  if (n == 4) {
    weights = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
  } else {
    weights << triangle_point(u, v), 0.0;
  }
  CellPoint found{.direct = Spectrum::Zero(scene_.bands.count())};
  for (int i = 0; i < n; ++i) {
    const int corner = elements_.corner_vertex(cell, side, i);
    found.position += weights[i] * elements_.position(corner);
    found.direct += static_cast<float>(weights[i]) * direct_.row(corner).transpose();
  }
  return found;
}

// In the middles of the four parts.
double InterpolationError::parts_error(int cell, int side) const {
  const int element = elements_.element(cell, side);
  const int facet = elements_.base().facet[element];
  const Eigen::Vector3d normal = element_center(elements_.base(), element).normal;
  const std::uint64_t key =
      random_key(static_cast<std::uint64_t>(2 * cell + side), RandomPurpose::refinement_quarters);
  double error = 0.0;
  for (int k = 0; k < 4; ++k) {
    const CellPoint at = point_in(cell, side, k % 2 == 0 ? 0.25 : 0.75, k < 2 ? 0.25 : 0.75);
    const Spectrum E =
        direct_light_.irradiance(caster_, {.at = {at.position, normal, facet},
                                           .key = random_key(key, static_cast<std::uint64_t>(k)),
                                           .shadows = options_.shadows});
    error += mean_square(E - at.direct) / 4.0;
  }
  return error;
}

double InterpolationError::probed_error(int cell, int side) const {
  const int element = elements_.element(cell, side);
  std::uint64_t whole = ~std::uint64_t{0}, hidden = whole;
  for_each_vertex(cell, side, [&](int v) {
    const EmitterVisibility visibility = visibility_[v];
    whole &= visibility.whole;
    hidden &= visibility.hidden;
  });
  const int facet = elements_.base().facet[element];
  const Eigen::Vector3d normal = element_center(elements_.base(), element).normal;
  const std::uint64_t key =
      random_key(static_cast<std::uint64_t>(2 * cell + side), RandomPurpose::refinement_probes);
  double error = 0.0;
  const std::size_t lights =
      std::min<std::size_t>(static_cast<std::size_t>(direct_light_.light_count()), 64);
  for (std::size_t e = 0; e < lights; ++e) {
    const bool all_see = (whole >> e & 1U) != 0;
    if (!all_see && (hidden >> e & 1U) == 0) continue;
    for (int k = 0; k < probe_count; ++k) {
      const Eigen::Array4f u = probes_.point(k, random_key(key, e));
      const CellPoint at = point_in(cell, side, u[0], u[1]);
      const auto sees = direct_light_.sees(static_cast<int>(e), caster_,
                                           {at.position, normal, facet}, u[2], u[3]);
      if (!sees || *sees == all_see) continue;
      const Spectrum E = direct_light_.irradiance(
          caster_, {.at = {at.position, normal, facet},
                    .key = random_key(key, e, static_cast<std::uint64_t>(k)),
                    .shadows = options_.shadows});
      error += mean_square(E - at.direct) / probe_count;
    }
  }
  return error;
}

std::vector<InterpolationError::Measured> InterpolationError::measure(
    const std::vector<int>& cells) {
  std::vector<int> vertices, to_gather, to_interpolate;
  for (const int cell : cells) {
    for (int side = 0; side < elements_.side_count(cell); ++side) {
      if (!matters(elements_.element(cell, side))) continue;
      const std::size_t first = vertices.size();
      for (int i = 0; i < elements_.corner_count(cell); ++i) {
        vertices.push_back(elements_.corner_vertex(cell, side, i));
      }
      for_each_inner_vertex(cell, side, [&](int v) { vertices.push_back(v); });
      std::vector<int>& indirect = is_interpolated(cell, side) ? to_interpolate : to_gather;
      indirect.insert(indirect.end(), vertices.begin() + static_cast<std::ptrdiff_t>(first),
                      vertices.end());
    }
  }
  make_room();
  gather_direct_at(vertices);
  gather_indirect_at(to_gather);
  for (const int v : to_interpolate) interpolate_indirect(v);
  const int count = static_cast<int>(cells.size());
  std::vector<Measured> measured(cells.size());
  constexpr int slice = 4096;  // cells between two looks at the stop request
  for (int begin = 0; begin < count; begin += slice) {
    report(options_.run.progress, "refine", static_cast<double>(begin) / count);
    parallel_for(std::min(slice, count - begin), 16, [&](int low, int high) {
      for (int i = begin + low; i < begin + high; ++i) {
        for (int side = 0; side < elements_.side_count(cells[i]); ++side) {
          measure(cells[i], side, measured[i]);
        }
      }
    });
  }
  return measured;
}

void InterpolationError::measure(int cell, int side, Measured& measured) {
  if (!matters(elements_.element(cell, side))) return;
  const double E = reference(cell, side);
  if (!(E > 0.0)) return;
  CellSide& known = sides_[elements_.side_number(cell, side)];
  known.was_interpolated = is_interpolated(cell, side);
  const Squares lattice = lattice_error(cell, side);
  if (known.probed < 0.0f) {
    double probed = probed_error(cell, side);
    // Where the edge of a shadow runs through the very middle, that is what the corners tell there.
    // One that passes it by an eighth of its penumbra is off by an eighth of the range in the
    // centre and in the middles of the two edges it crosses: 0.1 in the mean square.
    constexpr double by_chance = 0.1;
    const double range = direct_range(cell, side);
    if (lattice.direct < std::pow(by_chance * range, 2) && has_edge(cell, side)) {
      const double of_parts = parts_error(cell, side);
      if (of_parts > beyond_doubt * lattice.shadow_noise) probed += of_parts - lattice.shadow_noise;
    }
    known.probed = static_cast<float>(probed / (E * E));
  }
  measured.error[side] = lattice.error / (E * E) + known.probed;
  measured.hidden[side] = lattice.hidden / (E * E);
  if (known.was_interpolated) return;
  known.indirect = static_cast<float>(lattice.indirect / (E * E));
  known.noise = static_cast<float>(lattice.noise / (E * E));
}

}  // namespace lightwell
