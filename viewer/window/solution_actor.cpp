#include "viewer/window/solution_actor.h"

#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkShaderProperty.h>
#include <vtkTexture.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "viewer/window/lux_classes.h"

namespace lightwell {
namespace {

constexpr double edge_grey = 0.1;

vtkSmartPointer<vtkActor> make_part_actor(vtkPolyData* data, bool is_glass) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->SetColorModeToDirectScalars();
  mapper->SetScalarModeToUsePointData();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  vtkProperty* property = actor->GetProperty();
  property->LightingOff();
  property->BackfaceCullingOn();
  property->SetEdgeColor(edge_grey, edge_grey, edge_grey);
  property->SetLineWidth(1.0f);
  if (is_glass) property->SetOpacity(glass_opacity);
  return actor;
}

/// Illuminance in 24 bits over the three bytes of a colour, which graphics hardware interpolates
/// each by itself: a sum of interpolated bytes is the interpolated sum. A step is 0.008 lx; the
/// largest value is above that of the sun.
constexpr float largest_lux = 131072.0f, last_code = 16777215.0f;

std::array<std::uint8_t, 3> lux_code(float lux) {
  const float share = std::clamp(lux / largest_lux, 0.0f, 1.0f);
  const auto code = static_cast<std::uint32_t>(std::lround(double{share} * double{last_code}));
  return {static_cast<std::uint8_t>(code >> 16), static_cast<std::uint8_t>(code >> 8),
          static_cast<std::uint8_t>(code)};
}

std::string class_program() {
  const auto color = [](std::size_t reached) {
    const Eigen::Array3f c = class_color(reached);
    return fmt::format("vec3({:.6f}, {:.6f}, {:.6f})", c[0], c[1], c[2]);
  };
  std::string program = fmt::format(
      "  float lux = dot(ambientColor + diffuseColor, vec3(65536.0, 256.0, 1.0)) * {:.9g};\n"
      "  vec3 of_class = {};\n",
      255.0f * largest_lux / last_code, color(0));
  for (std::size_t i = 0; i < lux_classes.size(); ++i) {
    program += fmt::format("  if (lux >= {:.1f}) of_class = {};\n", lux_classes[i], color(i + 1));
  }
  return program + "  ambientColor = vec3(0.0);\n  diffuseColor = of_class;\n";
}

/// Moves unlit faces back in depth, by the change of their depth over 4 pixels. Where a lit wall
/// stands on a floor that is black underneath, dots of black would show along the edge otherwise.
/// Dots were seen at 1 pixel, none from 2 on.
constexpr const char* behind_program =
    "  gl_FragDepth = gl_FragCoord.z + 4.0 * fwidth(gl_FragCoord.z);\n";

void set_program(vtkActor* actor, bool is_behind, bool shows_classes) {
  vtkShaderProperty* const shaders = actor->GetShaderProperty();
  shaders->ClearAllFragmentShaderReplacements();
  const auto append = [shaders](const std::string& place, const std::string& program) {
    shaders->AddFragmentShaderReplacement(place, true, place + "\n" + program, false);
  };
  // Outlines of elements are drawn over the colours of classes.
  if (shows_classes) append("//VTK::Color::Impl", class_program());
  if (is_behind) append("//VTK::Light::Impl", behind_program);
}

/// Edges of the spheres' elements, along the exact sphere.
vtkSmartPointer<vtkActor> make_outlines(vtkPoints* points, int first,
                                        const FineRoundShapes& spheres) {
  vtkNew<vtkCellArray> lines;
  for (const auto& [from, to] : spheres.outlines) {
    const vtkIdType ends[2] = {first + from, first + to};
    lines->InsertNextCell(2, ends);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(lines);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->SetResolveCoincidentTopologyToPolygonOffset();
  mapper->SetRelativeCoincidentTopologyLineOffsetParameters(0.0, -20.0);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetColor(edge_grey, edge_grey, edge_grey);
  actor->VisibilityOff();
  return actor;
}

vtkSmartPointer<vtkTexture> make_texture(const DrawnPicture& picture) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(picture.width, picture.height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 4);
  std::copy(picture.rgba.begin(), picture.rgba.end(),
            static_cast<unsigned char*>(image->GetScalarPointer()));
  auto texture = vtkSmartPointer<vtkTexture>::New();
  texture->SetInputData(image);
  texture->SetColorModeToDirectScalars();
  texture->SetInterpolate(picture.is_smooth);
  texture->SetMipmap(picture.is_smooth);
  // VTK has one wrap mode for both directions.
  switch (picture.wrap[0]) {
    case TextureWrap::repeat:
      texture->SetWrap(vtkTexture::Repeat);
      break;
    case TextureWrap::mirror:
      texture->SetWrap(vtkTexture::MirroredRepeat);
      break;
    case TextureWrap::clamp:
      texture->SetWrap(vtkTexture::ClampToEdge);
      break;
  }
  return texture;
}

}  // namespace

