#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/io/pov/pov_value.h"
#include "scene/io/remarks.h"

namespace lightwell {

/// Colours of a surface: an even one, or those of a pattern or a picture.
struct PovPigment {
  PovVector color{.count = 5};                      ///< an even colour, or the mean of the pattern
  std::string_view pattern{};                       ///< "checker", "bozo" ...; empty: even
  std::vector<PovVector> list{};                    ///< of patterns that take a list of colours
  std::vector<std::pair<double, PovVector>> map{};  ///< of patterns from 0 to 1
  const PovNode* picture = nullptr;                 ///< the block `image_map`
  bool by_uv = false;
  Eigen::Affine3d to_surface = Eigen::Affine3d::Identity();  ///< from the pattern's own space
};

/// Shares of light, before the colour of the pigment.
struct PovFinish {
  double diffuse = 0.6, behind = 0.0;  ///< reflected, and passed through to the other side
  Eigen::Array3d ambient = Eigen::Array3d::Constant(0.1), emission = Eigen::Array3d::Zero();
  double phong = 0.0, phong_size = 40.0, specular = 0.0, roughness = 0.05;
  double metallic = 0.0;  ///< of highlights
  Eigen::Array3d least_reflection = Eigen::Array3d::Zero(),
                 reflection = Eigen::Array3d::Zero();  ///< of steep and of grazing light
  double falloff = 1.0, reflection_metallic = 0.0;
  bool is_fresnel = false;
};

struct PovTexture {
  PovPigment pigment{};
  PovFinish finish{};
  bool has_normal = false;
};

struct PovInterior {
  double index = 1.0;
  double fade_distance = 0.0, fade_power = 0.0;
  PovVector fade_color{.count = 5};
};

/// Lays the blocks `parts` (texture, pigment, finish, normal) over each other in order, each on the
/// state that the one before left. Notes what counts by its mean, and what is left out, under
/// `name`. Blocks are counted as by count_pov_visit().
PovTexture pov_texture(const std::vector<const PovNode*>& parts, const std::string& name,
                       Remarks& remarks, std::int64_t& visits);

/// Counts a block that is looked at: names let few blocks stand for very many. Throws LimitError
/// beyond 10 million.
void count_pov_visit(const PovNode& node, std::int64_t& visits);

/// Reads a block `interior`.
PovInterior pov_interior(const PovNode& interior);

/// Mean of a map of colours, which is linear between its entries and even beyond them.
PovVector pov_mean(const std::vector<std::pair<double, PovVector>>& map);

}  // namespace lightwell
