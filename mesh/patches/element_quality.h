#pragma once

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Shape of one element; of a sphere's element, the shape of the polygon of its corners.
struct ElementShape {
  /// Least of the angles at the corners; at best 60 in a triangle, 90 in a quadrilateral.
  double least_angle_degrees = 0.0;
  /// Longest edge times perimeter over 4 sqrt(3) A in a triangle and over 4 A in a quadrilateral
  /// (Stimpson, Ernst, Knupp, Pebay & Thompson 2007, "The Verdict geometric quality library"; the
  /// "aspect ratio" of VTK and ParaView). 1 for equal sides and right angles, about half of length
  /// over width for long elements, infinite without area.
  double aspect_ratio = 1.0;
};
ElementShape element_shape(const PatchMesh& mesh, int element);

/// Statistics of the elements of all fronts. Backs are the same elements turned over.
struct ElementQuality {
  int patches = 0, elements = 0;  ///< of fronts only
  double area = 0.0;              ///< m^2
  double least_angle_degrees = 180.0;
  /// Share of elements with a smaller angle, [0,1].
  double below_10_degrees = 0.0, below_20_degrees = 0.0;
  double largest_aspect_ratio = 1.0;
  /// Elements of least and greatest area; the first of equals; -1: none.
  int smallest = -1, largest = -1;
};
ElementQuality element_quality(const PatchMesh& mesh);

/// Area of all polygons and exact spheres, one side each, m^2: the area that the fronts' elements
/// have to cover.
double scene_area(const Scene& scene);

}  // namespace lightwell
