#pragma once

#include <vtkSmartPointer.h>

#include <cstdint>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "viewer/export/appearance.h"
#include "viewer/export/drawn_pictures.h"
#include "viewer/window/fine_spheres.h"

class vtkActor;
class vtkCellArray;
class vtkPolyData;
class vtkRenderer;
class vtkTexture;
class vtkUnsignedCharArray;

namespace lightwell {

/// The mesh in VTK's terms: unlit, Gouraud-shaded polygons whose vertex colours are shown as they
/// are. Every side of a surface has elements of its own, so what faces away from the eye is left
/// out: a room can be looked into from outside, and the two sides of a wall never fight for a
/// pixel.
class SolutionActor {
 public:
  /// `radiance` (vertices x bands) decides how quads are split: along the diagonal whose ends
  /// differ less, so that the crease follows the light. Lit elements show their pictures. Keeps a
  /// reference to `spheres`.
  SolutionActor(const PatchMesh& mesh, const FineSpheres& spheres,
                const std::vector<ElementKind>& kinds, const BandArray& radiance,
                const DrawnPictures& drawn);
  ~SolutionActor();

  /// Of the same mesh: what its elements are, and how quads are split, with other light.
  void set_shapes(const PatchMesh& mesh, const std::vector<ElementKind>& kinds,
                  const BandArray& radiance);

  void add_to(vtkRenderer* renderer) const;
  /// 3 bytes a vertex: sRGB of elements without a picture, and for those with one light_codes of a
  /// white texel. Without the latter no pictures are shown.
  void set_colors(const std::vector<std::uint8_t>& plain, const std::vector<std::uint8_t>& codes);
  /// Draws the elements' outlines.
  void show_mesh(bool shown);
  /// Whether surfaces without any light are drawn (black) or looked through.
  void show_unlit(bool shown);

 private:
  struct Part {
    ElementKind kind;
    bool is_fine = false;  ///< of spheres, whose outlines are drawn by themselves
    vtkSmartPointer<vtkPolyData> data;
    vtkSmartPointer<vtkActor> actor;
  };
  /// Elements that show one picture, if they are lit. Each corner is a point of its own, with its
  /// place in the picture.
  struct PicturedPart {
    Part part;
    vtkSmartPointer<vtkTexture> texture;
    vtkSmartPointer<vtkUnsignedCharArray> colors;
    std::vector<int> element{}, mesh_vertex{};  ///< of each point the vertex
    bool has_holes = false;
  };
  vtkSmartPointer<vtkCellArray> polygons_of(const PatchMesh& mesh, const Part& part,
                                            const std::vector<ElementKind>& kinds,
                                            const BandArray& radiance) const;
  static void show_picture(const PicturedPart& pictured, bool shown);
  void add_pictures(const PatchMesh& mesh, const DrawnPictures& drawn);

  const FineSpheres& spheres_;
  std::vector<Part> parts_;
  vtkSmartPointer<vtkActor> outlines_;  ///< of the spheres' elements
  vtkSmartPointer<vtkUnsignedCharArray> colors_;
  std::vector<PicturedPart> pictured_;
  std::vector<char> has_picture_;  ///< by element; empty: none has
};

}  // namespace lightwell
