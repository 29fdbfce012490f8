#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "mesh/patches/pictured_emission.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/gather/bright_patches.h"
#include "radiosity/sky/sky_light.h"
#include "radiosity/solution/solution.h"
#include "raytrace/cameras/pixel_cone.h"
#include "raytrace/caustics/caustic_map.h"
#include "raytrace/product_cuts/gathered_light.h"
#include "raytrace/shading/dome_on_mesh.h"
#include "raytrace/shading/facet_shapes.h"
#include "raytrace/shading/irradiance_records.h"
#include "raytrace/shading/lamp_samples.h"
#include "raytrace/shading/picture_base_gains.h"
#include "raytrace/shading/pixel_gather.h"
#include "raytrace/shading/ray_sample.h"
#include "raytrace/shading/render_options.h"
#include "raytrace/shading/visible_lamps.h"
#include "raytrace/virtual_lights/virtual_lights.h"
#include "scene/facet_normals.h"
#include "scene/facet_relief.h"
#include "scene/facet_textures.h"
#include "scene/receiver_gain.h"
#include "scene/sampling.h"
#include "scene/scene.h"
#include "scene/specular.h"

namespace lightwell {

/// Whitted's ray tree (1980) over a radiosity solution. Radiance at a hit is the sum over the parts
/// of the material:
/// - diffuse: L = (M + rho E) / pi, for a translucent sheet (M + rho E + tau E_behind) / pi;
/// - mirror: specular * L(reflected), with a coat times Fresnel's reflectance;
/// - base under a coat: L = (M + rho g(out) E) / pi, with E as the base gets it, see ReceiverGain;
/// - clear dielectric: R L(reflected) + (1 - R) tint L(refracted) with Fresnel's R;
/// - regular transmittance of a sheet: tau_r L(straight on);
/// - rough mirror or dielectric: the mean over some directions of its lobe, see sample_scattering.
///
/// Smooth surfaces polarise the light, which decides over its share at the surfaces behind them
/// (see Polarisation). A branch below RenderOptions::min_contribution no longer forks: it is
/// reflected or crosses by chance, with the weight of both, and ends by Russian roulette below a
/// tenth of that. So many weak branches together lose nothing in the mean.
///
/// Within an absorbing body L falls by the law of Beer and Lambert, see Media and AbsorbingBodies.
/// Refraction leaves the basic radiance L / n^2 unchanged (see radiance_scale), so a path that ends
/// outside again has no factor n^2.
///
/// The *fingerprint* is equal for two rays whose trees see the same smooth surfaces from the same
/// sides in the same order. Branches that weigh less than RenderOptions::contrast are left out,
/// since a single such branch cannot change a pixel by more than the contrast. Surfaces seen by way
/// of rough surfaces are left out too.
///
/// Rough mirrors and coats draw directions towards what their site sees of the sky (see SkySites)
/// beside those of their lobes, weighted by the balance heuristic (Veach & Guibas 1995). Otherwise
/// a window in a rough floor would be found by chance.
///
/// If a surface has normals at vertices, diffuse reflection, mirrors and glass use the interpolated
/// normals (Phong 1975). The facets alone decide which side is seen and what is hidden. No branch
/// continues below the facet that it should leave (see visible_normal). Shadow rays start on the
/// smooth surface that the facets approximate, so that neighbouring facets do not shade it (Hanika
/// 2021, "Hacking the Shadow Terminator"); since the start lies before the facet, no light comes
/// through the facet.
///
/// Relief bends the normal of mirrors, glass and coats by its slope, and gives each light that
/// falls on a diffuse surface a gain (see ReliefSlope). The solution's indirect light has
/// the gain of its indirect_slant(), and the mesh's light that a coated base gets has that of
/// picture_base_gains(); caustics have none. In Pass::automatic the dome's light on relief gets
/// rays. Where no picture is made (trace_lamps, trace_chain), surfaces are flat.
///
/// Branches that meet a coat behind another coat end by Russian roulette: far from grazing they
/// have less than a hundredth of the light.
///
/// A lamp by way of a rough coat and further surfaces is found by chance only, which would show as
/// a few bright pixels. The light of lamps in one sample of the coat's lobe is limited to four
/// times the mean of the other samples, and twice what the lobe finds besides.
///
/// Rough mirrors and rough glass find by chance all that lies behind a further smooth surface:
/// nothing is aimed through that. One of many samples has such light apart, in
/// RaySample::by_chance, so that the mean of the pixel can limit it.
///
/// Openings and bodies of luminaires are seen as VisibleLamps says, by the eye and by way of
/// mirrors and glass; bodies also by way of rough surfaces, which sample the lamps themselves. A
/// body blocks no light: a rough surface mirrors the emitters and the sky behind it, which it
/// samples as well.
///
/// Behind a coat that mirrors less than a quarter of the light, or blurs it, diffuse surfaces show
/// the solution's irradiance: shadow rays there would cost more than those of the coated surface.
/// Surfaces behind a rough surface do so too whose lobe spreads their light over an element of the
/// mesh or more, since nothing is seen of what the mesh lacks there. In Pass::virtual_lights, which
/// has no solution, one light of each kind stands for all there.
///
/// A surface whose shares vary by a pattern has at each hit the numbers of the place (see
/// material_at()).
///
/// Textures and patterns are filtered over the PixelCone of a ray, which grows with the length of
/// the path as if all surfaces on the way were flat.
class RayTree {
 public:
  RayTree(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
          const RadiositySolution& solution, const RenderOptions& options);

