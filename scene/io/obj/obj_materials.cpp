#include "scene/io/obj/obj_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "scene/errors.h"
#include "scene/io/default_material.h"
#include "scene/io/foreign_path.h"
#include "scene/io/glossy.h"
#include "scene/io/obj/obj_file.h"
#include "scene/io/pictures/picture_mean.h"
#include "scene/io/sheets.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

// A newmtl block of the file.
struct MtlBlock {
  std::string name{};
  std::optional<Spectrum> diffuse{}, mirror{}, filter{}, radiance{};
  std::optional<float> index{}, dissolve{}, transparency{};
  int illumination = -1;
  std::string diffuse_map{}, dissolve_map{}, radiance_map{};  ///< options and file
  std::string normal_map{}, bump_map{}, roughness_map{}, metal_map{};
  std::optional<float> roughness{}, metal{};  ///< Pr, Pm
  bool has_other_map = false;
  bool was_cut_off = false;  ///< a number outside [0, 1]
  std::string fault{};       ///< of the first line that cannot be read
};

// The remarks on one MTL file, each with the file's name in front.
class MtlRemarks {
 public:
  MtlRemarks(const TextFile& file, Remarks& remarks)
      : file_(file.path().filename().string()), remarks_(remarks) {}

  void add(std::string_view what, std::string_view name, std::string_view why = {}) {
    remarks_.add_unusable(fmt::format("{}: {}", file_, what), name, why);
  }

 private:
  std::string file_;
  Remarks& remarks_;
};

const char* const textures_left_out = "textures were left out in";
const char* const cut_off = "colours and shares outside [0, 1] were cut off there in";
constexpr float rounding = 1e-5f;  // of colours, which files give by six digits or so

Spectrum black_spectrum() {
  return Spectrum::Zero(3);
}

class MtlParser {
 public:
  explicit MtlParser(const TextFile& file) : file_(file) {}

  std::vector<MtlBlock> parse() {
    file_.for_each_line([&](int line, std::string_view text) {
      line_ = line;
      const std::string_view key = next_word(text);
      if (lower_case(key) == "newmtl") {
        blocks_.push_back({.name = std::string(trimmed(text))});
        if (blocks_.back().name.empty()) file_.fail(line, "newmtl lacks the material's name");
      } else if (!blocks_.empty()) {
        MtlBlock& block = blocks_.back();
        try {
          if (block.fault.empty()) read_property(key, text, block);
        } catch (const InputError& error) {
          block.fault = error.what();
        }
      }
    });
    return std::move(blocks_);
  }

 private:
  // Some programs write all keys in lower case.
  void read_property(std::string_view key, std::string_view rest, MtlBlock& block) {
    const std::string kind = lower_case(key);
    constexpr float no_limit = std::numeric_limits<float>::max();
    if (kind == "kd") block.diffuse = rgb(key, rest, 1.0f);
    // The Ks of a highlight is unbounded; the Ks of a mirror is cut off once the block is complete.
    if (kind == "ks") block.mirror = rgb(key, rest, no_limit);
    if (kind == "tf") block.filter = rgb(key, rest, 1.0f);
    if (kind == "ke") block.radiance = rgb(key, rest, no_limit);
    if (kind == "ni") block.index = number(key, next_word(rest), no_limit);
    if (kind == "d") {
      std::string_view word = next_word(rest);
      if (word == "-halo") word = next_word(rest);
      block.dissolve = number(key, word, 1.0f);
    }
    if (kind == "pr") block.roughness = number(key, next_word(rest), 1.0f);
    if (kind == "pm") block.metal = number(key, next_word(rest), 1.0f);
    if (kind == "tr") block.transparency = number(key, next_word(rest), 1.0f);
    if (kind == "illum") block.illumination = static_cast<int>(number(key, next_word(rest), 10.0f));
    static const std::map<std::string_view, std::string MtlBlock::*> maps = {
        {"map_kd", &MtlBlock::diffuse_map}, {"map_ke", &MtlBlock::radiance_map},
        {"map_d", &MtlBlock::dissolve_map}, {"map_pr", &MtlBlock::roughness_map},
        {"map_pm", &MtlBlock::metal_map},   {"norm", &MtlBlock::normal_map},
        {"map_kn", &MtlBlock::normal_map},  {"bump", &MtlBlock::bump_map},
        {"map_bump", &MtlBlock::bump_map}};
    if (const auto map = maps.find(kind); map != maps.end()) {
      block.*(map->second) = trimmed(rest);
    } else if (kind.starts_with("map_") || kind == "disp") {
      block.has_other_map = true;
    }
  }

