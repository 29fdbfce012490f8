#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/emitters/direct_light.h"
#include "radiosity/gather/bright_patches.h"
#include "radiosity/solution/solution.h"
#include "raytrace/caustic_map.h"
#include "raytrace/lamp_samples.h"
#include "raytrace/pixel_gather.h"
#include "raytrace/render.h"
#include "scene/facet_normals.h"
#include "scene/facet_textures.h"
#include "scene/sampling.h"
#include "scene/scene.h"
#include "scene/specular.h"

namespace lightwell {

/// What one look along a ray found.
struct RaySample {
  Spectrum radiance{};  ///< W/(m^2 sr)
  /// What a pixel averages beside radiance; zero unless RenderOptions::layers has any of them.
  SampledLayers layers = SampledLayers::Zero();
  std::uint64_t fingerprint = 0;  ///< of the surfaces seen, see RayTree
  std::int64_t depth_cut = 0;     ///< branches that max_depth ended
  float cut_weight = 0.0f;        ///< sum of what they weighed, the largest of the bands
};

/// Whitted's ray tree (1980) over a radiosity solution. Where a ray meets something diffuse,
/// L = (M + rho E) / pi; mirrors add specular * L(reflected); clear dielectrics add
/// R L(reflected) + (1 - R) tint L(refracted) with Fresnel's R. Rough ones add the mean over some
/// directions of their lobe, see sample_scattering. Within a body that absorbs, L is less by Beer
/// and Lambert's law, see Media.
///
/// L inside a dielectric is the basic radiance L/n^2, which refraction leaves unchanged; a path
/// that ends outside again needs no factor n^2.
///
/// The *fingerprint* is equal for two rays whose trees see the same smooth surfaces from the same
/// sides in the same order; branches that weigh less than RenderOptions::contrast are left out, for
/// they alone cannot change a pixel by more, and so is what is seen by way of rough surfaces.
///
/// Where a surface gives normals at vertices, mirrors, glass and what is diffuse take those for it
/// (Phong 1975), while the facets decide which side is seen and what hides what. Nothing goes on
/// below the facet that it was to leave (see visible_normal), and shadow rays leave from the smooth
/// surface that the facet stands for, so that the facets around do not shade it (Hanika 2021,
/// "Hacking the Shadow Terminator"): they are real rays from a place before the facet, and no light
/// comes through it.
///
/// Textures are filtered over what a ray's pixel covers: a cone (Amanatides 1984) as wide as
/// `pixel_width` times the way it has gone, as if all surfaces on the way were flat.
class RayTree {
 public:
  RayTree(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
          const RadiositySolution& solution, const RenderOptions& options,
          double pixel_width = 0.0);

  /// `key` decides the shadow samples; `effort`, (0, 1], scales their number, for samples that are
  /// averaged with others.
  RaySample trace(const Ray& ray, std::uint64_t key, float effort = 1.0f) const;
  /// One of many samples that are averaged with others of the same key, numbered from 0: with few
  /// shadow and gather rays and one direction per rough surface, well spread over all of them.
  RaySample trace_one_of_many(const Ray& ray, std::uint64_t key, int number) const {
    return trace_one_of_many(ray, key, number, caster_);
  }
  /// The same by what ElementCaster::at() makes of a caster of the scene that knows what moves.
  RaySample trace_one_of_many(const Ray& ray, std::uint64_t key, int number,
                              const ElementCaster& caster) const;
  /// The fingerprint alone, without shadow rays.
  std::uint64_t fingerprint(const Ray& ray) const;

 private:
  /// How a facet meets a ray.
  struct FacetShape {
    int material = 0;
    int smooth_surface = 0;  ///< the same for facets that share vertices
    bool is_sphere = false;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< on the plane, or the sphere's centre
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  };
  /// A place that was met; the normal is unit and on the side the ray came from.
  struct ShadingPoint {
    Eigen::Vector3d position, normal;
    Eigen::Vector3d rest, rest_normal;        ///< the same where what moves rests
    const Eigen::Isometry3d* pose = nullptr;  ///< from there; null: it stands still