  /// Traces a ray. `key` decides the shadow samples; `effort`, (0, 1], scales their number, for
  /// samples that are averaged with others.
  RaySample trace(const Ray& ray, std::uint64_t key, float effort = 1.0f,
                  const PixelCone& cone = {}) const;
  /// Returns the sample of a ray that shows nothing: black.
  RaySample nothing() const { return {.radiance = Spectrum::Zero(scene_.bands.count())}; }
  /// Traces one of many samples of the same key that are averaged, numbered from 0. Each has few
  /// shadow and gather rays and one direction per rough surface; these are well spread over all
  /// samples.
  RaySample trace_one_of_many(const Ray& ray, std::uint64_t key, int number,
                              const PixelCone& cone = {}) const {
    return trace_one_of_many(ray, key, number, caster_, cone);
  }
  /// Traces one of many samples with `caster`, the result of ElementCaster::at() of a caster that
  /// knows the scene's motions.
  RaySample trace_one_of_many(const Ray& ray, std::uint64_t key, int number,
                              const ElementCaster& caster, const PixelCone& cone = {}) const;
  /// Traces one of many samples and leaves the direct light of clustered lights at diffuse
  /// surfaces to gathered_light(): adds these places to `points`, which keep a reference to
  /// `caster`. Light found by chance and weak reflections stay with the sample. Precondition:
  /// gathers_light().
  RaySample trace_to_gather(const Ray& ray, std::uint64_t key, int number,
                            const ElementCaster& caster, const PixelCone& cone,
                            std::vector<PixelPoint>& points) const;
  /// True if pixels of many samples find direct light by product cuts: there are clusters of
  /// lights, a solution says about how bright places are, and no layer shows a part of the light.
  bool gathers_light() const;
  /// Radiance that places of many samples of one pixel send by direct light, sum over these.
  /// `other`: the same samples' sum of all other radiance, mean of the bands.
  GatheredLight gathered(const std::vector<PixelPoint>& points, std::uint64_t key,
                         double other) const;
  /// Radiance along a ray, W/(m^2 sr), of DirectLight's lights by way of mirrors, gloss and clear
  /// bodies alone. Left out:
  /// - light straight through clear panes, which is direct light;
  /// - light of diffuse surfaces and of the sky's dome, which hemisphere rays find;
  /// - lamps without surface and the sun behind smooth surfaces alone, which rays find by chance
  ///   only; `visit` gets the parts of such paths.
  ///
  /// One direction leaves each rough surface; `key` decides this direction.
  Spectrum trace_lamps(const Ray& ray, std::uint64_t key,
                       const std::function<void(const SpecularSegment&)>& visit = {}) const;
  /// Calls `visit` for the straight parts of the path that takes `turns` at the smooth surfaces it
  /// meets.
  void trace_chain(const Ray& ray, const ChainTurns& turns,
                   const std::function<void(const SpecularSegment&)>& visit) const;
  /// Returns the fingerprint of a ray, without shadow rays.
  std::uint64_t fingerprint(const Ray& ray, const PixelCone& cone = {}) const {
    return outline(ray, cone).fingerprint;
  }
  /// Returns RaySample::sees_gloss of a ray, without shadow rays.
  bool sees_gloss(const Ray& ray) const { return outline(ray, {}).sees_gloss; }
  /// Takes indirect light from records where these serve, in place of the solution; null: nowhere.
  /// Precondition: Pass::automatic or Pass::interpolate.
  void set_records(std::shared_ptr<const IrradianceRecords> records);
  /// The caster of everything at rest.
  const ElementCaster& caster() const { return caster_; }
  /// The luminaires that rays of the tree meet beside the surfaces.
  const VisibleLamps& visible_lamps() const { return *visible_lamps_; }
  /// Share, per band, that absorbing bodies leave of light over `distance` m from a ray's origin.
  Spectrum left_along(const Media& media, const Ray& ray, double distance) const;
  /// Adds light that arrives from a mirror, glass or gloss to the radiance and the layers of a
  /// sample.
  void add_specular(const Spectrum& light, RaySample& sample) const;

