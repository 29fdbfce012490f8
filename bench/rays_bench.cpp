// Speed of the second pass's rays, beside plain Embree with the same rays and elements in the same
// process, on one thread.
//
//   rays_bench [SCENE.toml]     default: the diffuse Cornell box
//
// Prints millions of rays per second:
// - eye rays of a picture of 512 x 512, with element and weights at the hit;
// - shadow rays from the hits of the eye rays to 16 points of the lamp, which ignore the facets at
//   both ends, beside Embree's single rays and packets of 16.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "bench/raw_embree.h"
#include "bench/stopwatch.h"
#include "mesh/build_patches.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/emitters/emitter.h"
#include "radiosity/emitters/emitter_point.h"
#include "raytrace/cameras/camera_ray.h"
#include "scene/io/read_scene.h"
#include "scene/rays/embree_queries.h"
#include "scene/sampling.h"

namespace {

using namespace lightwell;

constexpr int shadow_rays = 16;

// Median seconds of several runs, since machines are shared and noisy.
double median_seconds(const std::function<void()>& work) {
  constexpr int runs = 7;
  std::vector<double> seconds;
  for (int i = 0; i < runs; ++i) seconds.push_back(seconds_of(work));
  std::sort(seconds.begin(), seconds.end());
  return seconds[runs / 2];
}

RTCRay raw_ray(const Ray& ray, float nearest) {
  RTCRay r{};
  r.org_x = static_cast<float>(ray.origin.x());
  r.org_y = static_cast<float>(ray.origin.y());
  r.org_z = static_cast<float>(ray.origin.z());
  r.dir_x = static_cast<float>(ray.direction.x());
  r.dir_y = static_cast<float>(ray.direction.y());
  r.dir_z = static_cast<float>(ray.direction.z());
  r.tnear = nearest;
  r.tfar = static_cast<float>(std::min(ray.t_max, 1e30));
  r.mask = ~0u;
  return r;
}

void trace_single(RTCScene scene, const std::vector<RTCRay>& rays, std::vector<RTCRayHit>& hits) {
  QueryContext context;
  init(context, nullptr);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hits[i].ray = rays[i];
    hits[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
    intersect(scene, context, hits[i]);
  }
}

std::size_t occlude_packets(RTCScene scene, const std::vector<RTCRay>& rays) {
  QueryContext context;
  init(context, nullptr);
  alignas(64) std::array<int, packet_size> valid;
  valid.fill(-1);
  std::size_t blocked = 0;
  for (std::size_t begin = 0; begin + packet_size <= rays.size(); begin += packet_size) {
    RTCRay16 packet;
    for (int i = 0; i < packet_size; ++i) {
      const RTCRay& ray = rays[begin + static_cast<std::size_t>(i)];
      packet.org_x[i] = ray.org_x;
      packet.org_y[i] = ray.org_y;
      packet.org_z[i] = ray.org_z;
      packet.dir_x[i] = ray.dir_x;
      packet.dir_y[i] = ray.dir_y;
      packet.dir_z[i] = ray.dir_z;
      packet.tnear[i] = ray.tnear;
      packet.tfar[i] = ray.tfar;
      packet.time[i] = 0.0f;
      packet.mask[i] = ~0u;
      packet.id[i] = 0;
      packet.flags[i] = 0;
    }
    occlude(scene, context, valid.data(), packet);
    for (int i = 0; i < packet_size; ++i) blocked += packet.tfar[i] < 0.0f ? 1 : 0;
  }
  return blocked;
}

std::vector<Ray> eye_rays(Camera camera) {
  camera.width = camera.height = 512;
  const CameraRays rays(camera);
  std::vector<Ray> result;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) result.push_back(rays.ray(x + 0.5, y + 0.5));
  }
  return result;
}

