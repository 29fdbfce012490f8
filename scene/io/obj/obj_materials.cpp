#include "scene/io/obj/obj_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "scene/io/pictures/picture_mean.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

// A newmtl block of the file.
struct MtlBlock {
  std::string name{};
  int line = 0;
  std::optional<Spectrum> diffuse{}, mirror{}, filter{}, radiance{};
  std::optional<float> index{}, dissolve{}, transparency{};
  int illumination = -1;
  std::string diffuse_map{}, dissolve_map{};  ///< options and file
  bool has_other_map = false;
};

// Names of materials by the note that they share.
struct MtlRemarks {
  std::vector<std::string> highlights{}, textures{}, scaled{}, dissolved{}, dark_glass{}, unread{},
      glowing_holes{};
  std::vector<std::string> missing{};  ///< sentences
};

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
      if (key == "newmtl") {
        blocks_.push_back({.name = std::string(trimmed(text)), .line = line});
        if (blocks_.back().name.empty()) file_.fail(line, "newmtl lacks the material's name");
      } else if (!blocks_.empty()) {
        read_property(key, text, blocks_.back());
      }
    });
    return std::move(blocks_);
  }

 private:
  void read_property(std::string_view key, std::string_view rest, MtlBlock& block) {
    constexpr float no_limit = std::numeric_limits<float>::max();
    if (key == "Kd") block.diffuse = rgb(key, rest, 1.0f);
    // The Ks of a highlight is unbounded; the Ks of a mirror is checked once the block is complete.
    if (key == "Ks") block.mirror = rgb(key, rest, no_limit);
    if (key == "Tf") block.filter = rgb(key, rest, 1.0f);
    if (key == "Ke") block.radiance = rgb(key, rest, no_limit);
    if (key == "Ni") block.index = number(key, next_word(rest), no_limit);
    if (key == "d") {
      std::string_view word = next_word(rest);
      if (word == "-halo") word = next_word(rest);
      block.dissolve = number(key, word, 1.0f);
    }
    if (key == "Tr") block.transparency = number(key, next_word(rest), 1.0f);
    if (key == "illum") block.illumination = static_cast<int>(number(key, next_word(rest), 10.0f));
    if (key == "map_Kd") {
      block.diffuse_map = trimmed(rest);
    } else if (key == "map_d") {
      block.dissolve_map = trimmed(rest);
    } else if (key.starts_with("map_") || key == "bump" || key == "norm" || key == "disp") {
      block.has_other_map = true;
    }
  }

  float number(std::string_view key, std::string_view word, float most) {
    const auto value = parse_finite(word);
    if (!value) file_.fail(line_, fmt::format("{} is '{}', not a finite number", key, word));
    if (!(*value >= 0.0 && *value <= most)) {
      file_.fail(line_, most == 1.0f
                            ? fmt::format("{} is {}; it must lie between 0 and 1", key, *value)
                            : fmt::format("{} is {}; it is out of range", key, *value));
    }
    return static_cast<float>(*value);
  }

  // One number gives all three components.
  Spectrum rgb(std::string_view key, std::string_view rest, float most) {
    std::string_view first = next_word(rest);
    if (first == "spectral" || first == "xyz") {
      file_.fail(line_,
                 fmt::format("'{} {}' is not supported; give red, green and blue", key, first));
    }
    Spectrum value = Spectrum::Constant(3, number(key, first, most));
    const std::string_view second = next_word(rest);
    if (second.empty() || second.front() == '#') return value;
    value[1] = number(key, second, most);
    value[2] = number(key, next_word(rest), most);
    return value;
  }

  const TextFile& file_;
  int line_ = 0;
  std::vector<MtlBlock> blocks_;
};

bool is_clear(const MtlBlock& b) {
  constexpr std::array clear_models = {4, 6, 7, 9};
  if (std::find(clear_models.begin(), clear_models.end(), b.illumination) != clear_models.end()) {
    return true;
  }
  const float opacity = b.dissolve.value_or(1.0f - b.transparency.value_or(0.0f));
  return opacity < 1.0f || (b.filter && (*b.filter > 0.0f).any() && (*b.filter < 1.0f).any());
}

void make_clear(const MtlBlock& b, Material& material, MtlRemarks& remarks) {
  const float index = b.index.value_or(1.0f);
  const bool has_filter = b.filter && (*b.filter > 0.0f).any();
  material.dielectric =
      Dielectric{.index_of_refraction = index > 0.0f && index != 1.0f ? index : 1.5f,
                 .tint = has_filter ? *b.filter : Spectrum(Spectrum::Ones(3))};
  if (b.illumination < 4 && !has_filter) remarks.dissolved.push_back(b.name);
  if (b.radiance && (*b.radiance > 0.0f).any()) remarks.dark_glass.push_back(b.name);
}

void make_opaque(const TextFile& file, const MtlBlock& b, Material& material, MtlRemarks& remarks) {
  Spectrum diffuse = b.diffuse.value_or(black_spectrum()),
           mirror = b.mirror.value_or(black_spectrum());
  const bool black = !(diffuse > 0.0f).any();
  const bool is_mirror = b.illumination == 3 || b.illumination == 5 || b.illumination == 8 ||
                         (b.illumination < 0 && black);
  if (!is_mirror) {
    if ((mirror > 0.0f).any()) remarks.highlights.push_back(b.name);
    mirror.setZero();
  }
  if ((mirror > 1.0f).any()) {
    file.fail(b.line, fmt::format("Ks of mirror '{}' is {}; it must lie between 0 and 1", b.name,
                                  mirror.maxCoeff()));
  }
  const Spectrum sum = diffuse + mirror;
  constexpr float rounding = 1e-5f;
  if ((sum > 1.0f).any()) {
    if ((sum > 1.0f + rounding).any()) remarks.scaled.push_back(b.name);
    diffuse /= sum.max(1.0f);
    mirror /= sum.max(1.0f);
  }
  material.reflectance = diffuse;
  material.specular = mirror;
  material.emission = static_cast<float>(std::numbers::pi) * b.radiance.value_or(black_spectrum());
}