 private:
  /// A point hit by a ray. The normal is unit and on the side that the ray came from.
  struct ShadingPoint {
    Eigen::Vector3d position, normal;
    Eigen::Vector3d rest, rest_normal;  ///< position and normal in the rest pose
    /// Motion from the rest pose; null: the surface stands still.
    const Eigen::Isometry3d* pose = nullptr;

    Eigen::Vector3d turned(const Eigen::Vector3d& v) const { return pose ? pose->linear() * v : v; }
    Eigen::Vector3d turned_back(const Eigen::Vector3d& v) const {
      return pose ? Eigen::Vector3d(pose->linear().transpose() * v) : v;
    }
  };
  /// A ray of the tree.
  struct Branch {
    Ray ray{};
    Spectrum weight{};  ///< share of the ray's radiance that reaches the eye, per band
    int depth = 0;
    /// Number in the tree: 1 for the root, 2 p and 2 p + 1 for the children of p, a random key for
    /// branches off rough surfaces.
    std::uint64_t node = 1;
    bool is_sharp = true;     ///< no rough surface on the way
    bool is_direct = true;    ///< nothing but smooth thin panes on the way, straight through
    std::uint64_t chain = 0;  ///< see SpecularSegment
    ChainTurns turns{};       ///< see SpecularSegment
    /// Probability density of the direction, 1/sr, off a rough surface, which samples lamps as
    /// well; else 0.
    double lobe_density = 0.0;
    /// The rough surface at the branch's origin, if lobe_density is above 0.
    const LobeView* lobe = nullptr;
    /// View by which the rough surface at the branch's origin aims at bright patches as well; null:
    /// no such rays.
    const BrightPatches::View* bright = nullptr;
    bool is_aimed = false;   ///< aimed at a bright patch
    bool is_hidden = false;  ///< behind a smooth surface that lies behind a rough one
    /// Site by which the rough surface at the start of the path aims at the sky as well, if nothing
    /// but clear panes followed; null: no such rays.
    const SkySites::Site* sky = nullptr;
    double sky_lobe_density = 0.0;  ///< lobe_density of that surface's direction
    int behind_coat = 0;  ///< surfaces on the way from the first coat on, that one included
    double scale = 1.0;   ///< part of `weight` that is radiance_scale() of surfaces on the way
    PixelCone cone{};     ///< of the ray, from its origin on
    /// Width over which rough surfaces on the way spread the ray's light, from its origin on: about
    /// the square root of a lobe's solid angle for each metre behind it.
    PixelCone blur{};
    Media media{};
    Polarisation polarisation{};

