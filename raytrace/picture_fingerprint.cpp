#include "raytrace/picture_fingerprint.h"

namespace lightwell {
namespace {

void add_motion(Fingerprint& print, const RigidMotion& motion) {
  print.add(motion.pivot);
  print.add(motion.axis);
  print.add(motion.rest_time);
  for (const MotionKey& key : motion.keys) {
    print.add(key.time);
    print.add(key.degrees);
    print.add(key.translation);
  }
}

}  // namespace

void add_exposure(Fingerprint& print, const Scene& scene, const Exposure& exposure) {
  print.add(exposure.open);
  print.add(exposure.close);
  for (const Surface& surface : scene.surfaces) print.add(surface.motion);
  for (const RigidMotion& motion : scene.motions) add_motion(print, motion);
  if (exposure.camera) add_motion(print, *exposure.camera);
}

void add_picture_inputs(Fingerprint& print, const ElementCaster& caster,
                        const RadiositySolution& solution, const Camera& camera,
                        const RenderOptions& options) {
  print.add(caster.mesh());
  print.add(solution.direct_irradiance);
  print.add(solution.indirect_irradiance);
  // add_exposure() has the camera's motion and shutter.
  const auto& [name, position, direction, up, fov_degrees, width, height, lens_radius,
               focus_distance, blades, shutter_open, shutter_close, motion, projection, view_width,
               near_distance, far_distance, shift, window, distortion, circle_degrees,
               eye_separation] = camera;
  // Left out are `records`, `caustics`, `slant`, `base_gains`, `found_virtual_lights` and
  // `visible_lamps`, which follow from the rest; `layers`, whose names render() adds; `run` and
  // `rows_done`, which change no bit.
  const auto& [pass, max_depth, min_contribution, shadows, gather_rays, has_records, records,
               virtual_lights, found_virtual_lights, photons, caustics, slant, base_gains,
               visible_lamps, glossy_rays, sampling, max_subdivision, contrast, layers, run,
               rows_done] = options;
  const auto& [min_shadow_rays, max_shadow_rays, sky_rays, cluster_share, many_lights] = shadows;
  const auto& [most_samples, least_samples, noise] = sampling;
  for (const Eigen::Vector3d* v : {&position, &direction, &up}) print.add(*v);
  print.add(fov_degrees);
  print.add(width);
  print.add(height);
  print.add(pass);
  print.add(max_depth);
  print.add(min_contribution);
  print.add(min_shadow_rays);
  print.add(max_shadow_rays);
  print.add(sky_rays);
  print.add(cluster_share);
  print.add(many_lights);
  print.add(max_subdivision);
  print.add(contrast);
  print.add(solution.caustic_irradiance);
  print.add(lens_radius);
  print.add(focus_distance);
  print.add(blades);
  print.add(projection);
  print.add(view_width);
  print.add(near_distance);
  print.add(far_distance);
  print.add(shift.x());
  print.add(shift.y());
  for (const double edge : {window.left, window.top, window.right, window.bottom}) print.add(edge);
  const auto& [k1, k2, k3, p1, p2] = distortion;
  for (const double coefficient : {k1, k2, k3, p1, p2}) print.add(coefficient);
  print.add(circle_degrees);
  print.add(eye_separation);
  print.add(gather_rays);
  print.add(has_records);
  print.add(virtual_lights);
  print.add(glossy_rays);
  print.add(photons);
  print.add(most_samples);
  print.add(least_samples);
  print.add(noise);
}

}  // namespace lightwell
