#include "radiosity/form_factors/ray_cast_rows.h"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <mutex>
#include <numbers>

#include "mesh/patches/patch_sampler.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr std::size_t row_batch = 64;

// Rows of more rays consist of several sets.
constexpr int longest_set = 1 << 16;

int set_size(int most_rays) {
  const auto wanted = static_cast<unsigned>(std::max(most_rays, 1));
  return std::min(static_cast<int>(std::bit_ceil(wanted)), longest_set);
}

// Rays from one patch.
class PatchRays {
 public:
  PatchRays(const PatchMesh& mesh, int patch)
      : mesh_(mesh), first_element_(mesh.first_element[patch]), sampler_(mesh, patch) {}

  const HemisphereSets::Draw& draw() const { return draw_; }
  void use(const HemisphereSets::Draw& draw) {
    draw_ = draw;
    if (sampler_.is_flat()) frame_ = draw.frame(sampler_.point(0.5, 0.5).normal);
  }
  // Rays of `points` in the block that begins at `first`.
  void aim(int first, std::span<const HemispherePoint> points, std::span<Ray> rays) {
    for (std::size_t r = 0; r < points.size(); ++r) {
      const HemispherePoint& point = points[r];
      const Eigen::Vector2d on_patch = draw_.planar_point(first, point);
      int element = first_element_;
      if (sampler_.is_flat()) {
        rays[r].origin = sampler_.position(on_patch.x(), on_patch.y());
      } else {
        const PatchPoint from = sampler_.point(on_patch.x(), on_patch.y());
        frame_ = draw_.frame(from.normal);
        rays[r].origin = from.position;
        element = from.element;
      }
      rays[r].origin_group = mesh_.facet[element];
      rays[r].direction = frame_ * Eigen::Vector3d(point.x, point.y, point.z);
    }
  }

 private:
  const PatchMesh& mesh_;
  int first_element_;
  PatchSampler sampler_;
  HemisphereSets::Draw draw_;
  Eigen::Matrix3d frame_ = Eigen::Matrix3d::Identity();
};

}  // namespace

RowCaster::Scratch::Scratch(const PatchMesh& mesh)
    : first_(static_cast<std::size_t>(mesh.patch_count())), hidden_(first_) {}

// Moves the counts, as shares of `rays`, into the row, and clears the counters.
void RowCaster::Scratch::take(int rays, bool with_hidden, EstimatedRow& row) {
  row.shares.reserve(first_.size());
  auto next = by_portal_.begin();
  const auto add = [&](int patch, float share) {
    row.shares.push_back({patch, share});
    if (with_hidden) row.hidden.push_back(hidden_.count(patch));
  };
  const auto share_by_portal = [&] { return static_cast<float>((next++)->second / rays); };
  first_.take([&](int patch, int count) {
    while (next != by_portal_.end() && next->first < patch) {
      const int other = next->first;
      add(other, share_by_portal());
    }
    float share = static_cast<float>(count) / static_cast<float>(rays);
    if (next != by_portal_.end() && next->first == patch) share += share_by_portal();
    add(patch, share);
  });
  while (next != by_portal_.end()) {
    const int other = next->first;
    add(other, share_by_portal());
  }
  by_portal_.clear();
  if (with_hidden) hidden_.take([](int, int) {});
}

RowCaster::RowCaster(const ElementCaster& caster, const LightPaths& paths, int most_rays,
                     const Portals* portals)
    : caster_(caster),
      paths_(paths),
      sets_(set_size(most_rays), true),
      portals_(portals),
      aims_(portals ? Portals::aimed(most_rays) : 1) {}

