#include "mesh/build_patches.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "mesh/chosen_sizes.h"
#include "mesh/contacts/contact_graph.h"
#include "mesh/discontinuity/critical_lines.h"
#include "mesh/geometry/facet_plane.h"
#include "mesh/patch_builder.h"
#include "mesh/patches/near_emitters.h"
#include "mesh/patches/patch_textures.h"
#include "scene/errors.h"
#include "scene/parallel.h"
#include "scene/round_shape.h"
#include "scene/scenery_box.h"

namespace lightwell {
namespace {

// Points closer than this share of coordinate_length() are joined. The first is the precision of
// single-precision coordinates. The others are for rougher files, in which facets that should touch
// miss each other by more, but by too little to be apart.
constexpr std::array<double, 3> weld_shares{1e-7, 1e-6, 1e-5};
constexpr double most_elements = 20e6;

void check_count(const Scene& scene, const PatchSizes& sizes) {
  const double count = predicted_elements(scene, sizes);
  if (count <= most_elements) return;
  const CutSize& cut = sizes.near();
  throw InputError(fmt::format(
      "{}{}patches of {:.6g} m with {} elements along an edge would make about {:.3g} million "
      "elements; the limit is {:.0f} million. Use a larger patch size",
      scene.file.string(), scene.file.empty() ? "" : ": ", cut.patch_size, cut.elements_per_edge,
      count / 1e6, most_elements / 1e6));
}

// Sentences on what discontinuity meshing left out.
std::vector<std::string> discontinuity_notes(const CriticalLines& critical,
                                             const CreaseCounts& counts, int without_creases) {
  std::vector<std::string> notes;
  if (critical.emitters_left_out > 0) {
    notes.push_back(fmt::format(
        "discontinuity lines: of {} emitting polygons the {} most powerful were followed",
        critical.emitters + critical.emitters_left_out, critical.emitters));
  }
  if (critical.wedges_left_out > 0) {
    notes.push_back(fmt::format(
        "discontinuity lines: of {} critical surfaces the {} most important were followed",
        critical.wedges + critical.wedges_left_out, critical.wedges));
  }
  if (counts.over_budget > 0) {
    notes.push_back(fmt::format(
        "discontinuity lines: the {} least important of {} were left out; they would add too many "
        "elements",
        counts.over_budget,
        counts.drawn + counts.resolved + counts.too_close + counts.over_budget));
  }
  if (without_creases > 0) {
    notes.push_back(fmt::format(
        "discontinuity lines: left out on {} polygons, where they would fold elements up",
        without_creases));
  }
  return notes;
}

// Counts facets, and names the first of them.
class CountedFacets {
 public:
  void add(int facet) {
    if (count_++ == 0) first_ = facet;
  }
  int count() const { return count_; }
  /// "`one` ..." or "3 `many` ...", with the name of the first facet; `notes` gets it if there are
  /// any.
  void note(const Scene& scene, const char* one, const char* many,
            std::vector<std::string>& notes) const {
    if (count_ == 0) return;
    const FacetRef ref = scene_facets(scene)[static_cast<std::size_t>(first_)];
    const std::string& name = scene.surfaces[static_cast<std::size_t>(ref.surface)].name;
    notes.push_back(fmt::format("{} {} (polygon {} of '{}'{})", count_, count_ == 1 ? one : many,
                                ref.facet, name, count_ == 1 ? "" : " is the first"));
  }

 private:
  int count_ = 0, first_ = 0;
};

// Numbers of facets without a mesh, of those that cross themselves, and of those whose mesh lacks
// lines. Fewer are better, the first counting most.
using Faults = std::array<int, 3>;

// Settings that the meshes of all tolerances share.
struct FacetSettings {
  const PatchSizes& sizes;
  const MeshOptions& options;
  const Progress& progress;
};

// The polygon facets of a scene cut to size, with points welded to one tolerance.
struct FacetMeshes {
  std::vector<FacetPlane> planes{};
  std::vector<FacetMesh> meshes{};  ///< one per plane
  CountedFacets empty{};            ///< facets without a mesh
  CountedFacets crossing{};         ///< facets that cross themselves
  CountedFacets flawed{};           ///< facets whose mesh lacks lines
  CountedFacets crowded{};          ///< facets that too many others touch or cross
  std::vector<std::string> notes{};

