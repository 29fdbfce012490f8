#include <fmt/format.h>

#include <limits>

#include "raytrace/display/display.h"
#include "viewer/export/export.h"
#include "viewer/export/write_whole.h"

namespace lightwell {
namespace {

/// `name` as one word, as PLY requires of property names.
std::string ply_word(std::string name) {
  for (char& c : name) {
    if (static_cast<unsigned char>(c) <= 0x20 || c == 0x7f) c = '_';
  }
  return name;
}

std::string header(const BakedModel& model, std::size_t triangle_count) {
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  const auto comment = [&text](const std::string& words) {
    text += fmt::format("comment {}\n", one_line(words));
  };
  comment(fmt::format("Lightwell {}: baked radiosity of {}", model.provenance.version,
                      model.provenance.scene_file));
  comment(fmt::format("metres; radiosity and irradiance in {}; illuminance in {}",
                      model.relative_units ? "relative units" : "W/m^2 per band",
                      model.relative_units ? "relative units" : "lx"));
  comment(
      fmt::format("red, green, blue: sRGB of radiance times {:g}", model.cameras.front().scale));
  for (const BakedPart& part : model.parts) {
    comment(
        fmt::format("surface {} {}{}", part.surface, part.is_back ? "back of " : "", part.name));
  }
  for (std::size_t m = 0; m < model.materials.size(); ++m) {
    comment(fmt::format("material {} {}", m, model.materials[m].name));
  }
  text += fmt::format("element vertex {}\n", model.vertex_count());
  text += "property float x\nproperty float y\nproperty float z\n";
  text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  for (const char* quantity : {"radiosity", "irradiance"}) {
    for (const std::string& band : model.bands.names) {
      text += fmt::format("property float {}_{}\n", quantity, ply_word(band));
    }
  }
  text += "property float illuminance\n";
  text += fmt::format("element face {}\n", triangle_count);
  text += "property list uchar int vertex_indices\nproperty int surface\nproperty int material\n";
  return text + "end_header\n";
}

std::string vertices(const BakedModel& model) {
  const std::vector<std::uint8_t> colors = srgb_colors(model);
  std::string bytes;
  for (int v = 0; v < model.vertex_count(); ++v) {
    const auto i = static_cast<std::size_t>(v);
    for (const double x : model.position[i]) append_bytes(bytes, static_cast<float>(x));
    for (std::size_t c = 0; c < 3; ++c) append_bytes(bytes, colors[3 * i + c]);
    for (const BandArray* values : {&model.radiosity, &model.irradiance}) {
      for (const float value : values->row(v)) append_bytes(bytes, value);
    }
    append_bytes(bytes, model.illuminance[i]);
  }
  return bytes;
}

std::string faces(const BakedModel& model) {
  std::string bytes;
  for (const BakedPart& part : model.parts) {
    for (const auto& triangle : triangles_of(model, part.first_face, part.face_count)) {
      append_bytes(bytes, std::uint8_t{3});
      for (const int v : triangle) append_bytes(bytes, v);
      append_bytes(bytes, part.surface);
      append_bytes(bytes, part.material);
    }
  }
  return bytes;
}

}  // namespace

void write_ply(const std::filesystem::path& path, const BakedModel& model) {
  const std::size_t triangle_count = triangles_of(model, 0, model.face_count()).size();
  write_whole(path, {header(model, triangle_count), vertices(model), faces(model)});
}

}  // namespace lightwell