EstimatedRow RowCaster::cast(int patch, int rays, Scratch& scratch, bool behind) const {
  const PatchMesh& mesh = caster_.mesh();
  if (!paths_.is_diffuse(mesh.facet[mesh.first_element[patch]]) || rays <= 0) return {};
  const int bands = static_cast<int>(mesh.reflectance.cols());
  EstimatedRow row{.inverse_variance = rays / mesh.area[patch],
                   .specular_escaped = Spectrum::Zero(bands),
                   .absorbed = Spectrum::Zero(bands),
                   .cut = Spectrum::Zero(bands),
                   .rays = static_cast<double>(rays)};
  Row to{.row = row, .absorbed = Spectrum::Zero(bands)};
  const std::uint64_t key =
      random_key(static_cast<std::uint64_t>(patch), RandomPurpose::form_factor_rays);
  PatchRays from(mesh, patch);
  Portals::View view;
  if (portals_) {
    const PatchPoint middle = PatchSampler(mesh, patch).point(0.5, 0.5);
    view = portals_->view_both_ways(middle.position, middle.normal, rays);
  }
  std::array<Ray, row_batch> ray;
  std::array<ElementHit, row_batch> hit;
  for (int begin = 0; begin < rays; begin += HemisphereSets::block) {
    const int in_set = begin % sets_.count();
    if (in_set == 0) from.use(sets_.draw(random_key(key, static_cast<std::uint64_t>(begin))));
    const int size = std::min({HemisphereSets::block, rays - begin, sets_.count() - in_set});
    const auto points = from.draw().points(in_set, size, scratch.points_);
    for (std::size_t first = 0; first < points.size(); first += row_batch) {
      const std::size_t n = std::min<std::size_t>(row_batch, points.size() - first);
      from.aim(in_set, points.subspan(first, n), ray);
      caster_.closest_elements({ray.data(), n}, {hit.data(), n});
      for (std::size_t r = 0; r < n; ++r) {
        const ElementHit& h = hit[r];
        const double aimed = view.is_empty() ? 0.0 : density(view, ray[r], h);
        double weight = 1.0;
        if (aimed > 0.0) {
          const double by_cosine =
              rays * static_cast<double>(points[first + r].z) * std::numbers::inv_pi;
          weight = by_cosine / (by_cosine + Portals::aimed(rays) * aimed);
        }
        const bool is_dimmed = dim(ray[r], h, weight, to);
        if (!is_dimmed && aimed > 0.0) {
          add_weight(h, weight, scratch, row);
        } else if (!is_dimmed) {
          count(h, scratch, row);
        }
        if (is_specular(h)) {
          const std::uint64_t index = static_cast<std::uint64_t>(begin) + first + r;
          pass_on(ray[r], h, random_key(key, RandomPurpose::form_factor_paths, index), to);
        }
      }
      if (behind) count_hidden({ray.data(), n}, {hit.data(), n}, scratch);
    }
  }
  if (!view.is_empty()) aim_at_portals(patch, rays, view, scratch, to);
  scratch.take(rays, behind, row);
  to.take(rays);
  return row;
}

// Moves the sums, as shares of `rays`, into the row.
void RowCaster::Row::take(int rays) {
  if (dimmed > 0.0) take_dimmed(rays);
  const Eigen::Index bands = row.absorbed.size();
  row.specular_share.resize(static_cast<Eigen::Index>(by_way_of_specular.size()), bands);
  const auto all = static_cast<float>(rays);
  for (const auto& [to, weight] : by_way_of_specular) {
    row.specular_share.row(static_cast<Eigen::Index>(row.specular_patch.size())) =
        weight.transpose() / all;
    row.specular_patch.push_back(to);
  }
  row.specular_escaped /= all;
  row.absorbed /= all;
  row.cut /= all;
  row.escaped /= rays;
  row.specular /= rays;
}

// Adds dimmed rays to the light by way of mirrors and glass. The weights of rays aimed at openings
// add up to 1 in the mean alone, and no row of form factors closes this light later.
void RowCaster::Row::take_dimmed(int rays) {
  double others = row.escaped;
  for (const FormFactor& f : row.shares) others += rays * static_cast<double>(f.value);
  const double scale = (rays - row.specular) / (others + dimmed);
  row.specular += scale * dimmed;
  row.absorbed += static_cast<float>(scale) * absorbed;
  for (const auto& [to, share] : of_dimmed) {
    arrive(to, static_cast<float>(scale) * share, by_way_of_specular);
  }
}

