#pragma once

#include <vtkSmartPointer.h>

#include <Eigen/Core>
#include <vector>

class vtkActor;
class vtkPolyData;
class vtkRenderer;

namespace lightwell {

/// Points in the scene, joined by a line: what was clicked or measured. Seen through walls too,
/// since a distance may well go through one.
class Marks {
 public:
  Marks();
  ~Marks();

  void add_to(vtkRenderer* renderer) const;
  void set(const std::vector<Eigen::Vector3d>& points);

 private:
  vtkSmartPointer<vtkPolyData> data_;
  vtkSmartPointer<vtkActor> actor_;
};

}  // namespace lightwell