    /// Share of light that surfaces on the way leave, in the band where most is left. Decides which
    /// branches are worth following: in glass all weights are smaller by n^2.
    float share() const { return weight.maxCoeff() / static_cast<float>(scale); }
  };
  /// Irradiance at a point, W/m^2, direct and indirect, as its ReceiverGain weighs it.
  struct Arriving {
    Spectrum direct{}, indirect{};
    Spectrum on_facet{};  ///< all light, before coat and relief, for layers; empty: the sum
    float noise = 0.0f;   ///< standard error of `direct`, mean of the bands, W/m^2
  };
  /// Direct light at a point and its standard error, mean of the bands, both W/m^2.
  struct DirectPart {
    Spectrum irradiance{};
    float noise = 0.0f;
  };
  /// Diffuse radiosity towards a ray without emission, W/m^2, of direct and of indirect light.
  struct Scattered {
    Spectrum direct{}, indirect{};
  };
  /// State and result of a tree while it grows.
  struct TreeState {
    RaySample result{};
    std::uint64_t key = 0;
    float effort = 1.0f;
    const ElementCaster* caster = nullptr;
    bool shades = true;        ///< false: fingerprint alone
    bool lamps_alone = false;  ///< see trace_lamps
    const std::function<void(const SpecularSegment&)>* visit = nullptr;
    const ChainTurns* turns = nullptr;  ///< the one path to follow; null: all
    std::optional<int> number{};  ///< number among many samples of one key; none: a sample alone
    std::uint64_t gloss_key = 0;  ///< the same for all samples of one key
    /// Gets the light of lamps that a sample of a coat's lobe finds by chance; null: such light
    /// counts as all other.
    Spectrum* by_chance = nullptr;
    std::vector<PixelPoint>* points = nullptr;  ///< see trace_to_gather(); null: none are left
  };