void RowCaster::arrive(int patch, const Spectrum& share, Arrivals& arrivals) {
  auto [at, is_new] = arrivals.try_emplace(patch, share);
  if (!is_new) at->second += share;
}

bool RowCaster::is_specular(const ElementHit& hit) const {
  return paths_.has_specular() && hit.facet >= 0 && paths_.is_specular(hit.facet);
}

// Counts what a ray meets first; a mirror or glass may also scatter a share diffusely.
void RowCaster::count(const ElementHit& hit, Scratch& scratch, EstimatedRow& row) const {
  const bool is_clear = is_specular(hit) && !(paths_.is_diffuse(hit.facet) && hit.element >= 0);
  if (is_clear) {
    ++row.specular;
  } else if (hit.element >= 0) {
    scratch.first_.add(caster_.mesh().patch[hit.element]);
  } else {
    ++row.escaped;
  }
}

// Counts a ray that an absorbing body dims on its way to a diffuse surface; false: none does. The
// base of a coat gets its share, and pass_on() follows what the coat mirrors.
bool RowCaster::dim(const Ray& ray, const ElementHit& hit, double weight, Row& to) const {
  if (hit.element < 0 || !paths_.is_diffuse(hit.facet)) return false;
  const Spectrum left = paths_.left_by_body(ray, hit);
  if (left.size() == 0) return false;
  const auto share = static_cast<float>(weight);
  to.dimmed += weight;
  arrive(caster_.mesh().patch[hit.element],
         share * static_cast<float>(paths_.base_factor(ray, hit)) * left, to.of_dimmed);
  if (!is_specular(hit)) to.absorbed += share * (1.0f - left);
  return true;
}

// Density of aimed rays, 1/sr, of a ray that passes a portal and does not meet a mirror or glass.
double RowCaster::density(const Portals::View& view, const Ray& ray, const ElementHit& hit) const {
  if (hit.facet >= 0 && !paths_.is_mostly_diffuse(hit.facet)) return 0.0;
  return portals_->density(view, ray.origin, ray.direction, hit.t);
}

void RowCaster::add_weight(const ElementHit& hit, double weight, Scratch& scratch,
                           EstimatedRow& row) const {
  if (hit.element >= 0) {
    scratch.by_portal_[caster_.mesh().patch[hit.element]] += weight;
  } else {
    row.escaped += weight;
  }
}

void RowCaster::aim_at_portals(int patch, int rays, const Portals::View& view, Scratch& scratch,
                               Row& to) const {
  const PatchMesh& mesh = caster_.mesh();
  const PatchSampler sampler(mesh, patch);
  const std::uint64_t key =
      random_key(static_cast<std::uint64_t>(patch), RandomPurpose::form_factor_aims);
  const int count = std::min(Portals::aimed(rays), aims_.count());
  for (int i = 0; i < count; ++i) {
    const Eigen::Array4d u = aims_.point(i, key).cast<double>();
    const PatchPoint from = sampler.point(u[0], u[1]);
    const Portals::Aim aim =
        portals_->draw(view, from.position, SobolPoints::fifth(i, key), u[2], u[3]);
    const Ray ray{.origin = from.position,
                  .direction = aim.direction,
                  .origin_group = mesh.facet[from.element]};
    const double cosine = ray.direction.dot(from.normal);
    if (!(cosine > 0.0)) continue;
    ElementHit hit;
    caster_.closest_elements({&ray, 1}, {&hit, 1});
    const double aimed = density(view, ray, hit);
    if (!(aimed > 0.0) || !portals_->passes(aim, from.position, hit.t)) continue;
    const double by_cosine = rays * cosine * std::numbers::inv_pi;
    const double weight = by_cosine / (by_cosine + count * aimed);
    if (!dim(ray, hit, weight, to)) add_weight(hit, weight, scratch, to.row);
  }
}

