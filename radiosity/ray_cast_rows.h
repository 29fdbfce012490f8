#pragma once

#include <functional>
#include <span>
#include <vector>

#include "radiosity/estimated_row.h"
#include "radiosity/light_path.h"
#include "scene/hemisphere_sets.h"

namespace lightwell {

/// Casts the rays of one row after another.
class RowCaster {
 public:
  /// `most_rays`: what a row will be asked for at most.
  RowCaster(const ElementCaster& caster, const LightPaths& paths, int most_rays);

  /// What one thread uses again from row to row.
  class Scratch {
   public:
    explicit Scratch(const PatchMesh& mesh);

   private:
    friend class RowCaster;
    void add(int patch);
    void add_hidden(int patch);
    void take(int rays, EstimatedRow& row);
    void put_in_order();

    std::vector<int> count_, touched_, hidden_, hidden_touched_;
  };

  /// `rays` cosine-distributed rays from all over the patch. Empty for patches that take no part in
  /// diffuse exchange. `look_behind`: rays go on through whatever they meet, to fill
  /// EstimatedRow::hidden.
  EstimatedRow cast(int patch, int rays, Scratch& scratch, bool look_behind = false) const;

 private:
  void look_behind(std::span<Ray> rays, std::span<ElementHit> hits, Scratch& scratch) const;

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