std::vector<Ray> rays_to_lamp(const std::vector<Ray>& eye, const std::vector<ElementHit>& hits,
                              const Emitter& lamp) {
  constexpr std::size_t every = 4;
  const SobolPoints points(shadow_rays);
  std::vector<Ray> result;
  for (std::size_t i = 0; i < eye.size(); i += every) {
    if (hits[i].facet < 0 || hits[i].facet == lamp.facet) continue;
    const Eigen::Vector3d from = eye[i].origin + hits[i].t * eye[i].direction;
    for (int s = 0; s < shadow_rays; ++s) {
      const Eigen::Array4f u = points.point(s, i);
      result.push_back({.origin = from,
                        .direction = emitter_point(lamp, u[0], u[1]) - from,
                        .t_max = 1.0,
                        .origin_group = hits[i].facet,
                        .target_group = lamp.facet});
    }
  }
  return result;
}

void report(const char* what, std::size_t rays, double ours, double raw) {
  const double millions = static_cast<double>(rays) / 1e6;
  fmt::print("{:<38} {:6.2f} Mray/s, Embree {:6.2f}: {:.0f} %\n", what, millions / ours,
             millions / raw, 100.0 * raw / ours);
}

}  // namespace

int main(int argc, char** argv) {
  const Scene scene = read_scene(argc > 1 ? argv[1] : LIGHTWELL_CORNELL "/cornell.toml");
  const PatchMesh mesh = build_patches(scene);
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  const RawScene embree(mesh);
  fmt::print("{}: {} elements\n", scene.file.filename().string(), mesh.element_count());

  const std::vector<Ray> eye = eye_rays(scene.cameras.at(0));
  std::vector<ElementHit> hits(eye.size());
  std::vector<RTCRay> raw;
  for (const Ray& ray : eye) raw.push_back(raw_ray(ray, 0.0f));
  std::vector<RTCRayHit> raw_hits(raw.size());
  const double eye_seconds = median_seconds([&] { caster.closest_hits(eye, hits); });
  report("eye rays", eye.size(), eye_seconds,
         median_seconds([&] { trace_single(embree.scene, raw, raw_hits); }));
  // The second pass traces rays one at a time, each with its tree of reflections and refractions.
  const double one_by_one = median_seconds([&] {
    for (std::size_t i = 0; i < eye.size(); ++i) caster.closest_hits({&eye[i], 1}, {&hits[i], 1});
  });
  report("eye rays one by one", eye.size(), one_by_one,
         median_seconds([&] { trace_single(embree.scene, raw, raw_hits); }));

  if (direct_light.emitters().empty() || direct_light.emitters()[0].is_sphere) return 0;
  const std::vector<Ray> shadow = rays_to_lamp(eye, hits, direct_light.emitters()[0]);
  std::vector<std::uint8_t> blocked(shadow.size());
  raw.clear();
  // Share of a ray that is cut off at both ends, where plain Embree would hit the surface of the
  // origin or the lamp.
  constexpr float off = 1e-4f;
  for (const Ray& ray : shadow) {
    raw.push_back(raw_ray(ray, off));
    raw.back().tfar = 1.0f - off;
  }
  const double shadow_seconds = median_seconds([&] { caster.occluded(shadow, blocked); });
  std::size_t raw_blocked = 0;
  report("shadow rays, Embree in packets of 16", shadow.size(), shadow_seconds,
         median_seconds([&] { raw_blocked = occlude_packets(embree.scene, raw); }));
  raw_hits.resize(raw.size());
  report("shadow rays, Embree's closest hits", shadow.size(), shadow_seconds,
         median_seconds([&] { trace_single(embree.scene, raw, raw_hits); }));
  fmt::print("blocked: {:.2f} %, by Embree {:.2f} %\n",
             100.0 * static_cast<double>(std::count(blocked.begin(), blocked.end(), 1)) /
                 static_cast<double>(shadow.size()),
             100.0 * static_cast<double>(raw_blocked) / static_cast<double>(shadow.size()));
}
