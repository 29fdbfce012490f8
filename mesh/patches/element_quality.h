#pragma once

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Shape of one element; on spheres that of its corners' polygon.
struct ElementShape {
  double least_angle_degrees = 0.0;  ///< of its corners; 60 at best in a triangle, 90 in others
  /// Longest edge times perimeter over 4 sqrt(3) A in a triangle and 4 A in a quadrilateral: 1 for
  /// equal sides and right angles, about half of length over width for what is long, infinite
  /// without area (Stimpson, Ernst, Knupp, Pebay & Thompson 2007, "The Verdict geometric quality
  /// library"; VTK's and ParaView's "aspect ratio").
  double aspect_ratio = 1.0;
};
ElementShape element_shape(const PatchMesh& mesh, int element);

/// Figures over the elements of all fronts: backs are the same places, turned over.
struct ElementQuality {
  int patches = 0, elements = 0;  ///< of fronts
  double area = 0.0;              ///< m^2
  double least_angle_degrees = 180.0;
  double below_10_degrees = 0.0, below_20_degrees = 0.0;  ///< share of elements, [0,1]
  double largest_aspect_ratio = 1.0;
  int smallest = -1, largest = -1;  ///< elements, by area; the first of equals
};
ElementQuality element_quality(const PatchMesh& mesh);

/// m^2 of all polygons and exact spheres, one side each: what the fronts' elements have to cover.
double scene_area(const Scene& scene);

}  // namespace lightwell