// Follows a ray that met a mirror, a coat or glass.
void RowCaster::pass_on(const Ray& ray, const ElementHit& hit, std::uint64_t branch,
                        Row& to) const {
  const PatchMesh& mesh = caster_.mesh();
  const PathLosses losses =
      paths_.follow(ray, hit, branch, [&](const ElementHit& end, const Spectrum& throughput) {
        arrive(mesh.patch[end.element], throughput, to.by_way_of_specular);
      });
  to.row.specular_escaped += losses.escaped;
  to.row.absorbed += losses.absorbed;
  to.row.cut += losses.cut;
}

// Continues the rays through all surfaces they meet, until they leave the scene.
void RowCaster::count_hidden(std::span<Ray> rays, std::span<ElementHit> hits,
                             Scratch& scratch) const {
  constexpr int most_layers = 256;
  const PatchMesh& mesh = caster_.mesh();
  std::size_t left = rays.size();
  for (int layer = 0; layer < most_layers && left > 0; ++layer) {
    std::size_t going_on = 0;
    for (std::size_t r = 0; r < left; ++r) {
      const ElementHit& hit = hits[r];
      if (hit.facet < 0) continue;
      if (layer > 0 && hit.element >= 0) scratch.hidden_.add(mesh.patch[hit.element]);
      rays[going_on++] = {.origin = rays[r].origin + hit.t * rays[r].direction,
                          .direction = rays[r].direction,
                          .origin_group = hit.facet};
    }
    left = going_on;
    caster_.closest_elements(rays.first(left), hits.first(left));
  }
}

void for_each_row(const PatchMesh& mesh, const RowLoop& loop,
                  const std::function<void(int, RowCaster::Scratch&)>& work) {
  const int patches = mesh.patch_count();
  // Progress and interruption are handled between slices, on this thread; each takes a fraction of
  // a second. Threads wait for each other at the end of a slice, so slices should be few.
  constexpr int rays_per_slice = 1 << 21;
  const int of_process = std::max(2, rays_per_slice / std::max(loop.rays_per_patch, 1));
  const int grain = std::clamp(of_process / 16, 1, 16);
  const int slice = of_process * loop.phase.processes();
  // Scratch memory is proportional to the mesh, so it is reused.
  std::mutex mutex;
  std::vector<std::unique_ptr<RowCaster::Scratch>> idle;
  const auto borrow = [&] {
    const std::lock_guard lock(mutex);
    if (idle.empty()) return std::make_unique<RowCaster::Scratch>(mesh);
    auto scratch = std::move(idle.back());
    idle.pop_back();
    return scratch;
  };
  for (int begin = 0; begin < patches; begin += slice) {
    const auto report_progress = [&] {
      report(loop.progress, "form factors", static_cast<double>(begin) / patches);
    };
    report_progress();
    const auto cast = [&](int low, int high) {
      auto scratch = borrow();
      for (int i = begin + low; i < begin + high; ++i) work(i, *scratch);
      const std::lock_guard lock(mutex);
      idle.push_back(std::move(scratch));
    };
    loop.phase.for_each({begin, std::min(slice, patches - begin), grain}, cast, report_progress);
  }
  report(loop.progress, "form factors", 1.0);
}

std::vector<EstimatedRow> cast_rows(const ElementCaster& caster, const LightPaths& paths,
                                    const std::vector<int>& rays_of, const Progress& progress) {
  const PatchMesh& mesh = caster.mesh();
  const int most_rays = *std::max_element(rays_of.begin(), rays_of.end());
  const RowCaster row_caster(caster, paths, most_rays);
  std::vector<EstimatedRow> rows(static_cast<std::size_t>(mesh.patch_count()));
  const JournalPhase alone;
  for_each_row(mesh, {most_rays, progress, alone}, [&](int i, RowCaster::Scratch& scratch) {
    rows[i] = row_caster.cast(i, rays_of[i], scratch);
  });
  return rows;
}

}  // namespace lightwell
