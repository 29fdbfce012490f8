#include "scene/io/pov/pov_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "scene/io/pov/pov_transform.h"

namespace lightwell {
namespace {

/// A pattern that takes its colours from a list, with their shares of space.
struct ListPattern {
  std::string_view name;
  std::array<double, 3> shares;
};
// A brick of 8 x 3 x 4.5 has 0.5 of mortar in each direction.
constexpr double mortar = 1.0 - (7.5 * 2.5 * 4.0) / (8.0 * 3.0 * 4.5);
constexpr std::array<ListPattern, 6> list_patterns = {{{"checker", {0.5, 0.5, 0.0}},
                                                       {"hexagon", {1.0 / 3, 1.0 / 3, 1.0 / 3}},
                                                       {"brick", {mortar, 1.0 - mortar, 0.0}},
                                                       {"square", {1.0 / 3, 1.0 / 3, 1.0 / 3}},
                                                       {"triangular", {1.0 / 3, 1.0 / 3, 1.0 / 3}},
                                                       {"cubic", {1.0 / 3, 1.0 / 3, 1.0 / 3}}}};

constexpr std::array<std::string_view, 32> map_patterns = {
    "agate",           "average",      "boxed",   "bozo",   "bumps",    "cells",   "crackle",
    "cylindrical",     "density_file", "dents",   "facets", "gradient", "granite", "julia",
    "leopard",         "magnet",       "mandel",  "marble", "noise",    "onion",   "pavement",
    "pigment_pattern", "planar",       "quilted", "radial", "ripples",  "slope",   "spherical",
    "spiral1",         "spiral2",      "spotted", "waves"};

constexpr std::array<std::string_view, 3> more_map_patterns = {"wood", "wrinkles", "aoi"};

const ListPattern* list_pattern(std::string_view word) {
  const auto* found = std::ranges::find(list_patterns, word, &ListPattern::name);
  return found == list_patterns.end() ? nullptr : found;
}

bool is_map_pattern(std::string_view word) {
  return std::ranges::find(map_patterns, word) != map_patterns.end() ||
         std::ranges::find(more_map_patterns, word) != more_map_patterns.end();
}

void add_scaled(PovVector& sum, const PovVector& color, double weight) {
  for (std::size_t i = 0; i < sum.c.size(); ++i) sum.c[i] += weight * color.c[i];
}

class TextureReader {
 public:
  TextureReader(const std::string& name, Remarks& remarks, std::int64_t& visits)
      : name_(name), remarks_(remarks), visits_(visits) {}

  void add(const PovNode& part, PovTexture& texture) {
    count_pov_visit(part, visits_);
    const std::string_view word = part.keyword;
    if (word == "texture" || word == "default") return add_texture(part, texture);
    if (word == "pigment") return add_pigment(part, texture.pigment);
    if (word == "finish") return add_finish(part, texture.finish);
    if (word == "normal") texture.has_normal = true;
  }

 private:
  void add_texture(const PovNode& node, PovTexture& texture) {
    PovCursor cursor(node);
    Eigen::Affine3d moved = Eigen::Affine3d::Identity();
    bool has_base = false;
    while (!cursor.at_end()) {
      if (take_pov_transform(cursor, moved)) continue;
      const PovItem& item = cursor.next();
      if (item.word == "uv_mapping") texture.pigment.by_uv = true;
      const PovNode* child = item.node();
      if (!child) {
        note_unknown(item);
      } else if (child->keyword == "texture_map" || child->keyword == "material_map") {
        remarks_.add("Patterns of textures count as their first texture", name_);
        if (const PovNode* first = first_texture(*child)) add(*first, texture);
      } else if (child->keyword == "texture" && has_base) {
        add_layer(*child, texture);
      } else {
        has_base = has_base || child->keyword == "texture" || child->keyword == "pigment";
        add(*child, texture);
      }
    }
    texture.pigment.to_surface = moved * texture.pigment.to_surface;
  }

  // The mean of a layer covers what is below by its opaque share.
  void add_layer(const PovNode& node, PovTexture& below) {
    remarks_.add("Layers of textures were mixed by the means of their colours", name_);
    PovTexture above;
    above.finish = below.finish;
    add(node, above);
    const PovVector& top = above.pigment.color;
    const double clear = std::clamp(top.c[3] + top.c[4], 0.0, 1.0);
    PovVector mixed{.count = 5};
    add_scaled(mixed, below.pigment.color, clear);
    for (std::size_t i = 0; i < 3; ++i) mixed.c[i] += (1.0 - clear) * top.c[i];
    below.pigment = PovPigment{.color = mixed};
    below.finish = above.finish;
  }

  static const PovNode* first_texture(const PovNode& map) {
    for (const PovItem& item : map.items) {
      const PovNode* child = item.node();
      if (!child) continue;
      if (child->keyword == "texture") return child;
      if (const PovNode* within = first_texture(*child)) return within;
    }
    return nullptr;
  }