Material make_material(const TextFile& file, const MtlBlock& b, MtlRemarks& remarks) {
  const Spectrum zero = black_spectrum();
  Material material{.name = b.name, .reflectance = zero, .specular = zero, .emission = zero};
  if (is_clear(b)) {
    make_clear(b, material, remarks);
  } else {
    make_opaque(file, b, material, remarks);
  }
  if (b.has_other_map) remarks.textures.push_back(b.name);
  return material;
}

// A map_ statement: options, then a file name, which may contain blanks.
struct MapStatement {
  std::string file{};
  SurfaceTexture image{};
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
    if (option == "-s" || option == "-o") {
      Eigen::Vector2d& to = option == "-s" ? scale : offset;
      for (std::size_t i = 0; i < std::min<std::size_t>(2, values.size()); ++i) {
        to[static_cast<int>(i)] = *parse_finite(values[i]);
      }
    }
    text = trimmed(rest);
  }
  map.file = text;
  std::ranges::replace(map.file, '\\', '/');
  // With v upwards v' = s v + o; with v downwards v' = s v + 1 - s - o.
  map.image.placement << scale.x(), 0.0, offset.x(), 0.0, scale.y(), 1.0 - scale.y() - offset.y();
  return map;
}

// Adds the pictures of map_Kd and map_d to a finished material.
class MapReader {
 public:
  MapReader(const TextFile& file, MtlRemarks& remarks) : file_(file), remarks_(remarks) {}

  void add_maps(const MtlBlock& b, Material& material) {
    if (!b.diffuse_map.empty()) {
      MapStatement map = read_map_statement(b.diffuse_map);
      if (material.dielectric) {
        remarks_.textures.push_back(b.name);
      } else if (const auto picture = open(map.file, b)) {
        if (!b.diffuse) material.reflectance = Spectrum::Ones(3) - material.specular;
        map.image.picture = picture->color;
        material.texture = {.image = map.image, .factor = material.reflectance};
        material.reflectance *= picture->mean.color.cast<float>();
      }
    }
    if (b.dissolve_map.empty()) return;
    MapStatement map = read_map_statement(b.dissolve_map);
    if (material.is_emitter()) {
      remarks_.glowing_holes.push_back(b.name);
    } else if (const auto picture = open(map.file, b, PictureCode::linear)) {
      map.image.picture = picture->alpha ? picture->alpha : picture->color;
      material.mask = Mask{.image = map.image};
    }
  }

 private:
  std::optional<Picture> open(const std::string& name, const MtlBlock& b,
                              PictureCode code = PictureCode::srgb) {
    const auto path = file_.path().parent_path() / name;
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) {
      remarks_.missing.push_back(
          fmt::format("Picture '{}' of material '{}' is missing; the material goes without it.",
                      path.string(), b.name));
      return std::nullopt;
    }
    auto picture = pictures_.picture(path, code);
    if (!picture) remarks_.unread.push_back(b.name);
    return picture;
  }

  const TextFile& file_;
  MtlRemarks& remarks_;
  PictureFiles pictures_;
};

void add_note(const TextFile& file, const std::vector<std::string>& materials, const char* what,
              std::vector<std::string>& notes) {
  if (materials.empty()) return;
  constexpr std::size_t listed = 5;
  std::string names;
  for (std::size_t i = 0; i < std::min(listed, materials.size()); ++i) {
    names += fmt::format("{}'{}'", i ? ", " : "", materials[i]);
  }
  if (materials.size() > listed) names += fmt::format(" and {} more", materials.size() - listed);
  notes.push_back(fmt::format("{}: {}: {}.", file.path().filename().string(), what, names));
}

}  // namespace

std::vector<Material> read_obj_materials(const std::filesystem::path& path,
                                         std::vector<std::string>& notes) {
  const TextFile file(path);
  MtlRemarks remarks;
  std::vector<Material> materials;
  MapReader maps(file, remarks);
  for (const MtlBlock& block : MtlParser(file).parse()) {
    materials.push_back(make_material(file, block, remarks));
    maps.add_maps(block, materials.back());
  }
  add_note(file, remarks.highlights,
           "Ks describes a highlight, no mirror (illum 3), and was left out in", notes);
  add_note(file, remarks.textures, "textures were left out in", notes);
  add_note(file, remarks.unread, "pictures that are neither PNG nor JPEG were left out in", notes);
  add_note(file, remarks.glowing_holes, "lamps have no holes, so map_d was left out in", notes);
  notes.insert(notes.end(), remarks.missing.begin(), remarks.missing.end());
  add_note(file, remarks.scaled, "Kd + Ks exceeded 1 and was scaled down in", notes);
  add_note(file, remarks.dissolved, "d < 1 or Tr > 0 was read as clear glass in", notes);
  add_note(file, remarks.dark_glass, "Ke was left out in clear materials", notes);
  return materials;
}

}  // namespace lightwell