SolutionActor::SolutionActor(const PatchMesh& mesh, const FineRoundShapes& spheres,
                             const std::vector<ElementKind>& kinds, const BandArray& radiance,
                             const DrawnPictures& drawn)
    : spheres_(spheres), colors_(vtkSmartPointer<vtkUnsignedCharArray>::New()) {
  // Points: the mesh's vertices, then the points of FineRoundShapes.
  const vtkIdType count = mesh.vertex_count() + static_cast<vtkIdType>(spheres.points.size());
  colors_->SetNumberOfComponents(3);
  colors_->SetNumberOfTuples(count);
  colors_->FillValue(0);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(count);
  for (int v = 0; v < mesh.vertex_count(); ++v) points->SetPoint(v, mesh.position(v).data());
  for (std::size_t i = 0; i < spheres.points.size(); ++i) {
    points->SetPoint(mesh.vertex_count() + static_cast<vtkIdType>(i),
                     spheres.points[i].position.data());
  }

  for (const ElementKind kind : {ElementKind::lit, ElementKind::unlit, ElementKind::glass}) {
    for (const bool is_fine : {false, true}) {
      if (is_fine && spheres.points.empty()) continue;
      auto data = vtkSmartPointer<vtkPolyData>::New();
      data->SetPoints(points);
      data->GetPointData()->SetScalars(colors_);
      parts_.push_back({kind, is_fine, data, make_part_actor(data, kind == ElementKind::glass)});
      set_program(parts_.back().actor, kind == ElementKind::unlit, false);
    }
  }
  outlines_ = make_outlines(points, mesh.vertex_count(), spheres);
  if (!drawn.all().empty()) add_pictures(mesh, drawn);
  set_shapes(mesh, kinds, radiance);
}

SolutionActor::~SolutionActor() = default;

void SolutionActor::add_pictures(const PatchMesh& mesh, const DrawnPictures& drawn) {
  has_picture_.assign(static_cast<std::size_t>(mesh.element_count()), 0);
  for (std::size_t p = 0; p < drawn.all().size(); ++p) {
    PicturedPart pictured{.part = {}, .texture = make_texture(drawn.all()[p]), .colors = {}};
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    vtkNew<vtkFloatArray> places;
    places->SetNumberOfComponents(2);
    for (int e = 0; e < mesh.element_count(); ++e) {
      const int facet = mesh.facet[e];
      if (drawn.of(facet) != static_cast<int>(p)) continue;
      has_picture_[e] = 1;
      pictured.element.push_back(e);
      for (int c = 0; c < mesh.corner_count(e); ++c) {
        const int v = mesh.corners[e][c];
        pictured.mesh_vertex.push_back(v);
        points->InsertNextPoint(mesh.position(v).data());
        places->InsertNextTuple(drawn.place(facet, mesh.position(v)).data());
      }
    }
    pictured.colors = vtkSmartPointer<vtkUnsignedCharArray>::New();
    pictured.colors->SetNumberOfComponents(3);
    pictured.colors->SetNumberOfTuples(points->GetNumberOfPoints());
    pictured.colors->FillValue(0);
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points);
    data->GetPointData()->SetScalars(pictured.colors);
    data->GetPointData()->SetTCoords(places);
    pictured.part = {ElementKind::lit, false, data, make_part_actor(data, false)};
    pictured.has_holes = drawn.all()[p].has_holes;
    if (pictured.has_holes) pictured.part.actor->ForceOpaqueOn();
    pictured_.push_back(std::move(pictured));
  }
}

