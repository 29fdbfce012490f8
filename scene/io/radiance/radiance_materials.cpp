#include "scene/io/radiance/radiance_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "scene/errors.h"
#include "scene/io/default_material.h"
#include "scene/io/pictures/environment_file.h"
#include "scene/io/radiance/files/radiance_loader.h"
#include "scene/io/radiance/patterns/radiance_place.h"
#include "scene/io/radiance/text/radiance_bands.h"
#include "scene/io/radiance/text/radiance_expression.h"
#include "scene/io/sheets.h"

namespace lightwell {
namespace {

constexpr int deepest_modifier = 64;  // modifiers of modifiers; real scenes stay below ten

// Value of a formula that needs neither a function file nor a position, such as ".5" or "A1/2".
double constant_value(const std::string& formula, const RadiancePrimitive& of) {
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= of.reals.size(); ++i) names.push_back(fmt::format("A{}", i));
  try {
    return RadianceExpression(formula, names, of.location).value_or_nan(of.reals);
  } catch (const InputError&) {
    return std::nan("");
  }
}

// Multiplies `result` by a brightfunc or colorfunc without variables; false for other patterns.
bool is_constant(const RadiancePrimitive& p, RadiancePattern& result) {
  const std::size_t functions = p.type == "brightfunc" ? 1 : p.type == "colorfunc" ? 3 : 0;
  if (functions == 0 || p.strings.size() < functions) return false;
  Spectrum factor(3);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const std::size_t of = std::min(static_cast<std::size_t>(i), functions - 1);
    factor[i] = static_cast<float>(constant_value(p.strings[of], p));
  }
  if (!(factor >= 0.0f).all() || !factor.isFinite().all()) return false;
  result.factor *= factor;
  return true;
}

// Functions of rayinit.cal that a colorpict applies to r, g and b.
constexpr std::array<std::string_view, 8> picture_functions = {
    "red", "green", "blue", "clip_r", "clip_g", "clip_b", "grey", "clipgrey"};

// Means of these functions over the pixels of a picture.
Spectrum means_of(const BandArray& pixels) {
  Eigen::ArrayXXd values(pixels.rows(), 4);
  values.leftCols(3) = pixels.cast<double>();
  for (Eigen::Index i = 0; i < pixels.rows(); ++i) {
    values(i, 3) = radiance_luminance(pixels.row(i).transpose());
  }
  const Eigen::ArrayXd plain = values.colwise().mean(), cut = values.min(1.0).colwise().mean();
  Spectrum means(static_cast<Eigen::Index>(picture_functions.size()));
  means << plain.head(3).cast<float>(), cut.head(3).cast<float>(), static_cast<float>(plain[3]),
      static_cast<float>(cut[3]);
  return means;
}

bool is_same(const RadiancePrimitive& a, const RadiancePrimitive& b) {
  return a.type == b.type && a.name == b.name && a.strings == b.strings && a.reals == b.reals &&
         a.frame.matrix() == b.frame.matrix();
}

}  // namespace

int RadianceMaterials::index_of(const std::string& name, const RadiancePrimitive& user) {
  if (name == radiance_void) return none;
  const auto found = latest_.find(name);
  if (found != latest_.end()) return found->second;
  remarks_.add_unusable(
      "Modifiers are not defined and were read as a grey of 0.5", name,
      fmt::format("{}:{}: {} '{}' has the modifier '{}', which nothing before it defines; if it "
                  "stands in a file of its own, list both files in a .rif: materials = ..., scene "
                  "= ...",
                  user.location.file->string(), user.location.line, user.type, user.name, name));
  definitions_.push_back({.primitive = {.modifier = std::string(radiance_void),
                                        .type = "plastic",
                                        .name = name,
                                        .reals = {0.5, 0.5, 0.5, 0.0, 0.0},
                                        .location = user.location}});
  return latest_.emplace(name, static_cast<int>(definitions_.size()) - 1).first->second;
}

RadianceMaterials::Definition RadianceMaterials::aliased(const RadiancePrimitive& alias) {
  const int original = index_of(alias.strings.at(0), alias);
  if (original == none) alias.fail("stands for 'void'; name a material");
  Definition result = definitions_[static_cast<std::size_t>(original)];
  result.index.reset();
  result.primitive.name = alias.name;
  if (alias.modifier != "inherit") result.parent = index_of(alias.modifier, alias);
  return result;
}

