#include "mesh/build_patches.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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

// Points closer than this share of the scene's diagonal are joined. The first is the precision of
// single-precision coordinates. The others are for rougher files, in which facets that should touch
// miss each other by more, but by too little to be apart.
constexpr std::array<double, 3> weld_shares{1e-7, 1e-6, 1e-5};
constexpr double most_elements = 20e6;

int side_count(const Material& material) {
  return material.one_sided || material.dielectric ? 1 : 2;
}

double boundary_length(const PolygonMesh& mesh, const Facet& facet) {
  double length = 0.0;
  const auto add = [&](const std::vector<int>& loop) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      length += (mesh.vertices[loop[i]] - mesh.vertices[loop[(i + 1) % loop.size()]]).norm();
    }
  };
  add(facet.boundary);
  for (const auto& hole : facet.holes) add(hole);
  return length;
}

double predicted_elements(const Scene& scene, double element_size) {
  double count = 0.0;
  for (const Surface& surface : scene.surfaces) {
    const int sides = side_count(scene.materials[surface.material]);
    if (const auto* mesh = std::get_if<PolygonMesh>(&surface.shape)) {
      for (const Facet& facet : mesh->facets) {
        // A strip narrower than an element is cut along its length alone.
        const double inside = facet_area(*mesh, facet) / (element_size * element_size);
        const double along = boundary_length(*mesh, facet) / (2.0 * element_size);
        count += sides * std::max({1.0, inside, along});
      }
    } else {
      count += sides * surface_area(surface) / (element_size * element_size);
    }
  }
  return count;
}

void check(const Scene& scene, const MeshOptions& options) {
  if (scene_facets(scene).empty()) {
    throw InputError(fmt::format("{}{}the scene has no surfaces; there is nothing to mesh",
                                 scene.file.string(), scene.file.empty() ? "" : ": "));
  }
  if (!(options.max_patch_size >= 0.0) || !std::isfinite(options.max_patch_size)) {
    throw InputError(fmt::format(
        "the largest patch size is {} m; give a positive length, or 0 to have it chosen",
        options.max_patch_size));
  }
  for (const int count : {options.auto_patch_count, options.most_patches}) {
    if (count >= 1) continue;
    throw InputError(fmt::format("{} patches are asked for; give at least 1", count));
  }
  if (!(options.discontinuity_growth >= 0.0)) {
    throw InputError(fmt::format(
        "discontinuity lines may add {} times the elements; give a number that is not negative",
        options.discontinuity_growth));
  }
  if (!(options.max_element_size >= 0.0) || !std::isfinite(options.max_element_size)) {
    throw InputError(fmt::format(
        "the largest element size is {} m; give a positive length, or 0 to have it chosen",
        options.max_element_size));
  }
  if (options.max_element_size > 0.0 && options.max_patch_size > 0.0 &&
      options.max_element_size > options.max_patch_size) {
    throw InputError(fmt::format(
        "elements of {:.6g} m do not fit into patches of {:.6g} m; give elements that are smaller",
        options.max_element_size, options.max_patch_size));
  }
  constexpr int most_per_edge = 1000;
  if (options.elements_per_patch_edge < 1 || options.elements_per_patch_edge > most_per_edge) {
    throw InputError(fmt::format("{} elements along a patch edge are asked for; give 1 to {}",
                                 options.elements_per_patch_edge, most_per_edge));
  }
}