/// The part's elements, without lit elements that show a texture: PicturedPart has those.
vtkSmartPointer<vtkCellArray> SolutionActor::polygons_of(const PatchMesh& mesh, const Part& part,
                                                         const std::vector<ElementKind>& kinds,
                                                         const BandArray& radiance) const {
  auto polygons = vtkSmartPointer<vtkCellArray>::New();
  if (part.is_fine) {
    for (const FineRoundShapes::Face& face : spheres_.faces) {
      if (kinds[face.element] != part.kind) continue;
      polygons->InsertNextCell(face.corner[3] < 0 ? 3 : 4);
      for (const int point : face.corner) {
        if (point >= 0) polygons->InsertCellPoint(mesh.vertex_count() + point);
      }
    }
    return polygons;
  }
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (kinds[e] != part.kind) continue;
    if (part.kind == ElementKind::lit && !has_picture_.empty() && has_picture_[e]) continue;
    if (!spheres_.has_faces.empty() && spheres_.has_faces[e]) continue;
    const int corner_count = mesh.corner_count(e);
    // VTK splits a quad along the diagonal from its first corner.
    const int first = first_corner(mesh, e, radiance);
    polygons->InsertNextCell(corner_count);
    for (int c = 0; c < corner_count; ++c) {
      polygons->InsertCellPoint(mesh.corners[e][(first + c) % corner_count]);
    }
  }
  return polygons;
}

void SolutionActor::set_shapes(const PatchMesh& mesh, const std::vector<ElementKind>& kinds,
                               const BandArray& radiance) {
  for (const Part& part : parts_) {
    part.data->SetPolys(polygons_of(mesh, part, kinds, radiance));
  }
  for (const PicturedPart& pictured : pictured_) {
    auto polygons = vtkSmartPointer<vtkCellArray>::New();
    int point = 0;
    for (const int e : pictured.element) {
      const int count = mesh.corner_count(e), first = first_corner(mesh, e, radiance);
      if (kinds[e] == ElementKind::lit) {
        polygons->InsertNextCell(count);
        for (int c = 0; c < count; ++c) polygons->InsertCellPoint(point + (first + c) % count);
      }
      point += count;
    }
    pictured.part.data->SetPolys(polygons);
  }
}

void SolutionActor::add_to(vtkRenderer* renderer) const {
  for (const Part& part : parts_) renderer->AddActor(part.actor);
  renderer->AddActor(outlines_);
  for (const PicturedPart& pictured : pictured_) renderer->AddActor(pictured.part.actor);
}

void SolutionActor::set_colors(const std::vector<std::uint8_t>& plain,
                               const std::vector<std::uint8_t>& codes) {
  show_classes(false);
  unsigned char* next = std::copy(plain.begin(), plain.end(), colors_->GetPointer(0));
  for (const FineRoundShapes::Point& point : spheres_.points) {
    Eigen::Array3f color = Eigen::Array3f::Constant(0.5f);  // rounds to the nearest byte
    for (int c = 0; c < 4; ++c) {
      if (point.vertex[c] < 0) continue;
      const auto* const bytes = &plain[3 * static_cast<std::size_t>(point.vertex[c])];
      color += point.weight[c] * Eigen::Array3f(bytes[0], bytes[1], bytes[2]);
    }
    for (const float component : color) *next++ = static_cast<unsigned char>(component);
  }
  colors_->Modified();
  for (const Part& part : parts_) part.data->Modified();
  const std::vector<std::uint8_t>& of_pictures = codes.empty() ? plain : codes;
  for (const PicturedPart& pictured : pictured_) {
    unsigned char* out = pictured.colors->GetPointer(0);
    for (const int v : pictured.mesh_vertex) {
      out = std::copy_n(of_pictures.begin() + std::ptrdiff_t{3} * v, 3, out);
    }
    pictured.colors->Modified();
    pictured.part.data->Modified();
    show_picture(pictured, !codes.empty());
  }
}