  void note_unknown(const PovItem& item) {
    if (item.word.empty() || item.word == "uv_mapping") return;
    if (list_pattern(item.word) || is_map_pattern(item.word)) return;
    remarks_.add("Words of textures that are not known were left out", item.word);
  }

  void add_pigment(const PovNode& node, PovPigment& pigment) {
    count_pov_visit(node, visits_);
    PovCursor cursor(node);
    Eigen::Affine3d moved = Eigen::Affine3d::Identity();
    bool has_pattern = false;
    const auto set_pattern = [&](std::string_view word) {
      pigment.pattern = word;
      pigment.list.clear();
      pigment.map.clear();
      pigment.picture = nullptr;
      has_pattern = true;
    };
    while (!cursor.at_end()) {
      if (take_pov_transform(cursor, moved)) continue;
      const PovItem& item = cursor.next();
      if (const PovVector* color = item.vector()) {
        if (list_pattern(pigment.pattern)) {
          pigment.list.push_back(pov_color(*color));
        } else if (!has_pattern) {
          pigment = PovPigment{.color = pov_color(*color)};
        }
      } else if (const PovNode* child = item.node()) {
        if (child->keyword == "pigment" && list_pattern(pigment.pattern)) {
          PovPigment part;
          add_pigment(*child, part);
          pigment.list.push_back(part.color);
        } else if (child->keyword == "pigment") {
          add_pigment(*child, pigment);
        } else if (child->keyword == "image_map") {
          set_pattern("image_map");
          pigment.picture = child;
        } else if (child->keyword == "color_map" || child->keyword == "colour_map" ||
                   child->keyword == "pigment_map") {
          add_map(*child, pigment);
        } else {
          remarks_.add("Patterns that cannot be evaluated count as grey of 0.5", name_);
          pigment = PovPigment{.color = pov_color({.c = {0.5}})};
        }
      } else if (list_pattern(item.word) || is_map_pattern(item.word)) {
        set_pattern(item.word);
        if (item.word == "gradient" || item.word == "pavement") cursor.vector();
      } else if (item.word == "uv_mapping") {
        pigment.by_uv = true;
      } else {
        pass_modifier(cursor, item);
      }
    }
    pigment.to_surface = moved * pigment.to_surface;
    set_mean(pigment);
  }

  void pass_modifier(PovCursor& cursor, const PovItem& item) {
    constexpr std::array<std::string_view, 18> known = {
        "turbulence",    "octaves",     "omega",        "lambda",    "frequency", "phase",
        "warp",          "quick_color", "quick_colour", "ramp_wave", "sine_wave", "scallop_wave",
        "triangle_wave", "cubic_wave",  "poly_wave",    "metric",    "form",      "offset"};
    if (std::ranges::find(known, item.word) == known.end()) {
      remarks_.add("Words of pigments that are not known were left out", item.word);
    }
    cursor.vector();
  }

  void add_map(const PovNode& map, PovPigment& pigment) {
    pigment.map.clear();
    for (const PovItem& item : map.items) {
      const PovNode* entry = item.node();
      if (!entry || entry->keyword != "[") {
        if (entry && entry->keyword == map.keyword) add_map(*entry, pigment);
        continue;
      }
      add_entry(*entry, pigment.map);
    }
  }

  // An entry "[0, 0.5 color a color b]" has the colours of both its ends.
  void add_entry(const PovNode& entry, std::vector<std::pair<double, PovVector>>& map) {
    std::vector<double> places;
    std::vector<PovVector> colors;
    for (const PovItem& item : entry.items) {
      if (const PovVector* value = item.vector()) {
        if (value->count == 1 && (places.empty() || colors.empty()) && places.size() < 2 &&
            &item != &entry.items.back()) {
          places.push_back(value->c[0]);
        } else {
          colors.push_back(pov_color(*value));
        }
      } else if (const PovNode* child = item.node(); child && child->keyword == "pigment") {
        PovPigment part;
        add_pigment(*child, part);
        colors.push_back(part.color);
      }
    }
    for (std::size_t i = 0; i < std::min(places.size(), colors.size()); ++i) {
      map.emplace_back(places[i], colors[i]);
    }
  }

  void set_mean(PovPigment& pigment) {
    if (pigment.pattern.empty() || pigment.pattern == "image_map") return;
    if (const ListPattern* pattern = list_pattern(pigment.pattern)) {
      if (pigment.list.empty()) return;
      pigment.color = PovVector{.count = 5};
      for (std::size_t i = 0; i < pattern->shares.size(); ++i) {
        add_scaled(pigment.color, pigment.list[std::min(i, pigment.list.size() - 1)],
                   pattern->shares[i]);
      }
    } else {
      pigment.color = pigment.map.empty() ? pov_color({.c = {0.5}}) : pov_mean(pigment.map);
    }
    if (pigment.pattern != "checker") {
      remarks_.add("Patterns count by their mean colour", std::string(pigment.pattern));
    }
  }