  RaySample trace_sample(const Ray& ray, std::uint64_t key, int number, const ElementCaster& caster,
                         const PixelCone& cone, std::vector<PixelPoint>* points) const;
  RaySample outline(const Ray& ray, const PixelCone& cone) const;
  void follow(Branch branch, TreeState& state) const;
  Spectrum left_before(const Branch& branch, const ElementHit& hit, double distance) const;
  bool shows_lamp(const Branch& branch, const ElementHit& hit, TreeState& state) const;
  void add_body(const Branch& branch, const VisibleLamps::Seen& body, TreeState& state) const;
  void add_light_behind(const Branch& branch, const ElementHit& hit, TreeState& state) const;
  void add_background(const Branch& branch, TreeState& state) const;
  void add_seen(const Branch& branch, const Spectrum& L, TreeState& state) const;
  void split(const Branch& branch, const ElementHit& hit, const ShadingPoint& at,
             TreeState& state) const;
  int lobe_samples(const SurfaceInteraction& interaction, const Branch& branch,
                   const TreeState& state) const;
  void scatter(const Branch& branch, const SurfaceInteraction& interaction, const ElementHit& hit,
               const ShadingPoint& at, TreeState& state) const;
  static Spectrum radiance_weight(const SurfaceInteraction& interaction,
                                  const ScatteringSample& sample);
  void add_lamp(const Branch& branch, const SurfaceInteraction& interaction, const LobeView& view,
                const ElementHit& hit, const ShadingPoint& at, const Eigen::Array4d& u, float share,
                TreeState& state) const;
  void add_free_source(const Branch& branch, const SurfaceInteraction& interaction,
                       const LobeView& view, const ElementHit& hit, const ShadingPoint& at,
                       const Eigen::Array4d& u, float share, TreeState& state) const;
  void add_bright_patch(const Branch& branch, const SurfaceInteraction& interaction,
                        const ElementHit& hit, const ShadingPoint& at,
                        const BrightPatches::View& view, const Eigen::Array4d& u, float share,
                        TreeState& state) const;
  const SkySites::Site* sky_site(const Branch& branch, const SurfaceInteraction& interaction,
                                 const ElementHit& hit, const ShadingPoint& at,
                                 const TreeState& state) const;
  void add_sky(const Branch& branch, const SurfaceInteraction& interaction, const ElementHit& hit,
               const ShadingPoint& at, const SkySites::Site& site, const Eigen::Array4d& u,
               float share, TreeState& state) const;
  float share_of_bright(const Branch& branch, const ElementHit& hit, const ShadingPoint& at) const;
  Spectrum emission(const Branch& branch, const ElementHit& hit, const ShadingPoint& at) const;
  const RoughLobe& lobe(int material, bool from_back) const;
  static float mirrored_share(const SurfaceInteraction& interaction);
  bool goes_on_at_coat(const SurfaceInteraction& interaction, Branch& branch,
                       const TreeState& state) const;
  static bool is_by_chance(const Branch& branch, const TreeState& state) {
    constexpr int straight_from_the_coat = 1;
    return state.by_chance && branch.behind_coat > straight_from_the_coat && !branch.is_sharp;
  }
  /// Returns whether light that a branch finds goes to RaySample::by_chance.
  static bool is_apart(const Branch& branch, const TreeState& state) {
    return branch.is_hidden && state.number.has_value();
  }
  static void add_apart(const Spectrum& seen, TreeState& state) {
    Spectrum& sum = state.result.by_chance;
    sum = sum.size() > 0 ? Spectrum(sum + seen) : seen;
  }
  void add_reflected(const Branch& branch, const Spectrum& seen, TreeState& state) const;
  void add_found_by_chance(const std::vector<Spectrum>& found, const Spectrum& other,
                           TreeState& state) const;
  void grow(const Branch& parent, std::uint64_t node, const ScatteringSample& sample,
            const Material& what, const ElementHit& hit, const ShadingPoint& at,
            TreeState& state) const;
  static double roulette(const Branch& branch, int purpose, const TreeState& state);
  void choose_one(const Branch& branch, SmoothScattering& lobes, const TreeState& state) const;
  bool survives(Branch& branch, const TreeState& state) const;
  ShadingPoint shading_point(const Ray& ray, const ElementHit& hit,
                             const ElementCaster& caster) const;
  /// Origin of shadow rays, and the facet that the rays leave; -1: none.
  struct ShadowOrigin {
    Eigen::Vector3d position;
    int facet = -1;
  };
  ShadowOrigin shadow_origin(const ElementHit& hit, const ShadingPoint& at) const;
  Eigen::Vector3d smooth_normal(const ElementHit& hit, const ShadingPoint& at) const;
  /// True if normals for shading may differ from the facet's.
  bool has_own_normals(int facet) const {
    return normals_.is_given(facet) || relief_.is_given(facet);
  }
  void shade(const Branch& branch, const ElementHit& hit, const ShadingPoint& at,
             TreeState& state) const;
  void shade_lamp(const Branch& branch, const ElementHit& hit, const ShadingPoint& at,
                  TreeState& state) const;
  /// Numbers of a pattern about a point; null: the facet has none.
  std::unique_ptr<const Material> pattern_at(const Branch& branch, const ElementHit& hit,
                                             const ShadingPoint& at) const;
  const CoatedBase* base_at(const ElementHit& hit) const {
    return bases_.empty() ? nullptr : bases_.of(facets_[hit.facet].material);
  }
  /// `scattering`: reflectance or transmittance by which the branch sees the light.
  Arriving arriving(const ElementHit& hit, const ShadingPoint& at, const Branch& branch,
                    const CoatedBase* base, const Spectrum& scattering,
                    const TreeState& state) const;
  Arriving arriving_behind(const ElementHit& hit, const ShadingPoint& at, const Branch& branch,
                           const CoatedBase* base, const Spectrum& scattering,
                           const TreeState& state) const;
  /// Effort of one of many samples, as a share of the rays of a sample that stands alone.
  static constexpr float share_of_many = 1.0f / 16.0f;
  bool leaves_point(const LightQuery& query, const ElementHit& hit, const Branch& branch,
                    const Spectrum& scattering, const TreeState& state) const;
  Spectrum reflectance(const Branch& branch, const ElementHit& hit, const ShadingPoint& at) const;
  Eigen::Matrix<double, 3, 2> footprint(const Branch& branch, const ShadingPoint& at) const;
  std::optional<ReliefSlope> relief_at(const Branch& branch, const ElementHit& hit,
                                       const ShadingPoint& at, const Eigen::Vector3d& normal,
                                       const TreeState& state) const;
  Eigen::Vector3d bent_normal(const Branch& branch, const ElementHit& hit, const ShadingPoint& at,
                              const Eigen::Vector3d& normal, const TreeState& state) const;
  Arriving arriving_from_mesh(const ElementHit& hit, const ShadingPoint& at, bool is_dim,
                              const Eigen::Vector3d& normal, const ReceiverGain& gain) const;
  static double width_of(const PixelCone& cone, const Branch& branch, const ShadingPoint& at) {
    return cone.start + cone.spread * (at.position - branch.ray.origin).norm();
  }
  /// Width of a lobe of this density, 1/sr, for each metre.
  static double spread_of_lobe(double density) { return 1.0 / std::sqrt(density); }
  static double cone_width(const Branch& branch, const ShadingPoint& at) {
    return width_of(branch.cone, branch, at);
  }
  bool is_blurred(const Branch& branch, const ElementHit& hit, const ShadingPoint& at) const;
  float mesh_gain(BaseGain which, const ElementHit& hit, const CoatedBase* base) const;
  float indirect_gain(const ElementHit& hit, const ShadingPoint& at,
                      const ReceiverGain& gain) const;
  DirectPart direct_light(const ElementHit& hit, const Branch& branch, const LightQuery& query,
                          const Spectrum& scattering, const TreeState& state) const;
  Spectrum indirect_light(const ElementHit& hit, const ShadingPoint& at, const Branch& branch,
                          const LightQuery& query, const TreeState& state) const;
  Arriving arriving_from_one_light(const ElementHit& hit, const ShadingPoint& at,
                                   const Branch& branch, LightQuery query,
                                   const TreeState& state) const;
  NoiseGoal sky_noise(float share, const Spectrum& indirect) const;
  Spectrum indirect_of_mesh(const ElementHit& hit) const;
  std::optional<Spectrum> indirect_of_records(const ShadingPoint& at,
                                              const Eigen::Vector3d& normal) const;
  bool has_photons(const ElementHit& hit) const;
  void add_caustics(const ElementHit& hit, const ShadingPoint& at, bool is_gathered,
                    Spectrum& indirect) const;
  void note_layers(const Branch& branch, const ElementHit& hit, const Spectrum& M,
                   const Spectrum& rho, const Scattered& scattered, const Arriving& E,
                   TreeState& state) const;