void SolutionActor::set_classes(const std::vector<float>& lux) {
  unsigned char* next = colors_->GetPointer(0);
  const auto append = [&next](float value) {
    const auto code = lux_code(value);
    next = std::copy(code.begin(), code.end(), next);
  };
  for (const float value : lux) append(value);
  for (const FineRoundShapes::Point& point : spheres_.points) {
    float value = 0.0f;
    for (int c = 0; c < 4; ++c) {
      if (point.vertex[c] < 0) continue;
      value += point.weight[c] * lux[static_cast<std::size_t>(point.vertex[c])];
    }
    append(value);
  }
  colors_->Modified();
  for (const Part& part : parts_) part.data->Modified();
  for (const PicturedPart& pictured : pictured_) {
    unsigned char* out = pictured.colors->GetPointer(0);
    for (const int v : pictured.mesh_vertex) {
      const auto code = lux_code(lux[static_cast<std::size_t>(v)]);
      out = std::copy(code.begin(), code.end(), out);
    }
    pictured.colors->Modified();
    pictured.part.data->Modified();
    show_picture(pictured, false);
  }
  show_classes(true);
}

void SolutionActor::show_classes(bool shown) {
  if (shown == shows_classes_) return;
  shows_classes_ = shown;
  for (const Part& part : parts_) {
    set_program(part.actor, part.kind == ElementKind::unlit, shown);
  }
  for (const PicturedPart& pictured : pictured_) {
    if (!pictured.part.actor->GetTexture()) set_program(pictured.part.actor, false, shown);
  }
}

// Light and texture are multiplied before tone mapping, as in all other pictures: light far above
// white keeps its colour where a dark texel reduces it. VTK multiplies the vertex colour, here the
// light's code, with the texel; a division recovers the texel.
void SolutionActor::show_picture(const PicturedPart& pictured, bool shown) {
  vtkShaderProperty* const shaders = pictured.part.actor->GetShaderProperty();
  if (shown == (pictured.part.actor->GetTexture() != nullptr)) return;
  pictured.part.actor->SetTexture(shown ? pictured.texture.Get() : nullptr);
  shaders->ClearAllFragmentShaderReplacements();
  if (!shown) return;
  shaders->AddFragmentShaderReplacement(
      "//VTK::Light::Impl", true, "//VTK::Light::Impl\n  vec3 light_code = gl_FragData[0].rgb;\n",
      false);
  std::string program = "//VTK::TCoord::Impl\n";
  if (pictured.has_holes) program += "  if (gl_FragData[0].a < 0.5) discard;\n";
  program += fmt::format(R"(
  vec3 texel = gl_FragData[0].rgb / max(light_code, vec3(1e-3));
  vec3 x = mix(texel / 12.92, pow((texel + 0.055) / 1.055, vec3(2.4)), step(0.04045, texel));
  x *= max(exp2({:.1f} * light_code - {:.1f}) - exp2(-{:.1f}), 0.0);
  x = mix(x, 1.0 - 0.5 * exp(1.0 - 2.0 * x), step(0.5, x));
  x = mix(12.92 * x, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, x));
  gl_FragData[0].rgb = x;
)",
                         light_code_stops, light_code_depth, light_code_depth);
  shaders->AddFragmentShaderReplacement("//VTK::TCoord::Impl", true, program, false);
}

void SolutionActor::show_mesh(bool shown) {
  for (const Part& part : parts_) {
    part.actor->GetProperty()->SetEdgeVisibility(shown && !part.is_fine);
  }
  outlines_->SetVisibility(shown);
  for (const PicturedPart& pictured : pictured_) {
    pictured.part.actor->GetProperty()->SetEdgeVisibility(shown);
  }
}

void SolutionActor::show_unlit(bool shown) {
  for (const Part& part : parts_) {
    if (part.kind == ElementKind::unlit) part.actor->SetVisibility(shown);
  }
}

}  // namespace lightwell