    Eigen::Vector3d turned(const Eigen::Vector3d& v) const { return pose ? pose->linear() * v : v; }
    Eigen::Vector3d turned_back(const Eigen::Vector3d& v) const {
      return pose ? Eigen::Vector3d(pose->linear().transpose() * v) : v;
    }
  };
  /// A ray of the tree.
  struct Branch {
    Ray ray{};
    Spectrum weight{};  ///< share of what it sees that reaches the eye
    int depth = 0;
    /// 1 for the root, 2 p and 2 p + 1 for the children of p; any for those off rough surfaces.
    std::uint64_t node = 1;
    bool is_sharp = true;  ///< no rough surface on the way
    /// Of its direction, 1/sr, off a rough surface, which samples lamps beside; else 0.
    double lobe_density = 0.0;
    /// By which that draws directions towards bright patches, too; null: it does not.
    const BrightPatches::View* bright = nullptr;
    bool is_aimed = false;  ///< such a direction
    double width = 0.0;     ///< m, of the cone where the ray begins
    Media media{};
  };
  /// Irradiance at a place, W/m^2, by the way light takes.
  struct Arriving {
    Spectrum direct{}, indirect{};
  };
  /// What is gathered while the tree grows.
  struct TreeState {
    RaySample result{};
    std::uint64_t key = 0;
    float effort = 1.0f;
    const ElementCaster* caster = nullptr;
    bool shades = true;
    std::optional<int> number{};  ///< of many samples of one key
    std::uint64_t gloss_key = 0;  ///< the same in all of them
  };

  void follow(Branch branch, TreeState& state) const;
  void add_background(const Branch& branch, TreeState& state) const;
  void split(const Branch& branch, const ElementHit& hit, const ShadingPoint& at,
             TreeState& state) const;
  void scatter(const Branch& branch, const SurfaceInteraction& interaction, const ElementHit& hit,
               const ShadingPoint& at, TreeState& state) const;
  void add_lamp(const Branch& branch, const SurfaceInteraction& interaction, const ElementHit& hit,
                const ShadingPoint& at, const Eigen::Array4d& u, float share,
                TreeState& state) const;
  void add_free_source(const Branch& branch, const SurfaceInteraction& interaction,
                       const ElementHit& hit, const ShadingPoint& at, const Eigen::Array4d& u,
                       float share, TreeState& state) const;
  void add_bright_patch(const Branch& branch, const SurfaceInteraction& interaction,
                        const ElementHit& hit, const ShadingPoint& at,
                        const BrightPatches::View& view, const Eigen::Array4d& u, float share,
                        TreeState& state) const;
  float share_of_bright(const Branch& branch, const ElementHit& hit, const ShadingPoint& at) const;
  Spectrum emission(const Branch& branch, const ElementHit& hit, const ShadingPoint& at) const;
  const RoughLobe& lobe(int material, bool from_back) const;
  void grow(const Branch& parent, std::uint64_t node, const ScatteringSample& sample,
            const ElementHit& hit, const ShadingPoint& at, TreeState& state) const;
  ShadingPoint shading_point(const Ray& ray, const ElementHit& hit,
                             const ElementCaster& caster) const;
  /// Where shadow rays leave from, and the facet they leave; -1: none.
  struct ShadowOrigin {
    Eigen::Vector3d position;
    int facet = -1;
  };
  ShadowOrigin shadow_origin(const ElementHit& hit, const ShadingPoint& at) const;
  Eigen::Vector3d smooth_normal(const ElementHit& hit, const ShadingPoint& at) const;
  void shade(const Branch& branch, const ElementHit& hit, const ShadingPoint& at,
             TreeState& state) const;
  Arriving arriving(const ElementHit& hit, const ShadingPoint& at, const Branch& branch,
                    const TreeState& state) const;
  Spectrum reflectance(const Branch& branch, const ElementHit& hit, const ShadingPoint& at) const;
  double cone_width(const Branch& branch, const ShadingPoint& at) const {
    return branch.width + pixel_width_ * (at.position - branch.ray.origin).norm();
  }
  void add_caustics(const ElementHit& hit, const ShadingPoint& at, Spectrum& indirect) const;
  void note_layers(const Branch& branch, const ElementHit& hit, const Spectrum& M,
                   const Spectrum& rho, const Arriving& E, TreeState& state) const;

  const Scene& scene_;
  const ElementCaster& caster_;
  const DirectLight& direct_light_;
  const RadiositySolution& solution_;
  const RenderOptions& options_;
  double pixel_width_;                               ///< m, one metre away
  std::shared_ptr<const FacetTextures> textures_{};  ///< null: nothing varies over facets
  FacetNormals normals_;
  double least_lift_ = 0.0;  ///< m, off a facet: more than rounding may move a ray's origin
  bool with_layers_ = false;
  Eigen::Array3f white_rgb_;             ///< of what reflects everything, under equal-energy light
  std::optional<PixelGather> gather_{};  ///< for Pass::gather
  std::shared_ptr<const CausticMap> caustics_{};  ///< in place of the solution's; null: none
  static constexpr int gloss_point_count = 1024;
  SobolPoints gloss_points_;  ///< of samples of one key; later ones use a new scrambling
  LampSamples lamps_;
  BrightPatches bright_{};  ///< what rough mirrors aim at beside the lamps
  /// Of the front and the back of each material; empty if it is not rough.
  std::vector<std::array<std::optional<RoughLobe>, 2>> lobes_{};
  bool absorbs_ = false;  ///< there is a body that does
  std::vector<FacetShape> facets_{};
};

}  // namespace lightwell