  const Scene& scene_;
  const ElementCaster& caster_;
  const DirectLight& direct_light_;
  const RadiositySolution& solution_;
  const RenderOptions& options_;
  std::shared_ptr<const FacetTextures> textures_{};  ///< null: no textures
  PicturedEmission pictured_emission_;
  FacetNormals normals_;
  FacetRelief relief_;
  std::shared_ptr<const BandArray> slant_{};       ///< see indirect_slant(); null or empty: none
  std::shared_ptr<const BandArray> base_gains_{};  ///< see picture_base_gains(); null or empty: 1
  /// Least height of a shadow ray's origin over its facet, m, beyond rounding.
  double least_lift_ = 0.0;
  bool with_layers_ = false;
  Eigen::Array3f white_rgb_;             ///< RGB of a reflectance of 1 under equal-energy light
  std::optional<PixelGather> gather_{};  ///< for Pass::gather
  std::shared_ptr<const VirtualLights> virtual_{};      ///< for Pass::virtual_lights
  DomeOnMesh dome_{};                                   ///< for Pass::automatic
  std::shared_ptr<const IrradianceRecords> records_{};  ///< null: none
  std::shared_ptr<const CausticMap> caustics_{};  ///< replaces the solution's caustics; null: none
  static constexpr int gloss_point_count = 1024;
  SobolPoints gloss_points_;  ///< samples of one key; further samples use a new scrambling
  LampSamples lamps_;
  std::shared_ptr<const VisibleLamps> visible_lamps_{};
  BrightPatches bright_{};  ///< rough mirrors aim at these beside the lamps
  /// Lobes of the front and the back of each material; empty if the material is not rough.
  std::vector<std::array<std::optional<RoughLobe>, 2>> lobes_{};
  CoatedBases bases_;
  bool absorbs_ = false;  ///< whether any body absorbs light
  FacetShapes facets_;
};

}  // namespace lightwell