void check_count(const Scene& scene, const CutSize& cut) {
  const double count = predicted_elements(scene, cut.element_size());
  if (count <= most_elements) return;
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

// The polygon facets of a scene cut to size, with points welded to one tolerance.
struct FacetMeshes {
  std::vector<FacetPlane> planes{};
  std::vector<FacetMesh> meshes{};  ///< one per plane
  CountedFacets empty{};            ///< facets without a mesh
  CountedFacets crossing{};         ///< facets that cross themselves
  CountedFacets flawed{};           ///< facets whose mesh lacks lines
  CountedFacets crowded{};          ///< facets that too many others touch or cross
  std::vector<std::string> notes{};

  // Fewer of these are better, the first counting most.
  std::array<int, 3> faults() const { return {empty.count(), crossing.count(), flawed.count()}; }
  bool is_sound() const { return faults() == std::array<int, 3>{}; }
};

FacetMeshes mesh_facets(const Scene& scene, double tolerance, const CutSize& cut,
                        const MeshOptions& options, const Progress& progress) {
  FacetMeshes result;
  WeldedPoints points(tolerance);
  result.planes = facet_planes(scene, points);
  CriticalLines critical;
  if (options.discontinuity) critical = critical_lines(scene, result.planes, {}, progress);
  const double most_added =
      options.discontinuity_growth * predicted_elements(scene, cut.element_size());
  const ContactGraph graph(scene, result.planes, std::move(points), cut, critical.lines, most_added,
                           progress);
  const int count = static_cast<int>(result.planes.size());
  result.meshes.resize(count);
  constexpr int batch = 1024;  // facets between two checks of the stop request
  for (int begin = 0; begin < count; begin += batch) {
    report(progress, "mesh", 0.4 + 0.5 * begin / count);
    parallel_for(std::min(batch, count - begin), 1, [&](int from, int to) {
      for (int i = begin + from; i < begin + to; ++i) {
        result.meshes[i] = mesh_facet(result.planes[i], graph.outline(i), graph.points(), cut);
      }
    });
  }
  int without_creases = 0;
  for (int i = 0; i < count; ++i) {
    const FacetMesh& mesh = result.meshes[i];
    const int facet = result.planes[i].facet;
    if (graph.lacks_contacts(i)) result.crowded.add(facet);
    if (mesh.corners.empty()) {
      result.empty.add(facet);
    } else if (mesh.crosses_itself) {
      result.crossing.add(facet);
    } else if (mesh.is_flawed) {
      result.flawed.add(facet);
    }
    without_creases += mesh.lacks_creases ? 1 : 0;
  }
  if (options.discontinuity) {
    result.notes = discontinuity_notes(critical, graph.crease_counts(), without_creases);
  }
  return result;
}

// The area that the patch size is chosen by, m^2. Mirrors and glass need no patches but are cut as
// well: a large mirror in a scene with few diffuse surfaces must not make millions of elements.
double area_to_mesh(const Scene& scene) {
  double diffuse = 0.0, all = 0.0;
  for (const Surface& surface : scene.surfaces) {
    const Material& material = scene.materials[surface.material];
    const double area = side_count(material) * surface_area(surface);
    all += area;
    if (!material.is_specular() || material.mirrors_by_coat() || material.passes_straight() ||
        material.pattern) {
      diffuse += area;
    }
  }
  constexpr double most_of_all = 16.0;
  return std::max(diffuse, all / most_of_all);
}

// Patch size of `count` patches of even size, or of up to 2.5 times as many in a scene with much
// area in little space, such as a house of furnished rooms. There patches must not be large beside
// the mean free path of light from surface to surface, 4 V / A (Cauchy) for the area A within the
// scene's box. The box's own surface does not count, since an empty room has no other. Both limits
// were set with a staircase of 257 000 facets in view: four times as many patches took a quarter
// more time and gained nothing.
double even_patch_size(const Scene& scene, int count) {
  constexpr double largest = 0.25, usual_count = 1600.0, most_times = 2.5;
  const double area = area_to_mesh(scene), size = std::sqrt(area / count);
  const Bounds bounds = scene_bounds(scene);
  const Eigen::Vector3d extent = bounds.high - bounds.low;
  const double of_box =
      2.0 * (extent.x() * extent.y() + extent.y() * extent.z() + extent.z() * extent.x());
  if (!(area > of_box)) return size;
  const double free_path = 4.0 * extent.prod() / (area - of_box);
  return std::clamp(largest * std::sqrt(usual_count / count) * free_path,
                    size / std::sqrt(most_times), size);
}

// Meshes with the smallest tolerance that keeps all contact lines, or else with the one that leaves
// fewest facets without a mesh and, of those, lets fewest cross themselves and keeps most lines.
FacetMeshes mesh_facets(const Scene& scene, const CutSize& cut, const MeshOptions& options,
                        const Progress& progress) {
  const double diagonal = scene_bounds(scene).diagonal();
  FacetMeshes best;
  for (const double share : weld_shares) {
    FacetMeshes next = mesh_facets(scene, share * diagonal, cut, options, progress);
    const bool is_first = share == weld_shares.front();
    if (!is_first && next.faults() >= best.faults()) break;
    best = std::move(next);
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

// Adds a note if patches follow surroundings beside which the rest of the scene is small. A dome
// has most of the area, so the error estimate says little of a room within it.
void note_surroundings(const Scene& scene, const CutSize& cut, std::vector<std::string>& notes) {
  constexpr double longest = 50.0;  // a backdrop is at least twice as far away, see scenery_box()
  constexpr double fewest_patches = 8.0;  // along what is surrounded, for its light to vary at all
  const double all = scene_bounds(scene).diagonal(), scenery = scenery_box(scene).diagonal().norm();
  if (!(all > longest * scenery) || !(cut.patch_size > scenery / fewest_patches)) return;
  notes.push_back(fmt::format(
      "the surroundings are {:.4g} m long, and what they surround {:.3g} m: patches of {:.3g} m "
      "are too coarse for its light, and the error estimate may not show that; make the "
      "surroundings smaller, up to {:g} times as long, or use a [sky] in place of a dome",
      all, scenery, cut.patch_size, longest));
}

bool is_sphere(const Surface& surface) {
  return std::holds_alternative<Sphere>(surface.shape);
}

}  // namespace

CutSize cut_size(const Scene& scene, const MeshOptions& options) {
  check(scene, options);
  if (!(options.max_element_size > 0.0)) {
    return {.patch_size = options.max_patch_size > 0.0
                              ? options.max_patch_size
                              : even_patch_size(scene, options.auto_patch_count),
            .elements_per_edge = options.elements_per_patch_edge};
  }
  const double element = options.max_element_size;
  if (options.max_patch_size > 0.0) {
    constexpr double rounding = 1e-5;  // relative rounding of lengths in a text file
    const double along = std::floor(options.max_patch_size / element + rounding);
    const auto count = static_cast<int>(std::clamp(along, 1.0, 1e3));
    return {.patch_size = std::min(options.max_patch_size, count * element),
            .elements_per_edge = count};
  }
  const double along = std::ceil(std::sqrt(area_to_mesh(scene) / options.most_patches) / element);
  const auto count = static_cast<int>(std::clamp(along, 2.0, 1e3));
  return {.patch_size = count * element, .elements_per_edge = count};
}

PatchMesh build_patches(const Scene& scene, const MeshOptions& options, const Progress& progress) {
  const CutSize round_cut = cut_size(scene, options);
  const double size = round_cut.patch_size;
  CutSize cut = round_cut;
  if (options.to_be_refined) cut.elements_per_edge = (cut.elements_per_edge + 1) / 2;
  check_count(scene, cut);
  report(progress, "mesh", 0.0);
  FacetMeshes facet_meshes = mesh_facets(scene, cut, options, progress);

  report(progress, "mesh", 0.9);
  PatchBuilder builder(scene, options.smooth_angle_degrees,
                       {.patch_size = size, .angle_degrees = options.curve_angle_degrees});
  const std::vector<FacetRef> facets = scene_facets(scene);
  const NearEmitters near_emitters(scene);
  const auto spheres = static_cast<int>(std::ranges::count_if(scene.surfaces, is_sphere));
  int plane = 0;
  for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
    const Surface& surface = scene.surfaces[facets[f].surface];
    if (const auto shape = round_shape(surface)) {
      CutSize size_here = near_emitters.cut(*shape, facets[f].surface, round_cut);
      if (options.to_be_refined) size_here = fine_enough(*shape, size_here, spheres);
      builder.add_round(f, facets[f].surface, *shape, round_elements(*shape, size_here));
      continue;
    }
    FacetMesh& mesh = facet_meshes.meshes[plane];
    if (!mesh.corners.empty()) {
      builder.add_facet(f, facets[f].surface, facet_meshes.planes[plane].normal, std::move(mesh));
    }
    ++plane;
  }
  std::vector<std::string> notes = std::move(facet_meshes.notes);
  facet_meshes = {};
  PatchMesh mesh = builder.finish();
  if (mesh.patch_count() == 0) {
    throw InputError(fmt::format("{}{}no surface has an area; there is nothing to mesh",
                                 scene.file.string(), scene.file.empty() ? "" : ": "));
  }
  lay_on_textures(scene, mesh);
  note_surroundings(scene, round_cut, notes);
  mesh.notes = std::move(notes);
  report(progress, "mesh", 1.0);
  return mesh;
}

}  // namespace lightwell
