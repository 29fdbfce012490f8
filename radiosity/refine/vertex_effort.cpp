#include "radiosity/refine/vertex_effort.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "radiosity/refine/effort.h"
#include "radiosity/refine/element_limits.h"
#include "radiosity/refine/error_reference.h"

namespace lightwell {
namespace {

// Vertices at the start above which half the pilot rays serve as well, since predictions average
// the noise of many neighbours. In a hall with some 50 000 vertices the picture stayed within 1.3 %
// of its reference, in the median over its squares.
constexpr int many_vertices = 1 << 15;

// True if refinement cannot make twice as many elements as there are.
bool is_start_large(const RefinedElements& elements, const RefineOptions& refine) {
  constexpr std::int64_t much_room = 2;
  return most_elements(elements, refine) < much_room * elements.element_count();
}

// The noise that a vertex of a `fewness` bears, over that of a typical one.
int noise_multiple(double fewness) {
  return fewness <= 3.0 ? 1 : fewness <= 6.0 ? 2 : fewness <= 12.0 ? 4 : 8;
}

}  // namespace

VertexEffort::VertexEffort(const RefinedElements& elements, const GatherOptions& gather,
                           const RefineOptions& refine, bool has_dome,
                           const std::vector<InterpolatedVertex>& read)
    : elements_(elements),
      parts_(refine.parts),
      efforts_(refine.efforts),
      has_noise_goal_(!refine.efforts.empty() && refine.efforts.front().noise > 0.0),
      few_rays_suffice_(has_noise_goal_ || elements.base().vertex_count() > many_vertices),
      rays_of_part_(static_cast<std::size_t>(parts_.judged_count()), gather.rays),
      fineness_(vertex_fineness(elements.base(), parts_)) {
  const bool is_noisy =
      is_start_large(elements, refine) && !has_noise_goal_ && has_dome && !efforts_.empty();
  has_noisy_sky_.assign(rays_of_part_.size(), is_noisy ? 1 : 0);
  share_pilot_rays(read);
}

int VertexEffort::most_rays() const {
  return *std::ranges::max_element(rays_of_part_);
}

void VertexEffort::choose_rays(const std::vector<double>& noise,
                               const std::vector<InterpolatedVertex>& read) {
  for (std::size_t p = 0; p < rays_of_part_.size(); ++p) {
    rays_of_part_[p] = rays_for_noise(pilot_rays(rays_of_part_[p]), noise[p], efforts_[p].noise);
  }
  share_pilot_rays(read);
}

int VertexEffort::pilot_rays(int rays) const {
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
// the differences that the gathers are made for.
void VertexEffort::share_pilot_rays(const std::vector<InterpolatedVertex>& read) {
  const PatchMesh& mesh = elements_.base();
  constexpr int times_alone = 2;
  std::vector<int> rays;
  for (const int of_part : rays_of_part_) rays.push_back(pilot_rays(of_part));
  rays_ = share_rays(mesh, {}, parts_, rays);
  const std::vector<int> patch = vertex_patches(mesh);
  std::vector<char> shares(static_cast<std::size_t>(mesh.vertex_count()), 0);
  for (const InterpolatedVertex& at : read) shares[at.vertex] = 1;
  const int times_if_shared = times_at_vertices_that_share(read);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const int times = shares[v] != 0 ? times_if_shared : times_alone;
    rays_[v] = std::min(times * rays_[v], rays[parts_.judged_with(patch[v])]);
  }
}

// Rays at vertices that share gathers, over those by area, which are down to an eighth of the pilot
// rays. An eighth may be 4 rays. If one of 4 rays in each of both gathers meets the same bright
// spot far away, such as the top of a column below a lamp, the difference from the records seems to
// be twice the light, and makes a bright stripe. More rays make such a stripe dimmer and rarer.
// Both gathers cast no more than half of the final gather's rays, so that a solve takes little
// longer: leaves, which have most of a scene's vertices, keep the eighth.
int VertexEffort::times_at_vertices_that_share(const std::vector<InterpolatedVertex>& read) const {
  constexpr int most_times = 8;
  std::int64_t of_pilots = 0, of_final = 0;
  for (const InterpolatedVertex& at : read) of_pilots += 2 * std::int64_t{rays_[at.vertex]};
  for (const int rays : share_rays(elements_.base(), read, parts_, rays_of_part_)) of_final += rays;
  int times = 1;
  while (times < most_times && 2 * times * of_pilots <= of_final / 2) times *= 2;
  return times;
}

// The number of the scene's part that a vertex is judged with.
int VertexEffort::part_of(int vertex) const {
  return parts_.judged_with(elements_.base().patch[elements_.inside(vertex, 0.0).element]);
}

// Rays of a part's typical vertices over those of a vertex, or its fineness; 1 or more.
double VertexEffort::fewness(int vertex) const {
  const auto v = static_cast<std::size_t>(vertex);
  const double typical = pilot_rays(rays_of_part_[static_cast<std::size_t>(part_of(vertex))]);
  return std::max({1.0, typical / rays_[v], static_cast<double>(fineness_[v])});
}

NoiseGoal VertexEffort::sky_noise(int vertex) const {
  // Interpolation averages vertices, so that half of the square is left on surfaces.
  constexpr double averaged = 0.7;
  constexpr float least_importance = 1.0f / 64.0f;
  if (efforts_.empty()) return {};
  const int patch = elements_.base().patch[elements_.inside(vertex, 0.0).element];
  const auto part = static_cast<std::size_t>(part_of(vertex));
  const float importance = std::max(parts_.importance_of(patch), least_importance);
  const double times =
      sky_noise_multiple(vertex) * std::sqrt(fewness(vertex) / static_cast<double>(importance));
  NoiseGoal goal =
      noise_goal(efforts_[part].irradiance, averaged * times * efforts_[part].sky_noise);
  // Without an accuracy the goal saves rays, and asks for no more than the options do.
  if (!has_noise_goal_) goal.most_times = 1;
  return goal;
}

// Small elements bear more noise of the sky, and a part's typical ones, on which it would be seen,
// none: vertices at corners of a grid, with a quarter of the area of others, have a fineness of 2.
// Twice, four and eight times the noise begin where a vertex has a ninth, a 36th and a 144th of the
// typical area: a third, a sixth and a twelfth of the edge, so that the multiple times the edge
// stays below that of typical ones.
void VertexEffort::make_room() {
  const int count = elements_.vertex_count();
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
  for (int v = static_cast<int>(sky_noise_multiple_.size()); v < count; ++v) {
    const double few = fewness(v);
    const bool is_noisy = has_noisy_sky_[static_cast<std::size_t>(part_of(v))] != 0;
    sky_noise_multiple_.push_back(static_cast<std::uint8_t>(is_noisy ? noise_multiple(few) : 1));
  }
}

void VertexEffort::shrink_to_fit() {
  rays_.shrink_to_fit();
  fineness_.shrink_to_fit();
  sky_noise_multiple_.shrink_to_fit();
}

std::vector<VertexEffort::Sharpened> VertexEffort::sharpen_sky(const std::vector<double>& left) {
  std::vector<char> is_sharpened(has_noisy_sky_.size(), 0);
  for (std::size_t p = 0; p < left.size(); ++p) {
    constexpr double most = multiples[std::size(multiples) - 1];
    if (has_noisy_sky_[p] == 0 || left[p] > most * efforts_[p].sky_noise) continue;
    has_noisy_sky_[p] = 0;
    is_sharpened[p] = 1;
  }
  std::vector<Sharpened> sharpened;
  for (int v = 0; v < elements_.vertex_count(); ++v) {
    std::uint8_t& multiple = sky_noise_multiple_[static_cast<std::size_t>(v)];
    if (multiple == 1 || is_sharpened[static_cast<std::size_t>(part_of(v))] == 0) continue;
    sharpened.push_back({v, multiple});
    multiple = 1;
  }
  return sharpened;
}

}  // namespace lightwell