void RadianceMaterials::define(const RadiancePrimitive& primitive) {
  Definition definition{.primitive = primitive};
  if (primitive.kind() == RadianceKind::alias) {
    definition = aliased(primitive);
  } else {
    definition.parent = index_of(primitive.modifier, primitive);
    std::size_t parts = 0;
    if (primitive.kind() == RadianceKind::mixture) parts = 2;
    if (primitive.type == "illum") parts = 1;
    for (std::size_t i = 0; i < std::min(parts, primitive.strings.size()); ++i) {
      definition.parts.push_back(index_of(primitive.strings[i], primitive));
    }
  }
  const auto [entry, is_new] =
      latest_.emplace(definition.primitive.name, static_cast<int>(definitions_.size()));
  if (!is_new) {
    // Repeated includes define the same primitive again and again.
    const Definition& last = definitions_[static_cast<std::size_t>(entry->second)];
    if (is_same(last.primitive, definition.primitive) && last.parent == definition.parent &&
        last.parts == definition.parts) {
      return;
    }
    entry->second = static_cast<int>(definitions_.size());
  }
  definitions_.push_back(std::move(definition));
}

std::optional<int> RadianceMaterials::of_surface(const RadiancePrimitive& surface) {
  const int modifier = index_of(surface.modifier, surface);
  if (modifier == none) {
    remarks_.add("Surfaces of no material (void) cannot be seen and were left out", surface.name);
    return std::nullopt;
  }
  const auto material = scene_material(modifier, surface);
  if (!material) {
    remarks_.add("Surfaces of a material that cannot be seen were left out", surface.name);
  }
  return material;
}

// Index into the scene's materials, added if new; empty for invisible ones.
std::optional<int> RadianceMaterials::scene_material(int modifier, const RadiancePrimitive& user) {
  Definition& definition = definitions_[static_cast<std::size_t>(modifier)];
  if (!definition.index) {
    std::optional<Material> material = default_material(scene_.bands);
    remarks_.attempt("Materials that cannot be read got a diffuse reflectance of 0.5",
                     definition.primitive.name, [&] { material = read(modifier, user, 0); });
    definition.index = none;
    const std::string& name = definition.primitive.name;
    if (const auto same = material ? same_material(name, *material) : std::nullopt) {
      definition.index = *same;
    } else if (material) {
      material->name = names_.unique(name);
      definition.index = static_cast<int>(scene_.materials.size());
      materials_of_name_[name].push_back(*definition.index);
      scene_.materials.push_back(std::move(*material));
    }
  }
  if (*definition.index != none) return definition.index;
  return std::nullopt;
}

// The material that an earlier definition of a name gave, if it is the same: copies of an object
// define its materials again.
std::optional<int> RadianceMaterials::same_material(const std::string& name,
                                                    const Material& material) const {
  const auto of_name = materials_of_name_.find(name);
  if (of_name == materials_of_name_.end()) return std::nullopt;
  const std::uint64_t hash = material_hash(material);
  for (const int i : of_name->second) {
    if (material_hash(scene_.materials[static_cast<std::size_t>(i)]) == hash) return i;
  }
  return std::nullopt;
}

Spectrum RadianceLight::radiance(const Eigen::Vector3d& ray, double cosine) const {
  Spectrum result = color;
  for (const DirectionPattern* pattern : patterns) result *= pattern->factor(ray, cosine);
  return result;
}

const DirectionPattern* RadianceMaterials::direction_pattern(int index) {
  const auto known = by_direction_.find(index);
  if (known != by_direction_.end()) return known->second.get();
  std::unique_ptr<const DirectionPattern> pattern;
  try {
    pattern = std::make_unique<const DirectionPattern>(
        definitions_[static_cast<std::size_t>(index)].primitive, scene_.file.parent_path());
  } catch (const LimitError&) {
    throw;
  } catch (const InputError&) {
    // The pattern counts as unknown, which a remark says where the material is used.
  }
  return by_direction_.emplace(index, std::move(pattern)).first->second.get();
}