  float number(std::string_view key, std::string_view word, float most) {
    const auto value = parse_finite(word);
    if (!value)
      file_.fail(line_, fmt::format("{} is '{}', not a finite number", key, excerpt(word)));
    if (most == 1.0f) {
      const double within = std::clamp(*value, 0.0, 1.0);
      if (std::abs(*value - within) > rounding) blocks_.back().was_cut_off = true;
      return static_cast<float>(within);
    }
    if (!(*value >= 0.0 && *value <= most)) {
      file_.fail(line_, fmt::format("{} is {}; it is out of range", key, *value));
    }
    return static_cast<float>(*value);
  }

  // One number gives all three components.
  Spectrum rgb(std::string_view key, std::string_view rest, float most) {
    const std::string_view first = next_word(rest);
    if (first == "spectral" || first == "xyz") {
      file_.fail(line_,
                 fmt::format("'{} {}' is not supported; give red, green and blue", key, first));
    }
    Spectrum value = Spectrum::Constant(3, number(key, first, most));
    if (trimmed(rest).empty() || trimmed(rest).front() == '#') return value;
    for (const int band : {1, 2}) value[band] = number(key, next_word(rest), most);
    return value;
  }

  const TextFile& file_;
  int line_ = 0;
  std::vector<MtlBlock> blocks_;
};

float opacity(const MtlBlock& b) {
  return b.dissolve.value_or(1.0f - b.transparency.value_or(0.0f));
}

bool is_glass(const MtlBlock& b) {
  constexpr std::array clear_models = {4, 6, 7, 9};
  return std::ranges::find(clear_models, b.illumination) != clear_models.end() ||
         (b.filter && (*b.filter > 0.0f).any() && (*b.filter < 1.0f).any());
}

// A dissolved surface: the share `d` of it is there, and the rest of the light passes straight on.
bool is_sheet(const MtlBlock& b) {
  return !is_glass(b) && opacity(b) < 1.0f && opacity(b) > 0.0f;
}

bool is_clear(const MtlBlock& b) {
  return is_glass(b) || !(opacity(b) > 0.0f);
}

void make_clear(const MtlBlock& b, Material& material, MtlRemarks& remarks) {
  const float index = b.index.value_or(1.0f);
  const bool has_filter = b.filter && (*b.filter > 0.0f).any();
  material.dielectric =
      Dielectric{.index_of_refraction = index > 0.0f && index != 1.0f ? index : 1.5f,
                 .tint = has_filter ? *b.filter : Spectrum(Spectrum::Ones(3))};
  if (b.illumination < 4 && !has_filter) {
    remarks.add("d 0 or Tr 1 was read as clear glass in", b.name);
  }
  if (b.radiance && (*b.radiance > 0.0f).any()) {
    remarks.add("Ke was left out in clear materials", b.name);
  }
}

