#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/form_factors.h"
#include "radiosity/light_path.h"

namespace lightwell {

/// Where the rays of one patch ended.
struct RayCastRow {
  struct Count {
    int patch = 0;
    int rays = 0;
  };
  int rays = 0;                       ///< cast in all
  std::vector<Count> counts{};        ///< first arrivals at diffuse patches, ordered by patch
  int escaped = 0;                    ///< rays that met nothing or a black back at once
  int specular = 0;                   ///< rays whose first hit was purely specular
  std::vector<int> specular_patch{};  ///< patches reached by way of mirrors and glass, ordered
  BandArray specular_weight{};        ///< summed throughput, one row per specular_patch
  Spectrum specular_escaped{}, absorbed{}, cut{};  ///< summed throughput lost behind specular hits
};

/// Casts `rays_of[i]` cosine-distributed rays from all over each patch i. Patches that neither
/// reflect nor emit diffusely get empty rows.
std::vector<RayCastRow> cast_rows(const ElementCaster& caster, const LightPaths& paths,
                                  const std::vector<int>& rays_of, const Progress& progress);

}  // namespace lightwell
