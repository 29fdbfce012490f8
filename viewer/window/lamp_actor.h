#pragma once

#include <vtkSmartPointer.h>

#include <cstdint>
#include <vector>

#include "raytrace/shading/drawn_lamps.h"

class vtkActor;
class vtkPolyData;
class vtkRenderer;
class vtkUnsignedCharArray;

namespace lightwell {

/// The luminaires of a scene as a VTK actor: flat faces, each of one colour, without VTK's
/// lighting.
class LampActor {
 public:
  explicit LampActor(const DrawnLamps& lamps);
  ~LampActor();

  void add_to(vtkRenderer* renderer) const;
  /// Sets the colours of faces, 3 bytes each. `is_drawn`: one a face; the others are left out.
  void set_colors(const std::vector<std::uint8_t>& colors, const std::vector<char>& is_drawn);
  void show(bool shown);

 private:
  std::vector<int> corner_count_{};  ///< of each face; its points follow those of the face before
  vtkSmartPointer<vtkUnsignedCharArray> colors_;
  vtkSmartPointer<vtkPolyData> data_;
  vtkSmartPointer<vtkActor> actor_;
};

}  // namespace lightwell