void make_opaque(const MtlBlock& b, Material& material, MtlRemarks& remarks) {
  Spectrum diffuse = b.diffuse.value_or(black_spectrum()),
           mirror = b.mirror.value_or(black_spectrum());
  const bool black = !(diffuse > 0.0f).any();
  const bool is_mirror = b.illumination == 3 || b.illumination == 5 || b.illumination == 8 ||
                         (b.illumination < 0 && black);
  if (!is_mirror) {
    if ((mirror > 0.0f).any()) {
      remarks.add("Ks describes a highlight, no mirror (illum 3), and was left out in", b.name);
    }
    mirror.setZero();
  }
  if ((mirror > 1.0f + rounding).any()) remarks.add(cut_off, b.name);
  mirror = mirror.min(1.0f);
  const Spectrum sum = diffuse + mirror;
  if ((sum > 1.0f).any()) {
    if ((sum > 1.0f + rounding).any()) {
      remarks.add("Kd + Ks exceeded 1 and was scaled down in", b.name);
    }
    diffuse /= sum.max(1.0f);
    mirror /= sum.max(1.0f);
  }
  if (!b.diffuse && !b.mirror && !b.radiance && b.diffuse_map.empty() && b.radiance_map.empty()) {
    remarks.add("materials without a colour got a diffuse reflectance of 0.5", b.name);
    diffuse.setConstant(0.5f);
  }
  material.reflectance = diffuse;
  material.specular = mirror;
  material.emission = static_cast<float>(std::numbers::pi) * b.radiance.value_or(black_spectrum());
}

Material make_material(const MtlBlock& b, MtlRemarks& remarks) {
  const Spectrum zero = black_spectrum();
  Material material{.name = b.name, .reflectance = zero, .specular = zero, .emission = zero};
  if (is_clear(b)) {
    make_clear(b, material, remarks);
  } else {
    make_opaque(b, material, remarks);
  }
  if (b.was_cut_off) remarks.add(cut_off, b.name);
  if (b.has_other_map) remarks.add(textures_left_out, b.name);
  return material;
}

// A map_ statement: options, then a file name, which may contain blanks.
struct MapStatement {
  std::string file{};
  SurfaceTexture image{};
  double bump = 1.0;  ///< of -bm
};

MapStatement read_map_statement(std::string_view text) {
  MapStatement map;
  Eigen::Vector2d scale(1.0, 1.0), offset(0.0, 0.0);
  const auto is_number = [](std::string_view word) { return parse_finite(word).has_value(); };
  while (text.starts_with('-')) {
    std::string_view rest = text;
    const std::string_view option = next_word(rest);
    std::vector<std::string_view> values;
    // Numbers of values: two for -mm, up to three for -s, -o and -t, one for all other options.
    const std::size_t most = option == "-mm"                                      ? 2
                             : option == "-s" || option == "-o" || option == "-t" ? 3
                                                                                  : 1;
    while (values.size() < most) {
      std::string_view after = rest;
      const std::string_view word = next_word(after);
      if (word.empty() || (most > 1 && !is_number(word))) break;
      values.push_back(word);
      rest = after;
    }
    if (values.empty()) break;
    if (option == "-clamp" && values[0] == "on") map.image.wrap.fill(TextureWrap::clamp);
    if (option == "-bm") map.bump = parse_finite(values[0]).value_or(1.0);
    if (option == "-s" || option == "-o") {
      Eigen::Vector2d& to = option == "-s" ? scale : offset;
      for (std::size_t i = 0; i < std::min<std::size_t>(2, values.size()); ++i) {
        to[static_cast<int>(i)] = *parse_finite(values[i]);
      }
    }
    text = trimmed(rest);
  }
  map.file = without_quotes(text);
  // With v upwards v' = s v + o; with v downwards v' = s v + 1 - s - o.
  map.image.placement << scale.x(), 0.0, offset.x(), 0.0, scale.y(), 1.0 - scale.y() - offset.y();
  return map;
}

// Adds the pictures of map_Kd, norm, bump and map_d to a finished material.
class MapReader {
 public:
  MapReader(const TextFile& file, MtlRemarks& remarks) : file_(file), remarks_(remarks) {}

