#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "radiosity/direct_light/direct_light.h"
#include "radiosity/journal/run_control.h"
#include "radiosity/solution/solution.h"
#include "raytrace/pictures/image.h"
#include "raytrace/pictures/layers.h"

namespace lightwell {

class CausticMap;
class IrradianceRecords;
class VirtualLights;
class VisibleLamps;

/// Source of irradiance at a diffuse hit.
enum class Pass {
  interpolate,     ///< direct and indirect light interpolated from the solution
  direct,          ///< direct light by shadow rays, indirect light interpolated
  gather,          ///< direct light by shadow rays, indirect light by a final gather at every hit
  virtual_lights,  ///< direct light by shadow rays, indirect light by VirtualLights, without a
                   ///< solution
  automatic,       ///< as `direct`, but the dome's light interpolated where the mesh is fine
};

/// Options of many samples per pixel in place of subdivision: for pictures with a lens or motion,
/// and for pixels that show gloss.
struct SampleOptions {
  /// Most samples of every pixel; 0: most_by_default with a lens or motion and in pixels that show
  /// rough surfaces, else none.
  int most = 0;
  int least = 16;  ///< first samples of every pixel
  /// Greatest standard error of a pixel, relative to its mean. Half the error takes four times as
  /// many samples.
  float noise = 0.02f;

  static constexpr int most_by_default = 256;
  static constexpr int limit = 1 << 16;
};

struct RenderOptions {
  Pass pass = Pass::automatic;
  /// Most mirrors and clear surfaces along one path of the ray tree, at least 128. Photons and
  /// gathers end by chance beyond this number where they are weak.
  int max_depth = 10;
  /// Branches of less weight do not fork, and end by chance below a tenth of it.
  float min_contribution = 1e-3f;
  ShadowOptions shadows{};
  /// Rays over the hemisphere of a hit for Pass::gather, and of a record for Pass::automatic; 1 to
  /// most_gather_rays.
  int gather_rays = 256;
  /// Pass::automatic: indirect light by IrradianceRecords where the solution's is coarse. A film
  /// does without, since records differ from picture to picture by their noise.
  bool has_records = true;
  /// Result of find_records() for the same camera, shared by several pictures of it (see
  /// SceneRenderer::records). Null: found for this picture, if it has records.
  std::shared_ptr<const IrradianceRecords> records{};
  /// VirtualLights, for Pass::virtual_lights; 1 to most_virtual_lights.
  int virtual_lights = 4096;
  /// The virtual lights of the scene, shared as `caustics` is. Null: found for this picture.
  std::shared_ptr<const VirtualLights> found_virtual_lights{};
  /// Photons from emitters through mirrors and glass, for caustics of Pass::direct and
  /// Pass::gather: see CausticMap. 0: the solution's caustics, as sharp as its mesh.
  int photons = 1 << 19;
  /// Result of trace_caustics() for the same number of photons and depth, shared by several
  /// pictures (see SceneRenderer). Null: traced for this picture.
  std::shared_ptr<const CausticMap> caustics{};
  /// Result of indirect_slant() for the same depth, shared as `caustics` is. Null: found for this
  /// picture.
  std::shared_ptr<const BandArray> slant{};
  /// Result of picture_base_gains(), shared as `caustics` is. Null: found for this picture.
  std::shared_ptr<const BandArray> base_gains{};
  /// The luminaires as pictures show them, shared as `caustics` is. Null: found for this picture.
  std::shared_ptr<const VisibleLamps> visible_lamps{};
  /// Rays from the first rough surface of a path, 1 to 256; one from each rough surface behind it.
  int glossy_rays = 8;
  SampleOptions sampling{};
  /// Adaptive supersampling (Whitted 1980): a pixel whose corners differ by more than `contrast`
  /// (relative) and the noise of the sky's light, show different surfaces or have more of that
  /// noise than SampleOptions::noise allows is split in four, at most `max_subdivision` times, 0 to
  /// deepest_subdivision. Measured on the Cornell box: contrast 0.05 takes 1.7 times as long as 0.1
  /// for the same error.
  int max_subdivision = 2;
  float contrast = 0.1f;
  std::vector<Layer> layers{};  ///< layers of Image::layers
  RunControl run{};  ///< its journal keeps finished tiles; a journal belongs to one scene
  /// Called by the rendering thread when rows first_row to first_row + rows - 1 of the picture are
  /// done, from the top down: lets viewers show unfinished pictures.
  std::function<void(const Image& image, int first_row, int rows)> rows_done{};
};

constexpr int most_gather_rays = 1 << 16;
constexpr int most_virtual_lights = 1 << 20;

/// Greatest RenderOptions::max_subdivision.
constexpr int deepest_subdivision = 6;

/// Greatest RenderOptions::max_depth; deeper recursion might exhaust a thread's stack.
constexpr int deepest_tree = 1000;

/// Throws std::invalid_argument if a number is out of its range.
void validate(const RenderOptions& options);

/// Returns whether pictures with these options use the photons of trace_caustics().
bool needs_caustic_photons(const RadiositySolution& solution, const RenderOptions& options);

}  // namespace lightwell