std::optional<RadianceLight> RadianceMaterials::light_of(const RadiancePrimitive& surface) {
  int index = index_of(surface.modifier, surface);
  std::optional<RadianceLight> light;
  for (int depth = 0; index != none; ++depth) {
    const Definition& definition = definitions_[static_cast<std::size_t>(index)];
    const RadiancePrimitive& p = definition.primitive;
    if (depth > deepest_modifier) p.fail("is reached by too many modifiers");
    if (p.kind() == RadianceKind::mixture) return std::nullopt;
    if (p.kind() == RadianceKind::material) {
      const bool shines =
          p.type == "light" || p.type == "glow" || p.type == "illum" || p.type == "spotlight";
      if (!shines) return std::nullopt;
      light = RadianceLight{.material = p, .color = radiance_color(p, remarks_)};
    } else if (light && p.kind() == RadianceKind::pattern) {
      RadiancePattern constant;
      if (is_constant(p, constant)) {
        light->color *= constant.factor;
      } else if (const DirectionPattern* pattern = direction_pattern(index)) {
        light->patterns.push_back(pattern);
      } else {
        return std::nullopt;
      }
    }
    index = definition.parent;
  }
  return light;
}

std::optional<int> RadianceMaterials::behind_illum(const RadiancePrimitive& surface) {
  const int index = index_of(surface.modifier, surface);
  if (index == none) return std::nullopt;
  const std::vector<int>& parts = definitions_[static_cast<std::size_t>(index)].parts;
  if (parts.empty() || parts.front() == none) return std::nullopt;
  return scene_material(parts.front(), surface);
}

void RadianceMaterials::open_illums() {
  for (const Definition& definition : definitions_) {
    if (definition.primitive.type != "illum" || definition.parts.empty()) continue;
    if (!definition.index || *definition.index == none) continue;
    const auto behind = read(definition.parts.front(), definition.primitive, 0);
    if (!behind) continue;
    Material& material = scene_.materials[static_cast<std::size_t>(*definition.index)];
    const std::string name = material.name;
    material = *behind;
    material.name = name;
    remarks_.add("Illums were read as the material behind them, which the sky's light meets",
                 definition.primitive.name);
  }
}

std::optional<Material> RadianceMaterials::read(int index, const RadiancePrimitive& user,
                                                int depth) {
  const auto known = known_.find(index);
  if (known != known_.end()) return known->second;
  return known_.emplace(index, read_new(index, user, depth)).first->second;
}

// Follows the modifiers from patterns to the material behind them.
std::optional<Material> RadianceMaterials::read_new(int index, const RadiancePrimitive& user,
                                                    int depth) {
  for (; index != none; ++depth) {
    const Definition& definition = definitions_[static_cast<std::size_t>(index)];
    if (depth > deepest_modifier) {
      definition.primitive.fail(
          fmt::format("is reached by more than {} modifiers", deepest_modifier));
    }
    const RadianceKind kind = definition.primitive.kind();
    if (kind == RadianceKind::mixture) return mixed(definition, user, depth);
    if (kind == RadianceKind::material) {
      const RadiancePattern pattern = pattern_of(definition, user);
      // An illum stands for light through a window or a luminaire; with an unknown pattern its
      // amount is unknown.
      if (definition.primitive.type == "illum" && !pattern.is_known && !definition.parts.empty()) {
        remarks_.add("Illums with a pattern were read as the material behind them, without light",
                     definition.primitive.name);
        return read(definition.parts[0], user, depth + 1);
      }
      return read_radiance_material(definition.primitive, pattern, remarks_);
    }
    index = definition.parent;
  }
  return std::nullopt;
}

std::optional<Material> RadianceMaterials::mixed(const Definition& mixture,
                                                 const RadiancePrimitive& user, int depth) {
  const RadiancePrimitive& p = mixture.primitive;
  if (mixture.parts.size() < 2) p.fail("needs the names of two materials and a mixing function");
  // mixtext and mixpict vary over the surface.
  double share = std::nan("");
  if (p.type == "mixfunc" && p.strings.size() > 2) share = constant_value(p.strings[2], p);
  if (!std::isfinite(share)) {
    remarks_.add("Mixtures were read as half of either material", p.name);
    share = 0.5;
  }
  share = std::clamp(share, 0.0, 1.0);
  const auto front = read(mixture.parts[0], user, depth + 1),
             back = read(mixture.parts[1], user, depth + 1);
  const auto& larger = share >= 0.5 ? front : back;
  const auto a = static_cast<float>(share), b = static_cast<float>(1.0 - share);
  const bool has_glass = (front && front->dielectric) || (back && back->dielectric);
  if (front.has_value() != back.has_value() && !has_glass) {
    // A perforated sheet: light passes where nothing is.
    Material sheet = front ? *front : *back;
    if (sheet.is_emitter()) return larger;
    let_through(sheet, Spectrum::Constant(3, front ? a : b));
    return sheet;
  }
  // A clear material has no mean with an opaque one.
  if (!front || !back || has_glass) return larger;
  Material sum = *larger;
  sum.reflectance = a * front->reflectance + b * back->reflectance;
  sum.specular = a * front->specular + b * back->specular;
  sum.specular_roughness = std::max(front->specular_roughness, back->specular_roughness);
  sum.emission = a * front->emission + b * back->emission;
  sum.one_sided = front->one_sided && back->one_sided;
  sum.transmittance = sum.regular_transmittance = {};
  add_passed(*front, a, sum);
  add_passed(*back, b, sum);
  close_lamp(sum);
  return sum;
}