  void add_maps(const MtlBlock& b, Material& material) {
    if (!b.diffuse_map.empty()) lay_on_diffuse_map(b, material);
    if (!b.roughness_map.empty() || !b.metal_map.empty()) vary_gloss(b, material);
    if (!b.radiance_map.empty()) lay_on_radiance_map(b, material);
    if (!b.normal_map.empty() || !b.bump_map.empty()) set_relief(b, material);
    if (b.dissolve_map.empty()) return;
    MapStatement map = read_map_statement(b.dissolve_map);
    if (material.is_emitter()) {
      remarks_.add("lamps have no holes, so map_d was left out in", b.name);
    } else if (const auto picture = open(map.file, b, PictureCode::linear)) {
      map.image.picture = picture->alpha ? picture->alpha : picture->color;
      const auto even = material.dielectric ? std::nullopt : even_opacity(*map.image.picture);
      map.image.picture = first_channel(*map.image.picture);
      if (even) return let_through(material, ShareTexture{.image = map.image});
      material.mask = Mask{.image = map.image};
    }
  }

 private:
  // Pictures of roughness and metal, of surfaces that are neither mirror nor glass: glTF's model in
  // MTL files. Pr and Pm are factors of the pictures.
  void vary_gloss(const MtlBlock& b, Material& material) {
    if (material.dielectric || material.mirrors()) return remarks_.add(textures_left_out, b.name);
    const auto share = [&](const std::string& map_text, std::optional<float> factor) {
      std::optional<ShareTexture> result;
      if (map_text.empty()) return result;
      MapStatement map = read_map_statement(map_text);
      const auto picture = open(map.file, b, PictureCode::linear);
      if (!picture) return result;
      map.image.picture = first_channel(*picture->color);
      result = ShareTexture{.image = map.image, .factor = factor.value_or(1.0f)};
      return result;
    };
    const auto roughness = share(b.roughness_map, b.roughness);
    const float even = b.roughness.value_or(1.0f);
    MetalAndPaint given{
        .color = material.texture ? material.texture->factor : material.reflectance,
        .index = b.index && *b.index > 1.0f && *b.index <= highest_index ? double{*b.index} : 1.5,
        .alpha = double{even * even},
        .metallic = double{b.metal.value_or(0.0f)},
        .metallic_picture = share(b.metal_map, b.metal)};
    if (roughness) given.alpha_picture = squared(*roughness);
    set_metal_and_paint(material, given);
  }

  void lay_on_diffuse_map(const MtlBlock& b, Material& material) {
    MapStatement map = read_map_statement(b.diffuse_map);
    if (material.dielectric) return remarks_.add(textures_left_out, b.name);
    const auto picture = open(map.file, b);
    // Without Kd the picture is the whole colour; without the picture nothing is known of it.
    const Spectrum most = Spectrum::Ones(3) - material.specular;
    if (!b.diffuse) material.reflectance = picture ? most : Spectrum(0.5f * most);
    if (!picture) return;
    const bool is_cut = !b.dissolve_map.empty();
    map.image.picture = picture->shown(is_cut);
    material.texture = {.image = map.image, .factor = material.reflectance};
    material.reflectance *= picture->mean_shown(is_cut).cast<float>();
  }

  // Without Ke the picture is the radiance, as programs mean it that write map_Ke alone.
  void lay_on_radiance_map(const MtlBlock& b, Material& material) {
    MapStatement map = read_map_statement(b.radiance_map);
    if (material.dielectric) return remarks_.add(textures_left_out, b.name);
    const auto light =
        open_by(map.file, b, "pictures that are no PNG, JPEG, EXR or HDR",
                [&](const auto& path) { return pictures_.light(path, PictureCode::srgb); });
    if (!light) return;
    const Spectrum radiance = b.radiance.value_or(Spectrum::Ones(3));
    map.image.picture = light->color;
    const Spectrum factor = static_cast<float>(std::numbers::pi) * light->brightest * radiance;
    material.emission = factor;
    material.emission.head<3>() *= light->color->mean();
    if (material.is_emitter()) {
      material.emission_texture = {.image = map.image, .factor = factor};
    }
  }

