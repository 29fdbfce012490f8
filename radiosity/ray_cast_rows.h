#pragma once

#include <functional>
#include <span>
#include <vector>

#include "radiosity/estimated_row.h"
#include "radiosity/light_path.h"
#include "scene/hemisphere_sets.h"

namespace lightwell {

/// A ray of a row, and where it ended.
struct CastRay {
  Eigen::Vector3d origin, direction;  ///< the direction is unit
  float t;                            ///< metres; infinite if it met nothing
  int patch;                          ///< first met, diffuse or not; -1: nothing or a black back
};

/// Casts the rays of one row after another.
class RowCaster {
 public:
  /// `most_rays`: what a row will be asked for at most.
  RowCaster(const ElementCaster& caster, const LightPaths& paths, int most_rays);

  /// What one thread uses again from row to row.
  class Scratch {
   public:
    explicit Scratch(const PatchMesh& mesh);
    /// The last row's rays, if they were to be kept.
    std::span<const CastRay> rays() const { return rays_; }

   private:
    friend class RowCaster;
    void add(int patch);
    std::vector<FormFactor> take(int rays);
    void put_in_order();

    std::vector<int> count_, touched_;
    std::vector<CastRay> rays_;
  };

  /// `rays` cosine-distributed rays from all over the patch. Empty for patches that take no part in
  /// diffuse exchange.
  EstimatedRow cast(int patch, int rays, Scratch& scratch, bool keep_rays = false) const;

 private:
  const ElementCaster& caster_;
  const LightPaths& paths_;
  HemisphereSets sets_;
};

/// Calls `work(i, scratch)` for each patch i, in parallel, with progress between slices.
/// `rays_per_patch`: about how many rays one call casts.
void for_each_row(const PatchMesh& mesh, int rays_per_patch, const Progress& progress,
                  const std::function<void(int, RowCaster::Scratch&)>& work);

/// Casts `rays_of[i]` rays from each patch i.
std::vector<EstimatedRow> cast_rows(const ElementCaster& caster, const LightPaths& paths,
                                    const std::vector<int>& rays_of, const Progress& progress);

}  // namespace lightwell
