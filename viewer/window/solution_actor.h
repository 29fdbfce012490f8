#pragma once

#include <vtkSmartPointer.h>

#include <cstdint>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "viewer/export/appearance.h"
#include "viewer/export/drawn_pictures.h"
#include "viewer/window/fine_round_shapes.h"

class vtkActor;
class vtkCellArray;
class vtkPolyData;
class vtkRenderer;
class vtkTexture;
class vtkUnsignedCharArray;

namespace lightwell {

/// The mesh as VTK actors: Gouraud-shaded polygons whose vertex colours are shown without VTK's
/// lighting. Every side of a surface has elements of its own, so back faces are culled. A room can
/// then be seen from outside, and the two sides of a wall never overlap in a pixel.
class SolutionActor {
 public:
  /// `radiance` (vertices x bands) splits each quad along the diagonal whose ends differ less, so
  /// that the crease follows the light. Lit elements show their textures. Keeps a reference to
  /// `spheres`.
  SolutionActor(const PatchMesh& mesh, const FineRoundShapes& spheres,
                const std::vector<ElementKind>& kinds, const BandArray& radiance,
                const DrawnPictures& drawn);
  ~SolutionActor();

  /// Sets the kinds of elements and the splits of quads for other light on the same mesh.
  void set_shapes(const PatchMesh& mesh, const std::vector<ElementKind>& kinds,
                  const BandArray& radiance);

  void add_to(vtkRenderer* renderer) const;
  /// Sets vertex colours, 3 bytes a vertex. `plain`: sRGB for elements without a texture. `codes`:
  /// light_codes() of a white texel for elements with a texture; empty: textures are not shown.
  void set_colors(const std::vector<std::uint8_t>& plain, const std::vector<std::uint8_t>& codes);
  /// Shows instead the class of each point by its illuminance, interpolated from `lux` at vertices
  /// (see lux_classes), so that borders between classes are sharp.
  void set_classes(const std::vector<float>& lux);
  /// Shows or hides the outlines of elements.
  void show_mesh(bool shown);
  /// Draws surfaces without light in black, or leaves them out.
  void show_unlit(bool shown);

 private:
  struct Part {
    ElementKind kind;
    bool is_fine = false;  ///< faces of FineRoundShapes; outlines_ has their elements' edges
    vtkSmartPointer<vtkPolyData> data;
    vtkSmartPointer<vtkActor> actor;
  };
  /// Elements that show one texture, if they are lit. Each corner of an element is a point of its
  /// own, with its texture coordinates.
  struct PicturedPart {
    Part part;
    vtkSmartPointer<vtkTexture> texture;
    vtkSmartPointer<vtkUnsignedCharArray> colors;
    std::vector<int> element{}, mesh_vertex{};  ///< mesh_vertex: one a point
    bool has_holes = false;
  };
  vtkSmartPointer<vtkCellArray> polygons_of(const PatchMesh& mesh, const Part& part,
                                            const std::vector<ElementKind>& kinds,
                                            const BandArray& radiance) const;
  /// Adds or removes the program that turns coded illuminance into colours of classes.
  void show_classes(bool shown);
  static void show_picture(const PicturedPart& pictured, bool shown);
  void add_pictures(const PatchMesh& mesh, const DrawnPictures& drawn);

  const FineRoundShapes& spheres_;
  std::vector<Part> parts_;
  vtkSmartPointer<vtkActor> outlines_;  ///< edges of the spheres' elements
  vtkSmartPointer<vtkUnsignedCharArray> colors_;
  std::vector<PicturedPart> pictured_;
  bool shows_classes_ = false;
  std::vector<char> has_picture_;  ///< by element; empty: no textures
};

}  // namespace lightwell
