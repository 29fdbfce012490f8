// Speed of the two passes, beside plain Embree with the same rays in the same process.
//
//   lightwell_bench [SCENE.toml]     default: the diffuse Cornell box
//
// Prints: raw incoherent Embree rays per second; form-factor rays per second and the ratio; seconds
// for the default solve and the 512 x 512 second pass; peak memory.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "bench/raw_embree.h"
#include "bench/stopwatch.h"
#include "mesh/build_patches.h"
#include "mesh/patches/patch_sampler.h"
#include "radiosity/form_factors/ray_cast_rows.h"
#include "radiosity/rows/memory_budget.h"
#include "radiosity/solve.h"
#include "raytrace/render.h"
#include "scene/io/read_scene.h"
#include "scene/parallel.h"
#include "scene/sampling.h"

namespace {

using namespace lightwell;

// Median seconds of several runs, since machines are shared and noisy.
double median_seconds(int runs, const std::function<void()>& work) {
  std::vector<double> seconds;
  for (int i = 0; i < runs; ++i) seconds.push_back(seconds_of(work));
  std::sort(seconds.begin(), seconds.end());
  return seconds[runs / 2];
}

std::vector<RTCRayHit> hemisphere_rays(const PatchMesh& mesh, int rays_per_patch) {
  std::vector<RTCRayHit> rays;
  const SobolPoints sobol(rays_per_patch);
  for (int i = 0; i < mesh.patch_count(); ++i) {
    const PatchSampler sampler(mesh, i);
    for (int r = 0; r < rays_per_patch; ++r) {
      const Eigen::Array4f u = sobol.point(r, random_key(i, 99));
      const PatchPoint from = sampler.point(u[0], u[1]);
      const Eigen::Vector3d d = cosine_ray(mesh, from, u[2], u[3]).direction;
      const Eigen::Vector3d o = from.position + 1e-6 * from.normal;
      RTCRayHit q{};
      q.ray.org_x = static_cast<float>(o.x());
      q.ray.org_y = static_cast<float>(o.y());
      q.ray.org_z = static_cast<float>(o.z());
      q.ray.dir_x = static_cast<float>(d.x());
      q.ray.dir_y = static_cast<float>(d.y());
      q.ray.dir_z = static_cast<float>(d.z());
      q.ray.tfar = 1e30f;
      q.ray.mask = ~0u;
      rays.push_back(q);
    }
  }
  return rays;
}

void trace_raw(RTCScene scene, std::vector<RTCRayHit>& rays) {
  parallel_for(static_cast<int>(rays.size()), 4096, [&](int begin, int end) {
#if RTC_VERSION_MAJOR >= 4
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
#endif
    for (int i = begin; i < end; ++i) {
      rays[i].ray.tfar = 1e30f;
      rays[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
      rtcIntersect1(scene, &rays[i], &arguments);
#else
      rtcIntersect1(scene, &context, &rays[i]);
#endif
    }
  });
}

}  // namespace

int main(int argc, char** argv) {
  const Scene scene = read_scene(argc > 1 ? argv[1] : LIGHTWELL_CORNELL "/cornell.toml");
  fmt::print("scene {}, {} threads\n", scene.file.string(), thread_count());

  // The end-to-end run comes first: peak memory is then that of the program alone.
  SolvedScene solved;
  const double solve_seconds = seconds_of([&] { solved = solve_scene(scene); });
  const PatchMesh& mesh = solved.mesh;
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  double render_seconds = 0.0;
  if (!scene.cameras.empty()) {
    Camera camera = scene.cameras[0];
    camera.width = camera.height = 512;
    render_seconds =
        seconds_of([&] { render(scene, caster, direct_light, solved.solution, camera); });
  }
  fmt::print("solve {:.2f} s ({} patches, {} elements)", solve_seconds, mesh.patch_count(),
             mesh.element_count());
  for (const PhaseSeconds& phase : solved.solution.seconds) {
    fmt::print("  {} {:.2f}", phase.phase, phase.seconds);
  }
  fmt::print("\nsecond pass 512 x 512 {:.2f} s\nsolve + picture {:.2f} s, peak memory {:.0f} MB\n",
             render_seconds, solve_seconds + render_seconds,
             static_cast<double>(resident_memory().most) / (1 << 20));

  // Rows of form factors are cast on the mesh before refinement.
  constexpr int rays_per_patch = 512, runs = 5;
  const PatchMesh even = build_patches(scene);
  const ElementCaster even_caster(even);
  const RawScene embree(even);
  std::vector<RTCRayHit> raw = hemisphere_rays(even, rays_per_patch);
  const double raw_seconds = median_seconds(runs, [&] { trace_raw(embree.scene, raw); });
  const LightPaths paths(scene, even_caster, 8);
  const std::vector<int> counts(even.patch_count(), rays_per_patch);
  const double row_seconds =
      median_seconds(runs, [&] { cast_rows(even_caster, paths, counts, {}); });
  const double rays = static_cast<double>(rays_per_patch) * even.patch_count() / 1e6;
  fmt::print(
      "raw Embree, incoherent: {:.2f} Mray/s\nform-factor rows: {:.2f} Mray/s, {:.0f} % of raw\n",
      rays / raw_seconds, rays / row_seconds, 100.0 * raw_seconds / row_seconds);
}
