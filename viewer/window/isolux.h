#pragma once

#include <vtkSmartPointer.h>

#include <vector>

#include "viewer/window/fine_round_shapes.h"
#include "viewer/window/visible_hits.h"

class vtkActor;
class vtkPolyData;
class vtkRenderer;
class vtkTextActor;

namespace lightwell {

/// Lines of equal illuminance on the surfaces, some with their level beside them. A line is drawn
/// only where its side of the surface faces the eye.
class IsoluxLines {
 public:
  IsoluxLines();
  ~IsoluxLines();

  void add_to(vtkRenderer* renderer) const;
  /// Contours the illuminance at `levels` (lx). `lux` has one value a vertex; `radiance` (vertices
  /// x bands) splits quads as SolutionActor does. `lift` is the distance of lines from surfaces, m.
  void set(const PatchMesh& mesh, const FineRoundShapes& spheres,
           const std::vector<ElementKind>& kinds, const std::vector<float>& lux,
           const BandArray& radiance, const std::vector<double>& levels, double lift);
  void show(bool shown);
  /// Draws the lines that face the camera, and the labels that nothing hides. No effect while the
  /// lines are hidden.
  void look_from(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                 const Camera& camera, const VisibleHitOptions& options);
  int segment_count() const { return static_cast<int>(segments_.size()); }

 private:
  struct Segment {
    Eigen::Vector3d from, to, normal;
    double level = 0.0;
  };
  struct Label {
    Eigen::Vector3d place, normal;
    double level = 0.0;
  };
  void place_labels(double apart);

  bool shown_ = false;
  std::vector<Segment> segments_{};
  std::vector<Label> labels_{};  ///< at most as many as texts_
  std::vector<vtkSmartPointer<vtkTextActor>> texts_{};
  vtkSmartPointer<vtkPolyData> data_;
  vtkSmartPointer<vtkActor> dark_,
      bright_;  ///< a bright line on a wider dark one reads on any colour
};

}  // namespace lightwell
