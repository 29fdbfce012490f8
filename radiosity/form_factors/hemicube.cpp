#include "radiosity/form_factors/hemicube.h"

#include <algorithm>
#include <map>

#include "radiosity/form_factors/hemicube_view.h"
#include "radiosity/form_factors/ray_cast_rows.h"
#include "scene/facet_textures.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Sums the row of one patch over the items of its hemicube's cells.
class Tally {
 public:
  Tally(const ElementCaster& caster, const LightPaths& paths, const HemicubeCells& cells)
      : caster_(caster), paths_(paths), cells_(cells), share_(caster.mesh().patch_count(), 0.0) {}

  EstimatedRow row(int patch, const HemicubeEye& eye, std::span<const int> items) {
    const PatchMesh& mesh = caster_.mesh();
    const int bands = static_cast<int>(mesh.reflectance.cols());
    row_ = {.inverse_variance = 1.0 / mesh.area[patch]};
    specular_escaped_ = absorbed_ = cut_ = Eigen::ArrayXd::Zero(bands);
    key_ = random_key(static_cast<std::uint64_t>(patch), RandomPurpose::hemicube_paths);
    const int n = cells_.resolution();
    for (int f = 0; f < HemicubeCells::face_count; ++f) {
      for (int r = 0; r < cells_.rows(f); ++r) {
        const int* item = items.data() + cells_.first_cell(f) + r * n;
        for (int first = 0, last = 0; first < n; first = last) {
          while (last < n && item[last] == item[first]) ++last;
          add_run(eye, item[first], f, r, first, last);
        }
      }
    }
    take_shares();
    return std::move(row_);
  }

 private:
  // A run of neighbouring cells in a row with the same item.
  void add_run(const HemicubeEye& eye, int item, int face, int row, int first, int last) {
    const PatchMesh& mesh = caster_.mesh();
    const int facet = hemicube_item::facet(mesh, item);
    const bool is_dimmed = item >= 0 && paths_.dims_before(mesh.patch[item]);
    if (facet >= 0 && (paths_.is_specular(facet) || is_dimmed)) {
      for (int column = first; column < last; ++column) follow(eye, face, row, column);
      return;
    }
    const double share = cells_.delta_form_factor(face, row, first, last);
    if (item >= 0) {
      add(mesh.patch[item], share);
    } else {
      row_.escaped += share;
    }
  }

  // Follows the ray of a cell that sees a specular surface, or one within an absorbing body. The
  // ray determines what the cell sees, so nothing is lost where a flat element and the exact shape
  // differ.
  void follow(const HemicubeEye& eye, int face, int row, int column) {
    const PatchMesh& mesh = caster_.mesh();
    const Ray ray{.origin = eye.position,
                  .direction = eye.frame * cells_.direction(face, row, column),
                  .origin_group = eye.facet};
    ElementHit hit;
    caster_.closest_hits({&ray, 1}, {&hit, 1});
    ++row_.rays;
    const double share = cells_.delta_form_factor(face, row, column, column + 1);
    const bool specular = hit.facet >= 0 && paths_.is_specular(hit.facet);
    const bool arrives = hit.element >= 0 && (!specular || paths_.is_diffuse(hit.facet));
    const Spectrum left = arrives ? paths_.left_by_body(ray, hit) : Spectrum();
    if (left.size() > 0) {
      row_.specular += share;
      arrive(mesh.patch[hit.element], paths_.base_factor(ray, hit) * share, left);
      if (!specular) absorbed_ += share * (1.0f - left).cast<double>();
    } else if (arrives) {
      add(mesh.patch[hit.element], share);
    } else {
      (specular ? row_.specular : row_.escaped) += share;
    }
    if (!specular) return;
    const auto cell =
        static_cast<std::uint64_t>(cells_.first_cell(face) + row * cells_.resolution() + column);
    const PathLosses losses =
        paths_.follow(ray, hit, random_key(key_, RandomPurpose::hemicube_paths, cell),
                      [&](const ElementHit& end, const Spectrum& throughput) {
                        arrive(mesh.patch[end.element], share, throughput);
                      });
    specular_escaped_ += share * losses.escaped.cast<double>();
    absorbed_ += share * losses.absorbed.cast<double>();
    cut_ += share * losses.cut.cast<double>();
  }

  void arrive(int patch, double share, const Spectrum& throughput) {
    const auto [at, is_new] =
        by_way_of_specular_.try_emplace(patch, Eigen::ArrayXd::Zero(throughput.size()));
    at->second += share * throughput.cast<double>();
  }

  void add(int patch, double share) {
    if (share_[patch] == 0.0) touched_.push_back(patch);
    share_[patch] += share;
  }