  // Programs write pictures of normals to `bump`, too.
  void set_relief(const MtlBlock& b, Material& material) {
    const bool is_named = !b.normal_map.empty();
    MapStatement map = read_map_statement(is_named ? b.normal_map : b.bump_map);
    const auto picture = open(map.file, b, PictureCode::linear);
    if (!picture) return;
    map.image.picture = picture->color;
    try {
      if (!(std::abs(map.bump) <= most_relief_scale)) {
        throw InputError(fmt::format("-bm is {}; give a number between {} and {}", map.bump,
                                     -most_relief_scale, most_relief_scale));
      }
      material.relief = is_named || shows_normals(*picture->color)
                            ? relief_of_normals(map.image, map.bump)
                            : relief_of_heights(map.image, map.bump, DepthUnit::texel);
    } catch (const InputError& fault) {
      remarks_.add("relief that cannot be used was left out in", b.name, fault.what());
    }
  }

  std::optional<Picture> open(const std::string& name, const MtlBlock& b,
                              PictureCode code = PictureCode::srgb) {
    return open_by(name, b, "pictures that are neither PNG nor JPEG",
                   [&](const auto& path) { return pictures_.picture(path, code); });
  }

  // Calls `read` with the path of the file and returns the picture; empty, with a remark, if the
  // file cannot be used.
  template <class Read>
  auto open_by(const std::string& name, const MtlBlock& b, const char* others, Read&& read)
      -> decltype(read(std::filesystem::path())) {
    const auto folder = file_.path().parent_path();
    const auto path = find_foreign_file(folder, name);
    if (!path) {
      std::string missing = (folder / name).string();
      std::ranges::replace(missing, '\\', '/');
      remarks_.add("pictures that are missing were left out", missing);
      return std::nullopt;
    }
    try {
      auto picture = read(*path);
      if (!picture) remarks_.add(fmt::format("{} were left out in", others), b.name);
      return picture;
    } catch (const LimitError&) {
      throw;
    } catch (const InputError& fault) {
      remarks_.add("pictures that cannot be read were left out", path->string(), fault.what());
      return std::nullopt;
    }
  }

  const TextFile& file_;
  MtlRemarks& remarks_;
  PictureFiles pictures_;
};

void dissolve(const MtlBlock& b, Material& material, MtlRemarks& remarks) {
  if (material.is_emitter()) {
    return remarks.add("lamps let no light through, so d or Tr was left out in", b.name);
  }
  let_through(material, Spectrum::Constant(3, opacity(b)));
}

// The material of a block; a grey one, with a remark, if the block cannot be read.
Material material_of(const MtlBlock& block, MapReader& maps, MtlRemarks& remarks) {
  try {
    if (!block.fault.empty()) throw InputError(block.fault);
    Material material = make_material(block, remarks);
    maps.add_maps(block, material);
    if (is_sheet(block)) dissolve(block, material, remarks);
    return material;
  } catch (const LimitError&) {
    throw;
  } catch (const InputError& fault) {
    remarks.add("materials that cannot be read got a diffuse reflectance of 0.5", block.name,
                fault.what());
    Material material = default_material(Scene().bands);
    material.name = block.name;
    return material;
  }
}

}  // namespace

std::vector<Material> read_obj_materials(const std::filesystem::path& path,
                                         const std::function<bool(const std::string&)>& is_shown,
                                         Remarks& remarks) {
  const TextFile file(path);
  MtlRemarks of_file(file, remarks);
  std::vector<Material> materials;
  MapReader maps(file, of_file);
  for (const MtlBlock& block : MtlParser(file).parse()) {
    if (is_shown(block.name)) materials.push_back(material_of(block, maps, of_file));
  }
  return materials;
}

}  // namespace lightwell
