#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <string_view>

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

/// The MTL: white materials without shading, so that programs that multiply vertex colours by Kd
/// show the vertex colours.
std::string library(const BakedModel& model) {
  std::string text =
      std::string(library_start) + ": the light is in the colours of the vertices.\n";
  for (int m = 0; m < static_cast<int>(model.materials.size()); ++m) {
    text += fmt::format("\nnewmtl {}\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nillum 0\n",
                        material_word(model, m));
    if (model.materials[m].is_glass) text += fmt::format("d {:g}\n", glass_opacity);
  }
  return text;
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
      const Eigen::Vector3d& p = model.position[i];
      const std::uint8_t* rgb = colors.data() + std::size_t{3} * i;
      fmt::format_to(out, "v {:.9g} {:.9g} {:.9g} {:.4g} {:.4g} {:.4g}\n", p.x(), p.y(), p.z(),
                     rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0);
    }
    for (const auto& triangle : triangles_of(model, part.first_face, part.face_count)) {
      fmt::format_to(out, "f {} {} {}\n", triangle[0] + 1, triangle[1] + 1, triangle[2] + 1);
    }
  }
  const std::string of_materials = library(model);
  write_together({{materials, of_materials}, {path, text}});
}

}  // namespace lightwell
