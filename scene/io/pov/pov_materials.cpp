#include "scene/io/pov/pov_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "scene/errors.h"
#include "scene/io/glossy.h"
#include "scene/io/sheets.h"
#include "scene/io/text_file.h"
#include "scene/limits.h"

namespace lightwell {
namespace {

Spectrum spectrum_of(const Eigen::Array3d& values) {
  return values.cast<float>();
}

Spectrum shares_of(const Eigen::Array3d& values) {
  return values.max(0.0).min(1.0).cast<float>();
}

float clear_share(const PovVector& color) {
  return static_cast<float>(std::clamp(color.c[3] + color.c[4], 0.0, 1.0));
}

/// Light that passes a surface: all colours by `transmit`, its own colour by `filter`.
Spectrum passed_by(const PovVector& color, double gamma) {
  const Spectrum passed =
      static_cast<float>(color.c[3]) * pov_linear(color, gamma) + static_cast<float>(color.c[4]);
  return passed.max(0.0f).min(1.0f);
}

// Absorption that leaves what the fade leaves behind its distance, 1/m.
Spectrum absorption_of(const PovInterior& interior, double gamma) {
  if (!(interior.fade_distance > 0.0 && interior.fade_power > 0.0)) return {};
  const Spectrum color = pov_linear(interior.fade_color, gamma).min(1.0f);
  constexpr double exponential = 1000.0;  // from this power on the language fades by exp(-d)
  const auto per_metre = static_cast<float>(1.0 / interior.fade_distance);
  if (interior.fade_power >= exponential) return per_metre * (1.0f - color);
  return -per_metre * (0.5f * (1.0f + color)).log();
}

// A picture of 2 x 2 texels, which stands for two cells in each direction.
std::shared_ptr<const Texture> pov_checker(const PovPigment& pigment, double gamma) {
  std::vector<Texture::Code> texels;
  for (const std::size_t color : {0, 1, 1, 0}) {
    const Spectrum linear = pov_linear(pigment.list[color], gamma).min(1.0f);
    for (const float share : linear) texels.push_back(Texture::encode(share));
  }
  return std::make_shared<const Texture>(2, 2, 3, std::move(texels));
}

void set_texture(std::shared_ptr<const Texture> picture, bool is_smooth, float diffuse,
                 Material& material) {
  const Spectrum mean = picture->mean();
  material.reflectance = diffuse * mean;
  material.texture =
      ReflectanceTexture{.image = {.picture = std::move(picture), .is_smooth = is_smooth},
                         .factor = Spectrum::Constant(3, diffuse)};
}

// Ambient light stands in for light between surfaces, which is computed here. From 1 up, or on a
// surface that neither reflects nor emits otherwise, ambient light makes a lamp.
Eigen::Array3d shine_of(const PovFinish& finish, float clear) {
  const bool is_dark = finish.diffuse == 0.0 && !(finish.reflection > 0.0).any() &&
                       !(finish.emission > 0.0).any() && clear == 0.0f;
  Eigen::Array3d shine = finish.emission;
  if (finish.ambient.maxCoeff() >= 1.0 || is_dark) shine += finish.ambient;
  return shine.max(0.0);
}

}  // namespace

Spectrum pov_linear(const PovVector& color, double gamma) {
  Spectrum linear(3);
  for (Eigen::Index band = 0; band < 3; ++band) {
    const double value = std::max(color.c[static_cast<std::size_t>(band)], 0.0);
    linear[band] = static_cast<float>(gamma == 1.0 ? value : std::pow(value, gamma));
  }
  return linear;
}

PovMaterial PovMaterials::of(const PovLook& look, const std::string& name, bool is_closed,
                             bool shines_inside, double gamma) {
  const PovTexture texture = pov_texture(look.parts, name, remarks_, visits_);
  PovMaterial result;
  Material material = make(texture, look, name, is_closed, gamma, result.layout);
  material.emits_both_sides = material.is_emitter() && (!is_closed || shines_inside);
  if (result.layout != PovMaterial::Layout::none) {
    result.to_pattern = (look.to_world * texture.pigment.to_surface).inverse();
    if (!result.to_pattern.matrix().allFinite()) result.layout = PovMaterial::Layout::none;
  }
  const auto [entry, is_new] =
      known_.emplace(material_hash(material), static_cast<int>(scene_.materials.size()));
  result.number = entry->second;
  if (!is_new) return result;
  std::string label;
  for (const PovNode* part : look.parts) {
    if (!part->name.empty()) label = part->name;
    for (const PovItem& item : part->items) {
      if (label.empty() && item.node()) label = item.node()->name;
    }
  }
  material.name = names_.unique(label.empty() ? fmt::format("material of {}", name) : label);
  scene_.materials.push_back(std::move(material));
  return result;
}

Material PovMaterials::make(const PovTexture& texture, const PovLook& look, const std::string& name,
                            bool is_closed, double gamma, PovMaterial::Layout& layout) {
  const PovVector& pigment = texture.pigment.color;
  const PovFinish& finish = texture.finish;
  const Spectrum zero = Spectrum::Zero(3), color = pov_linear(pigment, gamma);
  Material material{.reflectance = zero, .specular = zero, .emission = zero};
  const float clear = clear_share(pigment);
  const PovInterior interior = look.interior ? pov_interior(*look.interior) : PovInterior();
  const Spectrum passed = passed_by(pigment, gamma);
  const bool has_index = interior.index > 1.0 && interior.index <= highest_index;
  if (has_index && clear >= (is_closed ? mostly_clear : nearly_clear)) {
    material.dielectric =
        is_closed ? Dielectric{.index_of_refraction = static_cast<float>(interior.index),
                               .tint = passed,
                               .absorption = absorption_of(interior, gamma)}
                  : thin_pane(interior.index, passed);
    return material;
  }
  const float opaque = 1.0f - clear;
  const Spectrum base = color.min(1.0f) * opaque;
  material.emission =
      (std::numbers::pi_v<float> * opaque * color * spectrum_of(shine_of(finish, clear)))
          .min(most_light);
  const auto diffuse = static_cast<float>(std::clamp(finish.diffuse, 0.0, 1.0));
  material.reflectance = base * diffuse;
  if (!material.is_emitter() && clear == 0.0f) {
    layout = set_picture(texture.pigment, diffuse, name, gamma, material);
  }
  add_gloss(finish, color.min(1.0f), interior.index, name, material);
  if (finish.behind > 0.0) {
    add_diffuse_transmittance(material, base * static_cast<float>(std::min(finish.behind, 1.0)));
  }
  if (clear > 0.0f) add_regular_transmittance(material, passed);
  limit_shares(material);
  if (close_lamp(material)) {
    remarks_.add("Light passes a lamp nowhere straight on, so filter and transmit were left out in",
                 name);
  }
  return material;
}

void PovMaterials::add_gloss(const PovFinish& finish, const Spectrum& color, double index,
                             const std::string& name, Material& material) {
  const auto tinted = [&](double metallic) -> Spectrum {
    const auto part = static_cast<float>(std::clamp(metallic, 0.0, 1.0));
    return part * color + (1.0f - part);
  };
  if ((finish.reflection > 0.0).any()) {
    const Spectrum tint = tinted(finish.reflection_metallic);
    if (finish.is_fresnel && index > lowest_coat_index && index <= highest_index) {
      return lay_simple_coat(material, index, 0.0, tint * shares_of(finish.reflection));
    }
    // The mean over even light of (1 - cos)^f is 2 / ((f + 1)(f + 2)).
    const double f = std::clamp(finish.falloff, 0.0, 100.0);
    const Eigen::Array3d mean =
        finish.least_reflection +
        (finish.reflection - finish.least_reflection) * 2.0 / ((f + 1.0) * (f + 2.0));
    return add_highlight(material, tint * shares_of(mean), 0.0);
  }
  const double strength = std::max(finish.phong, finish.specular);
  if (!(strength > 0.0)) return;
  const double exponent = finish.specular >= finish.phong
                              ? 1.0 / std::clamp(finish.roughness, 1e-6, 1.0)
                              : std::clamp(finish.phong_size, 0.0, 1e6);
  const double alpha = alpha_of_exponent(exponent);
  if (finish.metallic > 0.0) {
    const auto left = static_cast<float>(std::clamp(1.0 - finish.diffuse, 0.0, 1.0));
    const Spectrum share = shares_of(Eigen::Array3d::Constant(strength)).min(left);
    remarks_.mention("Highlights of metals were read as mirrors of their share", name);
    return add_highlight(material, tinted(finish.metallic) * share, alpha);
  }
  if (alpha > glossy_alpha) return;
  remarks_.mention("Highlights were read as a clear coat of the index 1.5", name);
  constexpr double usual_index = 1.5;
  lay_simple_coat(material, usual_index, alpha, Spectrum::Ones(3));
}

PovMaterial::Layout PovMaterials::set_picture(const PovPigment& pigment, float diffuse,
                                              const std::string& name, double gamma,
                                              Material& material) {
  using Layout = PovMaterial::Layout;
  if (pigment.pattern == "checker" && pigment.list.size() == 2) {
    set_texture(pov_checker(pigment, gamma), false, diffuse, material);
    return Layout::checker;
  }
  if (!pigment.picture) return Layout::none;
  PovCursor cursor(*pigment.picture);
  std::string file;
  double map_type = 0.0;
  bool is_once = false, is_smooth = false;
  while (!cursor.at_end()) {
    const PovItem& item = cursor.next();
    if (const auto* text = std::get_if<std::string>(&item.value)) file = *text;
    if (item.word == "map_type") map_type = cursor.number().value_or(0.0);
    if (item.word == "interpolate") is_smooth = cursor.number().value_or(0.0) > 0.0;
    is_once = is_once || item.word == "once";
  }
  const auto grey = [&](const char* what) {
    remarks_.add(what, file.empty() ? name : file);
    material.reflectance.setConstant(0.5f * diffuse);
    return Layout::none;
  };
  const std::filesystem::path path = scene_.file.parent_path() / file;
  if (file.empty() || !is_file(path)) {
    return grey("Pictures are missing, and count as grey of 0.5");
  }
  std::optional<Picture> picture;
  remarks_.attempt("Pictures that cannot be read count as grey of 0.5", file,
                   [&] { picture = pictures_.picture(path, PictureCode::srgb); });
  if (!picture) return grey("Pictures that are neither PNG nor JPEG count as grey of 0.5");
  set_texture(picture->color, is_smooth, diffuse, material);
  if (is_once) remarks_.add("Pictures are repeated although the scene says 'once'", file);
  if (pigment.by_uv) return Layout::by_uv;
  if (map_type == 0.0) return Layout::planar;
  remarks_.add("Pictures that are laid around bodies count by their mean colour", file);
  material.texture.reset();
  return Layout::none;
}

void set_pov_layout(const PovMaterial& material, PolygonMesh& mesh) {
  using Layout = PovMaterial::Layout;
  if (material.layout == Layout::by_uv) return;
  mesh.uv_maps.clear();
  const Eigen::Matrix3d to_pattern = material.to_pattern.linear();
  const Eigen::Vector3d origin = material.to_pattern.translation();
  if (material.layout == Layout::planar) {
    UvMap map{.gradient = to_pattern.topRows<2>(), .offset = origin.head<2>()};
    map.gradient.row(1) *= -1.0;  // pictures have their top first
    map.offset[1] = 1.0 - map.offset[1];
    mesh.uv_maps.push_back(map);
  }
  for (Facet& facet : mesh.facets) {
    facet.uv_map = material.layout == Layout::planar ? 0 : -1;
    if (material.layout != Layout::checker) continue;
    // Cells are cubes of the pattern's space: a facet across an axis shows squares.
    const Eigen::Vector3d across =
        (to_pattern.inverse().transpose() * facet_normal(mesh, facet)).normalized();
    Eigen::Index axis = 0;
    constexpr double aligned = 1e-6;
    if (!(1.0 - across.cwiseAbs().maxCoeff(&axis) < aligned)) continue;
    const Eigen::Index a = (axis + 1) % 3, b = (axis + 2) % 3;
    const Eigen::Vector3d corner =
        material.to_pattern * mesh.vertices[static_cast<std::size_t>(facet.boundary.front())];
    const double layer = std::floor(corner[axis] + aligned);  // a hair above the border of cells
    UvMap map;
    map.gradient.row(0) = 0.5 * to_pattern.row(a);
    map.gradient.row(1) = 0.5 * to_pattern.row(b);
    map.offset = {0.5 * (origin[a] + layer), 0.5 * origin[b]};
    if (mesh.uv_maps.empty() || mesh.uv_maps.back().gradient != map.gradient ||
        mesh.uv_maps.back().offset != map.offset) {
      mesh.uv_maps.push_back(map);
    }
    facet.uv_map = static_cast<int>(mesh.uv_maps.size()) - 1;
  }
}

}  // namespace lightwell
