#include "radiosity/radiation/dome_views.h"

#include <algorithm>
#include <array>
#include <functional>
#include <numbers>
#include <vector>

#include "mesh/patches/patch_sampler.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

using std::numbers::pi;

constexpr int first_dome_rays = 1024, rays_of_a_facet = 4096, dome_rays_of_a_point = 16384;
constexpr std::size_t dome_batch = 64;

// Draws a ray by four numbers in [0, 1).
using DrawRay = std::function<Ray(const Eigen::Array4f&)>;

// Rays towards each patch of the dome, and those of them that nothing stops.
class DomeCounts {
 public:
  explicit DomeCounts(const SkyPatches& sky)
      : sky_(sky), cast_(Eigen::ArrayXd::Zero(sky.dome_count())), open_(cast_) {}

  // Casts `most` rays, or the first of them alone if those above the horizon are all open or all
  // stopped.
  void cast(const ElementCaster& caster, const SobolPoints& sobol, std::uint64_t key, int most,
            const DrawRay& draw) {
    std::array<Ray, dome_batch> rays;
    std::array<std::uint8_t, dome_batch> blocked{};
    int wanted = std::min(first_dome_rays, most);
    for (; count_ < wanted; count_ += static_cast<int>(dome_batch)) {
      for (std::size_t r = 0; r < dome_batch; ++r) {
        rays[r] = draw(sobol.point(count_ + static_cast<int>(r), key));
      }
      caster.occluded(rays, blocked);
      for (std::size_t r = 0; r < dome_batch; ++r) {
        const int cell = sky_.cell_of(rays[r].direction);
        if (cell >= sky_.dome_count()) continue;
        cast_[cell] += 1.0;
        open_[cell] += blocked[r] == 0 ? 1.0 : 0.0;
      }
      const bool is_mixed = open_.sum() > 0.0 && open_.sum() < cast_.sum();
      if (is_mixed) wanted = most;
    }
  }

  // Views of a plane with this normal: each patch of an open dome times its open share.
  Eigen::ArrayXd views(const Eigen::Vector3d& normal) const {
    const double all = cast_.sum() > 0.0 ? open_.sum() / cast_.sum() : 0.0;
    const Eigen::ArrayXd share = (cast_ > 0.0).select(open_ / cast_.max(1.0), all);
    return sky_.irradiances(normal).head(sky_.dome_count()) / pi * share;
  }
  // Views of a curved facet, by the rays alone.
  Eigen::ArrayXd views() const { return open_ / count_; }

 private:
  const SkyPatches& sky_;
  int count_ = 0;
  Eigen::ArrayXd cast_, open_;
};

Eigen::ArrayXd views_of_patch(const PatchMesh& mesh, const ElementCaster& caster,
                              const SobolPoints& sobol, const SkyPatches& sky, int patch) {
  const PatchSampler sampler(mesh, patch);
  const auto key = random_key(static_cast<std::uint64_t>(patch), RandomPurpose::sky_view_rays);
  DomeCounts counts(sky);
  counts.cast(caster, sobol, key, rays_of_a_facet, [&](const Eigen::Array4f& u) {
    return cosine_ray(mesh, sampler.point(double{u[0]}, double{u[1]}), u[2], u[3]);
  });
  return sampler.is_flat() ? counts.views(sampler.point(0.5, 0.5).normal) : counts.views();
}

// Scales a line of views to a sky view factor.
void set_line(const Eigen::ArrayXd& views, double sky_view, Eigen::Index line, DomeViews& all) {
  const double sum = views.sum();
  const double factor = sum > 0.0 ? sky_view / sum : 0.0;
  all.row(line) = (views * factor).matrix().transpose().cast<float>();
}

// Calls `line` for all lines, in parallel blocks.
void for_lines(int count, int block, const Progress& progress,
               const std::function<void(int line)>& line) {
  for (int first = 0; first < count; first += block) {
    report(progress, "dome", static_cast<double>(first) / count);
    parallel_for(std::min(block, count - first), 1, [&](int begin, int end) {
      for (int i = first + begin; i < first + end; ++i) line(i);
    });
  }
}

}  // namespace

DomeViews dome_views(const FacetViewFactors& found, const ElementCaster& caster,
                     const SkyPatches& sky, const Eigen::ArrayXd& sky_view,
                     const Progress& progress) {
  const SobolPoints sobol(rays_of_a_facet);
  std::vector<std::vector<int>> patches(static_cast<std::size_t>(found.rows.count()));
  for (int p = 0; p < found.mesh.patch_count(); ++p) {
    const int row = found.rows.of_patch[static_cast<std::size_t>(p)];
    if (row >= 0) patches[static_cast<std::size_t>(row)].push_back(p);
  }
  DomeViews views = DomeViews::Zero(found.rows.count(), sky.dome_count());
  constexpr int block = 512;  // rows between two reports
  for_lines(found.rows.count(), block, progress, [&](int row) {
    if (!(sky_view[row] > 0.0)) return;
    Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(sky.dome_count());
    for (const int p : patches[static_cast<std::size_t>(row)]) {
      sum += found.mesh.area[p] * views_of_patch(found.mesh, caster, sobol, sky, p);
    }
    set_line(sum, sky_view[row], row, views);
  });
  return views;
}

DomeViews point_dome_views(const ElementCaster& caster, std::span<const SurfacePoint> points,
                           const SkyPatches& sky, const Eigen::ArrayXd& sky_view,
                           const Progress& progress) {
  const SobolPoints sobol(dome_rays_of_a_point);
  const int count = static_cast<int>(points.size());
  DomeViews views = DomeViews::Zero(count, sky.dome_count());
  constexpr int block = 64;  // points between two reports
  for_lines(count, block, progress, [&](int i) {
    const SurfacePoint& point = points[static_cast<std::size_t>(i)];
    Eigen::Vector3d a, b;
    tangent_frame(point.normal, a, b);
    DomeCounts counts(sky);
    const auto key = random_key(static_cast<std::uint64_t>(i), RandomPurpose::sky_point_rays);
    counts.cast(caster, sobol, key, dome_rays_of_a_point, [&](const Eigen::Array4f& u) {
      const Eigen::Vector3d d = cosine_direction(u[0], u[1]);
      return Ray{.origin = point.position,
                 .direction = d.x() * a + d.y() * b + d.z() * point.normal,
                 .origin_group = point.facet};
    });
    set_line(counts.views(point.normal), sky_view[i], i, views);
  });
  return views;
}

}  // namespace lightwell
