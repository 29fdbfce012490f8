#pragma once

#include <cstdint>

#include "scene/sampling.h"

namespace lightwell {

/// Purposes of random numbers: the part of a key that keeps the numbers of one use apart from those
/// of all others (see random_key). A value never changes, since results depend on values. A new
/// purpose takes a new value, here and in is_distinct_purpose().
enum class RandomPurpose : std::uint64_t {
  // Rows of form factors; (patch, purpose) or (key, purpose, number).
  form_factor_rays = 1,
  form_factor_paths = 2,
  emitter_exchange_points = 3,
  form_factor_aims = 4,
  // Gathers at points; (key of a point, purpose), (patch, purpose) or (source, purpose).
  gather_rays = 10,
  gather_paths = 11,
  gather_shadows = 12,
  caustic_rays = 13,
  caustic_paths = 14,
  gather_aims = 15,
  gap_rays = 16,  // (key, purpose, number)
  gather_portals = 17,
  bright_openness = 18,       // (patch, purpose)
  error_points = 20,          // alone, a multiple of 10000 added for every further batch
  exchange_shadow_rays = 21,  // (patch, patch, purpose, set)
  shooter_points = 22,        // (patch, receiver, purpose)
  // Refinement; (side of a cell, purpose).
  refinement_probes = 30,
  refinement_quarters = 31,
  // (patch, purpose) or (source, purpose).
  hemicube_turn = 32,
  hemicube_paths = 33,
  asymmetry = 34,
  caustic_source_rays = 35,
  medium_walks = 36,  // (patch, purpose, walk)
  // Sets of hemisphere rays; (set, purpose).
  hemisphere_sets = 0x5e75,
  // Scattering at rough surfaces; (key of an interaction, purpose).
  microfacet_masking = 0x3a5c,
  path_microfacets = 0x66c3,
  // The sky; (key of a site or a point, purpose).
  sky_site_rays = 0x51e7,
  sky_rays = 0x51e8,
  sky_point_rays = 0x51e9,
  // Rows of view factors; (patch, purpose).
  sky_view_rays = 0x51ea,
  sun_shadows = 0x5d40,
  // Light of sources that are no surface; (source, purpose) or (patch, purpose).
  free_source_rays = 0xf4ee1,
  free_source_paths = 0xf4ee2,
  free_source_points = 0xf4ee3,
  // Caustic photons; (number, purpose) or (key, purpose, number).
  photons = 0xf0704,
  photon_paths = 0xf0705,
  photon_counts = 0xf0706,
  // Pictures; (column, row, purpose).
  pixel_edges = 0xed6e,
  pixel_points = 0x9face,
  pixel_shading = 0x9faced,
  // A ray tree; (key, node, purpose).
  ray_tree_shadows = 0x5ec07d,
  ray_tree_gathers = 0x6a7e4,
  ray_tree_roulette = 0x12017,
  gloss = 0x61055,
  gloss_lamps = 0x1a4b,
  gloss_patches = 0x1a4c,
  // Gathers of pixels; (key, purpose).
  pixel_gather_rays = 0x6a7e,
  pixel_gather_paths = 0x6a7f,
  pixel_gather_aims = 0x6a80,
  // Parts of a scene; (patch, purpose), (key, purpose, ray) or (node, purpose, round).
  part_rays = 0x9a47,
  side_rays = 0x51de,
  lamp_face_rays = 0x1a3f,
  part_vectors = 0x9a48,
  pixel_gather_portals = 0x6a81,
  // Light at points by way of mirrors and glass; (point, purpose, replica), (key, purpose, number).
  specular_light = 0x5bec1,
  // Sample points of the balance between parts; (part, purpose, replica).
  balance_points = 0xba1a,
  // Walks of importance; (view ray, purpose, step).
  importance_walks = 0x1390,
  // Paths from openings; (opening, purpose, number).
  portal_paths = 0x9047a1,
  // One light in place of all; (key of a query, purpose, channel).
  drawn_lights = 0xd4a3,
  pilot_lights = 0x9c06,    // (key of a query, purpose)
  light_clusters = 0x9c07,  // two members of a cluster; (key of a query, purpose, number)
  // Product cuts: two members of a pair; (key, purpose, number), (key, purpose, number, draw).
  light_pairs = 0x9c08,
  gather_points = 0x9c09,
  pair_shadows = 0x9c0a,
  single_lights = 0x9c0b,  // (key, purpose, point)
  // Virtual lights; (number, purpose, bounce) or (key of a point, purpose, number).
  virtual_light_points = 0x51aa1,
  virtual_light_paths = 0x51aa2,
  virtual_light_rays = 0x51aa3,
};

/// True for every purpose. Two purposes of equal value are two equal cases, which no compiler
/// accepts; a purpose that is left out is a warning (-Wswitch).
constexpr bool is_distinct_purpose(RandomPurpose purpose) {
  switch (purpose) {
    case RandomPurpose::form_factor_rays:
    case RandomPurpose::form_factor_paths:
    case RandomPurpose::emitter_exchange_points:
    case RandomPurpose::form_factor_aims:
    case RandomPurpose::gather_rays:
    case RandomPurpose::gather_paths:
    case RandomPurpose::gather_shadows:
    case RandomPurpose::caustic_rays:
    case RandomPurpose::caustic_paths:
    case RandomPurpose::gather_aims:
    case RandomPurpose::gap_rays:
    case RandomPurpose::gather_portals:
    case RandomPurpose::virtual_light_points:
    case RandomPurpose::virtual_light_paths:
    case RandomPurpose::virtual_light_rays:
    case RandomPurpose::bright_openness:
    case RandomPurpose::balance_points:
    case RandomPurpose::importance_walks:
    case RandomPurpose::error_points:
    case RandomPurpose::exchange_shadow_rays:
    case RandomPurpose::shooter_points:
    case RandomPurpose::refinement_probes:
    case RandomPurpose::refinement_quarters:
    case RandomPurpose::hemicube_turn:
    case RandomPurpose::hemicube_paths:
    case RandomPurpose::asymmetry:
    case RandomPurpose::caustic_source_rays:
    case RandomPurpose::medium_walks:
    case RandomPurpose::hemisphere_sets:
    case RandomPurpose::microfacet_masking:
    case RandomPurpose::path_microfacets:
    case RandomPurpose::sky_site_rays:
    case RandomPurpose::sky_rays:
    case RandomPurpose::sky_point_rays:
    case RandomPurpose::sky_view_rays:
    case RandomPurpose::sun_shadows:
    case RandomPurpose::free_source_rays:
    case RandomPurpose::free_source_paths:
    case RandomPurpose::free_source_points:
    case RandomPurpose::photons:
    case RandomPurpose::photon_paths:
    case RandomPurpose::photon_counts:
    case RandomPurpose::pixel_edges:
    case RandomPurpose::pixel_points:
    case RandomPurpose::pixel_shading:
    case RandomPurpose::ray_tree_shadows:
    case RandomPurpose::ray_tree_gathers:
    case RandomPurpose::ray_tree_roulette:
    case RandomPurpose::gloss:
    case RandomPurpose::gloss_lamps:
    case RandomPurpose::gloss_patches:
    case RandomPurpose::pixel_gather_rays:
    case RandomPurpose::pixel_gather_paths:
    case RandomPurpose::pixel_gather_aims:
    case RandomPurpose::part_rays:
    case RandomPurpose::drawn_lights:
    case RandomPurpose::light_clusters:
    case RandomPurpose::pilot_lights:
    case RandomPurpose::light_pairs:
    case RandomPurpose::gather_points:
    case RandomPurpose::pair_shadows:
    case RandomPurpose::single_lights:
    case RandomPurpose::side_rays:
    case RandomPurpose::lamp_face_rays:
    case RandomPurpose::part_vectors:
    case RandomPurpose::pixel_gather_portals:
    case RandomPurpose::specular_light:
    case RandomPurpose::portal_paths:
      return true;
  }
  return false;
}

/// Keys with a purpose in place of their second or third number.
inline std::uint64_t random_key(std::uint64_t a, RandomPurpose purpose, std::uint64_t c = 0,
                                std::uint64_t d = 0) {
  return random_key(a, static_cast<std::uint64_t>(purpose), c, d);
}
inline std::uint64_t random_key(std::uint64_t a, std::uint64_t b, RandomPurpose purpose,
                                std::uint64_t d = 0) {
  return random_key(a, b, static_cast<std::uint64_t>(purpose), d);
}

}  // namespace lightwell