  void take_shares() {
    std::sort(touched_.begin(), touched_.end());
    row_.shares.reserve(touched_.size());
    for (int patch : touched_) {
      row_.shares.push_back({patch, static_cast<float>(share_[patch])});
      share_[patch] = 0.0;
    }
    touched_.clear();
    row_.specular_share.resize(static_cast<Eigen::Index>(by_way_of_specular_.size()),
                               absorbed_.size());
    for (const auto& [to, share] : by_way_of_specular_) {
      row_.specular_share.row(static_cast<Eigen::Index>(row_.specular_patch.size())) =
          share.cast<float>().transpose();
      row_.specular_patch.push_back(to);
    }
    by_way_of_specular_.clear();
    row_.specular_escaped = specular_escaped_.cast<float>();
    row_.absorbed = absorbed_.cast<float>();
    row_.cut = cut_.cast<float>();
  }

  const ElementCaster& caster_;
  const LightPaths& paths_;
  const HemicubeCells& cells_;
  std::vector<double> share_;  // per patch; double because many small terms add up
  std::vector<int> touched_;
  std::map<int, Eigen::ArrayXd> by_way_of_specular_;
  Eigen::ArrayXd specular_escaped_, absorbed_, cut_;  // double, as share_
  EstimatedRow row_;
  std::uint64_t key_ = 0;
};

}  // namespace

void for_each_hemicube_row(const ElementCaster& caster, const LightPaths& paths,
                           const HemicubeOptions& options, const Progress& progress,
                           const std::function<void(int, const EstimatedRow&)>& take,
                           const JournalPhase& phase) {
  const PatchMesh& mesh = caster.mesh();
  const HemicubeCells cells(options.resolution);
  const HemicubeScan scan(caster);
  // A surface on a patch hides all the rest, and a different part at every point: one point does
  // not represent the others.
  constexpr int rays_where_covered = 1024;
  const RowCaster row_caster(caster, paths, rays_where_covered);
  const bool any_holes = mesh.textures && mesh.textures->has_holes();
  const bool by_rays = any_holes || options.back_end == HemicubeOptions::BackEnd::rays;
  const int patches = mesh.patch_count();
  // Progress and interruption are handled between slices, on this thread; each takes a fraction of
  // a second.
  const int cells_per_slice = by_rays ? 1 << 20 : 1 << 24;
  const int of_process =
      std::clamp(cells_per_slice / cells.cell_count(), 2, std::max(64, patches / 100));
  const int grain = std::clamp(of_process / 8, 1, 16);
  const int slice = of_process * phase.processes();
  for (int begin = 0; begin < patches; begin += slice) {
    const auto report_progress = [&] {
      report(progress, "form factors", static_cast<double>(begin) / patches);
    };
    report_progress();
    const auto draw = [&](int low, int high) {
      Tally tally(caster, paths, cells);
      HemicubeScan::Scratch scratch;
      RowCaster::Scratch ray_scratch(mesh);
      std::vector<int> items(cells.cell_count());
      for (int i = begin + low; i < begin + high; ++i) {
        if (!paths.is_diffuse(mesh.facet[mesh.first_element[i]])) continue;
        EstimatedRow row;
        if (phase.recall(i, kept_parts(row))) {
          take(i, row);
          continue;
        }
        const bool has_holes =
            any_holes && mesh.textures->has_holes(mesh.facet[mesh.first_element[i]]);
        if (has_holes || caster.hidden_elements(i) > 0) {
          row = row_caster.cast(i, rays_where_covered, ray_scratch);
          row.inverse_variance = 1.0 / mesh.area[i];
        } else {
          const HemicubeEye eye = hemicube_eye(mesh, i, !by_rays);
          if (by_rays) {
            cast_hemicube(caster, eye, cells, items);
          } else {
            scan.draw(eye, cells, scratch, items);
          }
          row = tally.row(i, eye, items);
          if (by_rays) row.rays += cells.cell_count();
        }
        phase.keep(i, kept_parts(row));
        take(i, row);
      }
    };
    phase.for_each({begin, std::min(slice, patches - begin), grain}, draw, report_progress);
  }
  report(progress, "form factors", 1.0);
}

std::vector<EstimatedRow> hemicube_rows(const ElementCaster& caster, const LightPaths& paths,
                                        const HemicubeOptions& options, const Progress& progress) {
  std::vector<EstimatedRow> rows(static_cast<std::size_t>(caster.mesh().patch_count()));
  for_each_hemicube_row(caster, paths, options, progress,
                        [&](int i, const EstimatedRow& row) { rows[i] = row; });
  return rows;
}

}  // namespace lightwell
