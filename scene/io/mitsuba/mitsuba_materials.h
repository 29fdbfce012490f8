#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/io/mitsuba/mitsuba_colors.h"
#include "scene/io/mitsuba/mitsuba_tree.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Converts BSDFs and area emitters of a Mitsuba scene to materials (mapping in
/// docs/scene-format.md). Every pair of a BSDF and an emitter that occurs makes one material.
class MitsubaMaterials {
 public:
  MitsubaMaterials(const MitsubaTree& tree, Scene& scene, Remarks& remarks)
      : tree_(tree), scene_(scene), remarks_(remarks), colors_(tree, remarks) {}

  /// Index of a shape's material in the scene, added if new.
  int of_shape(const MitsubaNode& shape, const std::string& shape_name);

 private:
  Material read_or_default(const MitsubaNode& bsdf);
  Material read(const MitsubaNode& bsdf, Pixels pixels);
  Material read_new(const MitsubaNode& bsdf, Pixels pixels);
  Material diffuse(const MitsubaNode& bsdf, std::string_view property, Pixels pixels);
  Material conductor(const MitsubaNode& bsdf, Pixels pixels);
  Material dielectric(const MitsubaNode& bsdf, Pixels pixels);
  Material transmitter(const MitsubaNode& bsdf, Pixels pixels);
  Material plastic(const MitsubaNode& bsdf, Pixels pixels);
  Material coated(const MitsubaNode& bsdf, Material material, Pixels pixels);
  void add_gloss(const Material& part, float weight, const MitsubaNode& bsdf, Material& sum);
  Material highlighted(const MitsubaNode& bsdf, Pixels pixels);
  Material principled(const MitsubaNode& bsdf, Pixels pixels);
  Material clear_principled(const MitsubaNode& bsdf, const Spectrum& color, double alpha);
  void pass_thin(const MitsubaNode& bsdf, const Spectrum& color, double alpha, Material& material);
  Material masked(const MitsubaNode& bsdf, const MitsubaNode& inner);
  Material wrapped(const MitsubaNode& bsdf, Pixels pixels);
  Material two_sided(const MitsubaNode& bsdf, Pixels pixels);
  Material blend(const MitsubaNode& bsdf, Pixels pixels);
  double roughness(const MitsubaNode& bsdf);
  // The first channel of a bitmap or checkerboard, times its factor; empty for other properties.
  std::optional<ShareTexture> share_picture(const MitsubaNode& bsdf, std::string_view property);
  // A number, or the mean of share_picture().
  double mean_or(const MitsubaNode& bsdf, std::string_view property, double otherwise);
  void vary_gloss(const MitsubaNode& bsdf, Material& material);
  void vary_principled(const MitsubaNode& bsdf, const Spectrum& color, double index,
                       Material& material);
  static double index(const MitsubaNode& bsdf, std::string_view property, double otherwise);
  static double index_ratio(const MitsubaNode& bsdf, double inside);
  void add_emission(const MitsubaNode& emitter, const std::string& name, Material& material);

  const MitsubaTree& tree_;
  Scene& scene_;
  Remarks& remarks_;
  MitsubaColors colors_;
  std::map<std::pair<const MitsubaNode*, Pixels>, Material> known_;
  std::set<const MitsubaNode*> open_;  // BSDFs being read; one met again refers to itself
  std::map<std::pair<const MitsubaNode*, const MitsubaNode*>, int> index_of_;
};

}  // namespace lightwell
