#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include "viewer/export/appearance.h"
#include "viewer/export/export.h"
#include "viewer/export/write_whole.h"

namespace lightwell {
namespace {

constexpr std::string_view library_start = "# Baked by Lightwell";

/// `name` as one word, since some programs end names at a space, without "#".
std::string obj_word(const std::string& name) {
  std::string result;
  for (const char c : name) {
    result += static_cast<unsigned char>(c) <= 0x20 || c == 0x7f || c == '#' ? '_' : c;
  }
  return result.empty() ? "_" : result;
}

/// Name of a material with its number, since two materials may have the same name.
std::string material_word(const BakedModel& model, int material) {
  return fmt::format("{}_{}", material, obj_word(model.materials[material].name));
}

constexpr std::string_view lamp_material = "luminaires";

void add_material(std::string_view name, std::string& text) {
  text += fmt::format("\nnewmtl {}\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nillum 0\n", name);
}

/// The MTL: white materials without shading, so that programs that multiply vertex colours by Kd
/// show the vertex colours.
std::string library(const BakedModel& model) {
  std::string text =
      std::string(library_start) + ": the light is in the colours of the vertices.\n";
  for (int m = 0; m < static_cast<int>(model.materials.size()); ++m) {
    add_material(material_word(model, m), text);
    if (model.materials[m].is_glass) text += fmt::format("d {:g}\n", glass_opacity);
  }
  if (!model.lamp_faces.empty()) add_material(lamp_material, text);
  return text;
}

void add_vertex(const Eigen::Vector3d& p, const std::uint8_t* rgb, std::string& text) {
  fmt::format_to(std::back_inserter(text), "v {:.9g} {:.9g} {:.9g} {:.4g} {:.4g} {:.4g}\n", p.x(),
                 p.y(), p.z(), rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0);
}

/// An object for each luminaire that is drawn, after the model's vertices.
void add_lamps(const BakedModel& model, std::string& text) {
  const auto out = std::back_inserter(text);
  int lamp = -1, last = model.vertex_count();
  for (const BakedLampFace& face : model.lamp_faces) {
    if (std::exchange(lamp, face.lamp) != face.lamp) {
      fmt::format_to(out, "o {}\nusemtl {}\n",
                     obj_word(model.lamp_names[static_cast<std::size_t>(lamp)]), lamp_material);
    }
    const BandArray L = face.radiance.transpose();
    const auto rgb = display_colors(L, rgb_bands(), model.cameras.front().scale);
    for (const Eigen::Vector3d& p : face.outline) add_vertex(p, rgb.data(), text);
    text += "f";
    for (std::size_t c = 0; c < face.outline.size(); ++c) fmt::format_to(out, " {}", ++last);
    text += "\n";
  }
}

}  // namespace

bool is_exported_library(const std::filesystem::path& mtl) {
  std::string start(library_start.size(), '\0');
  std::ifstream(mtl, std::ios::binary)
      .read(start.data(), static_cast<std::streamsize>(start.size()));
  return start == library_start;
}

void write_obj(const std::filesystem::path& path, const BakedModel& model) {
  std::filesystem::path materials = path;
  materials.replace_extension(".mtl");
  const std::vector<std::uint8_t> colors = srgb_colors(model);
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "# Lightwell {}: baked radiosity of {}; metres\nmtllib {}\n",
                 model.provenance.version, one_line(model.provenance.scene_file),
                 one_line(materials.filename().string()));
  for (const BakedPart& part : model.parts) {
    fmt::format_to(out, "o {}{}\nusemtl {}\n", obj_word(part.name), part.is_back ? "_back" : "",
                   material_word(model, part.material));
    for (int i = part.first_vertex; i < part.first_vertex + part.vertex_count; ++i) {
      add_vertex(model.position[i], colors.data() + std::size_t{3} * i, text);
    }
    for (const auto& triangle : triangles_of(model, part.first_face, part.face_count)) {
      fmt::format_to(out, "f {} {} {}\n", triangle[0] + 1, triangle[1] + 1, triangle[2] + 1);
    }
  }
  add_lamps(model, text);
  const std::string of_materials = library(model);
  write_together({{materials, of_materials}, {path, text}});
}

}  // namespace lightwell