  void add_finish(const PovNode& node, PovFinish& finish) {
    PovCursor cursor(node);
    const auto color = [&](Eigen::Array3d& into) {
      if (const auto given = cursor.vector()) {
        const PovVector c = pov_color(*given);
        into = {c.c[0], c.c[1], c.c[2]};
      }
    };
    const auto number = [&](double& into) { into = cursor.number().value_or(1.0); };
    while (!cursor.at_end()) {
      const PovItem& item = cursor.next();
      const std::string_view word = item.word;
      if (word == "diffuse") {
        cursor.take("albedo");
        number(finish.diffuse);
        if (const auto behind = cursor.number()) finish.behind = *behind;
      } else if (word == "ambient") {
        color(finish.ambient);
      } else if (word == "emission") {
        color(finish.emission);
      } else if (word == "phong" || word == "specular") {
        cursor.take("albedo");
        number(word == "phong" ? finish.phong : finish.specular);
      } else if (word == "phong_size") {
        number(finish.phong_size);
      } else if (word == "roughness") {
        number(finish.roughness);
      } else if (word == "metallic") {
        number(finish.metallic);
      } else if (word == "reflection") {
        color(finish.reflection);
        finish.least_reflection = finish.reflection;
      } else if (const PovNode* child = item.node()) {
        if (child->keyword == "finish") add_finish(*child, finish);
        if (child->keyword == "reflection") add_reflection(*child, finish);
        if (child->keyword == "subsurface" || child->keyword == "irid") {
          remarks_.add(fmt::format("'{}' of finishes was left out", child->keyword), name_);
        }
      } else if (word == "brilliance" || word == "crand" || word == "reflection_exponent") {
        remarks_.add(fmt::format("'{}' of finishes was left out", word), name_);
        cursor.number();
      }
    }
  }

  static void add_reflection(const PovNode& node, PovFinish& finish) {
    PovCursor cursor(node);
    std::vector<PovVector> given;
    while (!cursor.at_end()) {
      const PovItem& item = cursor.next();
      if (const PovVector* value = item.vector()) given.push_back(pov_color(*value));
      if (item.word == "fresnel") finish.is_fresnel = cursor.number().value_or(1.0) != 0.0;
      if (item.word == "falloff") finish.falloff = cursor.number().value_or(1.0);
      if (item.word == "metallic") finish.reflection_metallic = cursor.number().value_or(1.0);
      if (item.word == "exponent") cursor.number();
    }
    if (given.empty()) return;
    const auto array = [](const PovVector& v) { return Eigen::Array3d(v.c[0], v.c[1], v.c[2]); };
    finish.reflection = array(given.back());
    finish.least_reflection = given.size() > 1    ? array(given.front())
                              : finish.is_fresnel ? Eigen::Array3d(Eigen::Array3d::Zero())
                                                  : finish.reflection;
  }

  const std::string& name_;
  Remarks& remarks_;
  std::int64_t& visits_;
};

}  // namespace

void count_pov_visit(const PovNode& node, std::int64_t& visits) {
  constexpr std::int64_t most = 10'000'000;
  if (++visits > most) {
    node.place.fail_limit(
        fmt::format("blocks that are used again and again amount to more than {}", most));
  }
}

PovVector pov_mean(const std::vector<std::pair<double, PovVector>>& map) {
  PovVector mean{.count = 5};
  double from = 0.0;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const double at = std::clamp(map[i].first, from, 1.0);
    const PovVector& before = map[i > 0 ? i - 1 : 0].second;
    add_scaled(mean, before, 0.5 * (at - from));
    add_scaled(mean, map[i].second, 0.5 * (at - from));
    from = at;
  }
  if (!map.empty()) add_scaled(mean, map.back().second, 1.0 - from);
  return mean;
}

PovTexture pov_texture(const std::vector<const PovNode*>& parts, const std::string& name,
                       Remarks& remarks, std::int64_t& visits) {
  PovTexture texture;
  TextureReader reader(name, remarks, visits);
  for (const PovNode* part : parts) reader.add(*part, texture);
  if (texture.has_normal) remarks.add("Bumps ('normal') were left out", name);
  return texture;
}

PovInterior pov_interior(const PovNode& node) {
  PovInterior interior;
  PovCursor cursor(node);
  while (!cursor.at_end()) {
    const PovItem& item = cursor.next();
    if (const PovNode* child = item.node(); child && child->keyword == "interior") {
      interior = pov_interior(*child);
    } else if (item.word == "ior") {
      interior.index = cursor.need_number("ior");
    } else if (item.word == "fade_distance") {
      interior.fade_distance = cursor.need_number("fade_distance");
    } else if (item.word == "fade_power") {
      interior.fade_power = cursor.need_number("fade_power");
    } else if (item.word == "fade_color" || item.word == "fade_colour") {
      if (const auto color = cursor.vector()) interior.fade_color = pov_color(*color);
    }
  }
  return interior;
}

}  // namespace lightwell