RadiancePattern RadianceMaterials::pattern_of(const Definition& definition,
                                              const RadiancePrimitive& user) {
  RadiancePattern result;
  int depth = 0;
  for (int i = definition.parent; i != none; i = definitions_[static_cast<std::size_t>(i)].parent) {
    const Definition& modifier = definitions_[static_cast<std::size_t>(i)];
    if (++depth > deepest_modifier) {
      definition.primitive.fail(fmt::format("has more than {} modifiers", deepest_modifier));
    }
    const RadianceKind kind = modifier.primitive.kind();
    if (kind == RadianceKind::pattern) apply(modifier, user, result);
    if (kind == RadianceKind::texture) {
      remarks_.add("Textures (bumps) were left out", modifier.primitive.name);
    }
  }
  return result;
}

void RadianceMaterials::apply(const Definition& pattern, const RadiancePrimitive& user,
                              RadiancePattern& result) {
  const RadiancePrimitive& p = pattern.primitive;
  if (p.type.ends_with("pict")) {
    if (const auto mean = mean_of_picture(p)) {
      remarks_.add("Pictures on surfaces were taken as their mean colour", p.name);
      result.factor *= *mean;
      return;
    }
    // A picture is the whole colour of its surface, over a white material.
    remarks_.add("Pictures on surfaces were taken as a medium grey of 0.5", p.name);
    constexpr float grey = 0.5f;
    result.factor *= grey;
    result.is_known = false;
    return;
  }
  if (is_constant(p, result)) return;
  try {
    result.factor *= mean_over(p, radiance_bounds(user), scene_.file.parent_path());
    remarks_.add("Patterns that change from place to place were taken as their mean", p.name);
    result.is_known = false;
    return;
  } catch (const LimitError&) {
    throw;
  } catch (const InputError&) {
    // Taken as 1 below.
  }
  remarks_.add("Patterns that change from place to place were taken as 1", p.name);
  result.is_known = false;
}

// Mean of a colorpict over its picture. Arguments: functions of red, green and blue, picture,
// function file, u, v. Empty for a picture that cannot be read, or functions that are not known.
std::optional<Spectrum> RadianceMaterials::mean_of_picture(const RadiancePrimitive& colorpict) {
  if (colorpict.strings.size() < 4) return std::nullopt;
  const std::string& name = colorpict.strings[3];
  const std::filesystem::path folder = scene_.file.parent_path();
  auto path = find_radiance_file(name, colorpict.location, folder);
  // Pictures were renamed from .pic to .hdr over the years.
  if (!path) {
    const auto renamed = std::filesystem::path(name).replace_extension(".hdr").string();
    path = find_radiance_file(renamed, colorpict.location, folder);
  }
  if (!path) return std::nullopt;
  auto known = means_.find(*path);
  if (known == means_.end()) {
    std::optional<Spectrum> means;
    remarks_.attempt("Pictures that cannot be read were taken as a medium grey of 0.5", name,
                     [&] { means = means_of(read_rgbe_values(*path)); });
    known = means_.emplace(*path, means).first;
  }
  if (!known->second) return std::nullopt;
  Spectrum mean(3);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto function = std::ranges::find(picture_functions, colorpict.strings[k]);
    if (function == picture_functions.end()) return std::nullopt;
    mean[static_cast<Eigen::Index>(k)] = (*known->second)[function - picture_functions.begin()];
  }
  return mean;
}

}  // namespace lightwell
