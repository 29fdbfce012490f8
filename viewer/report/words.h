#pragma once

#include <initializer_list>
#include <string>

#include "viewer/report/language.h"

namespace lightwell {

/// Words, phrases and sentences of a report. Sentences are marked text (viewer/document) with
/// places {0}, {1}, ... for values.
enum class Word {
  // Cover
  project,
  client,
  author,
  date,
  remarks,
  computed_with,
  view,
  // Light
  electric_light,
  daylight,
  electric_and_daylight,
  both,
  sky,
  sky_overcast,
  sky_clear,
  sky_uniform,
  content_electric,
  content_daylight,
  content_apart,
  content_together,
  maintained,
  new_lamps,
  // Results
  results,
  illuminance,
  illuminance_means,
  calculation_surface,
  mean_lux,
  least_lux,
  greatest_lux,
  uniformity,
  area,
  points,
  power_density,
  watts_per_area,
  per_hundred_lux,
  per_hundred_lux_unknown,
  unified_glare_rating,
  // Luminaires
  luminaires,
  no_luminaires,
  name,
  luminaire,
  number,
  flux,
  power,
  efficacy,
  all,
  count_of,
  flux_of_table,
  flux_of_lamps,
  flux_in_scene,
  watts_each,
  opening,
  round_opening,
  curve,
  // Plans
  height_above,
  without_margin,
  grid_size,
  cut_above_surface,
  cut_above_surface_below,
  plan_caption,
  along_surface,
  on_paper,
  // Glare
  glare,
  glare_means,
  glare_daylight_behind,
  glare_without_daylight,
  observer,
  eye_at,
  background,
  none_in_sight,
  in_sight_of,
  luminance,
  solid_angle,
  share,
  left_out,
  // Assumptions
  assumptions,
  maintenance_is,
  sampling,
  solution_error,
  buried_points,
  spacing,
  glare_of_new_lamps,
  // Signature
  basis,
  program,
  scene_file,
  scene_hash,
  options,
  refinement,
  seen_from,
  error_estimate,
  error_unknown,
  rays,
  // Standards
  limits_of_standards,
  limits_mean,
  figure,
  value,
  limit,
  verdict,
  met,
  missed,
  too_close,
  recommended,
  light_at_the_eye,
  melanopic_edi,
  energy_of_year,
  count
};

/// A word as it stands in the table of words.
const char* word_in(Language language, Word word);
/// A word with values in its places.
std::string worded(Language language, Word word, std::initializer_list<std::string> values = {});

}  // namespace lightwell
