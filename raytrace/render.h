#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/emitters/direct_light.h"
#include "radiosity/journal/run_control.h"
#include "radiosity/solution/solution.h"
#include "raytrace/image.h"
#include "raytrace/layers.h"
#include "scene/progress.h"

namespace lightwell {

class CausticMap;

/// How a diffuse hit is shaded.
enum class Pass {
  interpolate,  ///< the solution as it is
  direct,       ///< direct light re-traced with shadow rays, indirect light interpolated
  gather,       ///< direct light as above, indirect light by a final gather at every hit
};

/// Many samples per pixel instead of subdivision: for pictures with gloss, a lens or
/// motion.
struct SampleOptions {
  int most = 0;  ///< 0: most_by_default where a lens, motion or rough surfaces ask for it
  int least = 16;
  /// A pixel is done when its standard error is below this share of it. A half of it takes four
  /// times as many samples.
  float noise = 0.02f;

  static constexpr int most_by_default = 256;
  static constexpr int limit = 1 << 16;
};

struct RenderOptions {
  Pass pass = Pass::direct;
  int max_depth = 10;              ///< mirror and glass events along one path of the ray tree
  float min_contribution = 1e-3f;  ///< branches that weigh less are not followed
  ShadowOptions shadows{};
  int gather_rays = 256;  ///< over the hemisphere of a hit, for Pass::gather; 1 to most_gather_rays
  /// Sent from emitters by way of mirrors and glass, for caustics of Pass::direct and
  /// Pass::gather: see CausticMap. 0: those of the solution, as sharp as its mesh.
  int photons = 1 << 19;
  /// What trace_caustics() found with as many photons and this depth, for pictures that share it
  /// (see SceneRenderer). Null: found anew.
  std::shared_ptr<const CausticMap> caustics{};
  int glossy_rays = 8;  ///< from the first rough surface; one from those behind it. 1 to 256
  SampleOptions sampling{};
  /// Whitted's adaptive supersampling: a pixel whose corners differ by more than `contrast`
  /// (relative) or show different surfaces is split in four, at most `max_subdivision` times, 0 to
  /// 6. Measured on the Cornell box: contrast 0.05 takes 1.7 times as long as 0.1 for the same
  /// error.
  int max_subdivision = 2;
  float contrast = 0.1f;
  std::vector<Layer> layers{};  ///< what Image::layers shall hold
  RunControl run{};             ///< the journal keeps finished tiles, of this scene and no other
  /// Called when rows first_row to first_row + rows - 1 of the picture are done, from the top down,
  /// by the thread that renders: to show what there is so far.
  std::function<void(const Image& image, int first_row, int rows)> rows_done{};
};

constexpr int most_gather_rays = 1 << 16;

/// Deeper recursion might exhaust a thread's stack.
constexpr int deepest_tree = 1000;

/// Throws std::invalid_argument where a number lies out of its range.
void validate(const RenderOptions& options);

/// Whether pictures with these options ask for trace_caustics().
bool needs_caustic_photons(const RadiositySolution& solution, const RenderOptions& options);

struct RenderReport {
  double seconds = 0.0;
  std::int64_t eye_rays = 0;   ///< pixel samples
  std::int64_t depth_cut = 0;  ///< branches that max_depth ended
  /// Their weight, a mean over the samples: the share of the picture that is missing, if what they
  /// did not see is as bright as the rest.
  double cut_share = 0.0;
  int tiles = 0, recalled_tiles = 0;  ///< all, and those the journal had; no rays are counted there
};

/// Second pass: Whitted's recursive ray tracing (1980) over the radiosity solution. A pixel is the
/// mean radiance over its square or, with a lens, gloss or motion, what PixelSamples finds. The
/// same bits for any number of threads. Throws InputError where Camera's shutter has its middle at
/// another time than RigidMotion::rest_time: light is solved for one instant, and carried along by
/// what moves; shadows and what is gathered are sampled in time.
Image render(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
             const RadiositySolution& solution, const Camera& camera,
             const RenderOptions& options = {}, RenderReport* report = nullptr);

}  // namespace lightwell