  Faults faults() const { return {empty.count(), crossing.count(), flawed.count()}; }
  bool is_sound() const { return faults() == Faults{}; }
};

// The faults of one facet's mesh, in the order of FacetMeshes::faults().
Faults faults_of(const FacetMesh& mesh) {
  const bool is_empty = mesh.corners.empty(), crosses = !is_empty && mesh.crosses_itself;
  const bool is_flawed = !is_empty && !crosses && mesh.is_flawed;
  return {is_empty ? 1 : 0, crosses ? 1 : 0, is_flawed ? 1 : 0};
}

// Numbers of all facets: those that have faults in `before`, which are the likeliest to have faults
// again, and then the others.
std::vector<int> faulty_first(const std::vector<FacetMesh>& before, int count) {
  std::vector<int> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  if (before.size() == order.size()) {
    std::stable_partition(order.begin(), order.end(), [&](int i) {
      return faults_of(before[static_cast<std::size_t>(i)]) != Faults{};
    });
  }
  return order;
}

// Meshes all facets. Returns false, with facets missing, as soon as there are as many faults as in
// `best`; an empty `best` is that of no mesh.
bool mesh_all(const ContactGraph& graph, const PatchSizes& sizes, const FacetMeshes& best,
              const Progress& progress, FacetMeshes& result) {
  const int count = static_cast<int>(result.planes.size());
  result.meshes.resize(result.planes.size());
  const std::vector<int> order = faulty_first(best.meshes, count);
  Faults faults{};
  constexpr int batch = 1024;  // facets between two checks of the stop request
  for (int begin = 0; begin < count; begin += batch) {
    report(progress, "mesh", 0.4 + 0.5 * begin / count);
    const int size = std::min(batch, count - begin);
    parallel_for(size, 1, [&](int from, int to) {
      for (int k = begin + from; k < begin + to; ++k) {
        const auto i = static_cast<std::size_t>(order[static_cast<std::size_t>(k)]);
        const FacetPlane& plane = result.planes[i];
        result.meshes[i] = mesh_facet(plane, graph.outline(static_cast<int>(i)), graph.points(),
                                      sizes.of_facet(plane.facet, plane.box));
      }
    });
    for (int k = begin; k < begin + size; ++k) {
      const auto i = static_cast<std::size_t>(order[static_cast<std::size_t>(k)]);
      const Faults more = faults_of(result.meshes[i]);
      for (std::size_t f = 0; f < faults.size(); ++f) faults[f] += more[f];
    }
    if (!best.meshes.empty() && faults >= best.faults()) return false;
  }
  return true;
}

// Meshes the facets with one tolerance; nothing if that has as many faults as `best` has.
std::optional<FacetMeshes> mesh_facets(const Scene& scene, double tolerance,
                                       const FacetSettings& settings, const FacetMeshes& best) {
  const auto& [sizes, options, progress] = settings;
  FacetMeshes result;
  WeldedPoints points(tolerance);
  result.planes = facet_planes(scene, points);
  CriticalLines critical;
  if (options.discontinuity) critical = critical_lines(scene, result.planes, {}, progress);
  const double most_added = options.discontinuity_growth * predicted_elements(scene, sizes);
  const ContactGraph graph(scene, result.planes, std::move(points), sizes, critical.lines,
                           most_added, progress);
  if (!mesh_all(graph, sizes, best, progress, result)) return std::nullopt;
  int without_creases = 0;
  for (std::size_t i = 0; i < result.planes.size(); ++i) {
    const FacetMesh& mesh = result.meshes[i];
    const int facet = result.planes[i].facet;
    if (graph.lacks_contacts(static_cast<int>(i))) result.crowded.add(facet);
    const auto [is_empty, crosses, is_flawed] = faults_of(mesh);
    if (is_empty) result.empty.add(facet);
    if (crosses) result.crossing.add(facet);
    if (is_flawed) result.flawed.add(facet);
    without_creases += mesh.lacks_creases ? 1 : 0;
  }
  if (options.discontinuity) {
    result.notes = discontinuity_notes(critical, graph.crease_counts(), without_creases);
  }
  return result;
}

// Meshes with the smallest tolerance that keeps all contact lines, or else with the one that leaves
// fewest facets without a mesh and, of those, lets fewest cross themselves and keeps most lines.
FacetMeshes mesh_facets(const Scene& scene, const PatchSizes& sizes, const MeshOptions& options,
                        const Progress& progress) {
  // Coordinates of what is near are as exact as without surroundings.
  const double diagonal = coordinate_length(scene);
  const FacetSettings settings{.sizes = sizes, .options = options, .progress = progress};
  FacetMeshes best;
  for (const double share : weld_shares) {
    std::optional<FacetMeshes> next = mesh_facets(scene, share * diagonal, settings, best);
    if (!next) break;
    best = std::move(*next);
    if (best.is_sound()) break;
  }
  best.empty.note(scene, "polygon has no area to mesh and was left out",
                  "polygons have no area to mesh and were left out", best.notes);
  best.crossing.note(scene, "polygon crosses itself; all that its boundary goes round was meshed",
                     "polygons cross themselves; all that their boundaries go round was meshed",
                     best.notes);
  best.flawed.note(scene, "polygon lacks contact lines that lie too close together to mesh",
                   "polygons lack contact lines that lie too close together to mesh", best.notes);
  best.crowded.note(
      scene, "polygon is crossed by too many others for all contact lines; the longest were kept",
      "polygons are crossed by too many others for all contact lines; the longest were kept",
      best.notes);
  return best;
}

// Adds a note if patches of one size everywhere are long beside a small part of the scene. A dome
// has most of the area, so the error estimate says little of a room within it.
void note_surroundings(const Scene& scene, const CutSize& cut, std::vector<std::string>& notes) {
  constexpr double longest = 50.0;  // a backdrop is at least twice as far away, see scenery_box()
  constexpr double fewest_patches = 8.0;  // along what is surrounded, for its light to vary at all
  const double all = scene_bounds(scene).diagonal(), scenery = scenery_box(scene).diagonal().norm();
  if (!(all > longest * scenery) || !(cut.patch_size > scenery / fewest_patches)) return;
  notes.push_back(fmt::format(
      "the surroundings are {:.4g} m long, and what they surround {:.3g} m: patches of {:.3g} m "
      "are too coarse for its light, and the error estimate may not show that; give no size of "
      "patches, make the surroundings smaller, up to {:g} times as long, or use a [sky] in place "
      "of a dome",
      all, scenery, cut.patch_size, longest));
}

bool is_sphere(const Surface& surface) {
  return std::holds_alternative<Sphere>(surface.shape);
}

}  // namespace

PatchMesh build_patches(const Scene& scene, const MeshOptions& options, const Progress& progress) {
  const PatchSizes round_sizes = patch_sizes(scene, options);
  const int per_edge = round_sizes.near().elements_per_edge;
  const PatchSizes sizes =
      options.to_be_refined ? round_sizes.with((per_edge + 1) / 2) : round_sizes;
  check_count(scene, sizes);
  report(progress, "mesh", 0.0);
  FacetMeshes facet_meshes = mesh_facets(scene, sizes, options, progress);

  report(progress, "mesh", 0.9);
  PatchBuilder builder(scene, options.smooth_angle_degrees, options.curve_angle_degrees);
  const std::vector<FacetRef> facets = scene_facets(scene);
  const NearEmitters near_emitters(scene);
  const auto spheres = static_cast<int>(std::ranges::count_if(scene.surfaces, is_sphere));
  int plane = 0;
  for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
    const Surface& surface = scene.surfaces[facets[f].surface];
    if (const auto shape = round_shape(surface)) {
      const CutSize usual = round_sizes.of_round_shape(f);
      CutSize size_here = near_emitters.cut(*shape, facets[f].surface, usual);
      if (options.to_be_refined) size_here = fine_enough(*shape, size_here, spheres);
      builder.add_round(f, facets[f].surface, usual.patch_size, *shape,
                        round_elements(*shape, size_here));
      continue;
    }
    FacetMesh& mesh = facet_meshes.meshes[plane];
    const FacetPlane& of_mesh = facet_meshes.planes[plane++];
    if (mesh.corners.empty()) continue;
    const double patch_size = sizes.of_facet(f, of_mesh.box).cut.patch_size;
    builder.add_facet(of_mesh, patch_size, std::move(mesh));
  }
  std::vector<std::string> notes = std::move(facet_meshes.notes);
  facet_meshes = {};
  PatchMesh mesh = builder.finish();
  if (mesh.patch_count() == 0) {
    throw InputError(fmt::format("{}{}no surface has an area; there is nothing to mesh",
                                 scene.file.string(), scene.file.empty() ? "" : ": "));
  }
  lay_on_textures(scene, mesh);
  note_surroundings(scene, round_sizes.near(), notes);
  mesh.notes = std::move(notes);
  report(progress, "mesh", 1.0);
  return mesh;
}

}  // namespace lightwell
