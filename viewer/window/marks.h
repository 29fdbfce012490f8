#pragma once

#include <vtkSmartPointer.h>

#include <Eigen/Core>
#include <vector>

class vtkActor;
class vtkPolyData;
class vtkRenderer;

namespace lightwell {

/// Points that were clicked or measured, joined by a line. Walls do not hide marks, since a
/// measured distance may pass through a wall.
class Marks {
 public:
  Marks();
  ~Marks();

  void add_to(vtkRenderer* renderer) const;
  /// Replaces the points, m. Without points nothing is drawn.
  void set(const std::vector<Eigen::Vector3d>& points);

 private:
  vtkSmartPointer<vtkPolyData> data_;
  vtkSmartPointer<vtkActor> actor_;
};

}  // namespace lightwell
