#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "radiosity/solve.h"

namespace lightwell {

/// A solved scene of quadrilaterals, each with its own facet, patch and material, and with given
/// irradiance at every corner, so that expected colours are known without a solve.
class SolvedQuads {
 public:
  /// Corners counter-clockwise seen from the front. Reflectance is 1, so radiosity = irradiance.
  /// Returns the element's number.
  int add(const std::array<Eigen::Vector3d, 4>& corners,
          const std::array<Eigen::Array3f, 4>& irradiance) {
    const int e = static_cast<int>(corners_.size());
    const int v = static_cast<int>(positions_.size());
    positions_.insert(positions_.end(), corners.begin(), corners.end());
    irradiance_.insert(irradiance_.end(), irradiance.begin(), irradiance.end());
    corners_.push_back({v, v + 1, v + 2, v + 3});
    return e;
  }
  int add(const std::array<Eigen::Vector3d, 4>& corners, const Eigen::Array3f& irradiance) {
    return add(corners, {irradiance, irradiance, irradiance, irradiance});
  }

  SolvedScene solved() const {
    SolvedScene result;
    PatchMesh& mesh = result.mesh;
    const int n = static_cast<int>(corners_.size());
    mesh.corners = corners_;
    mesh.element_area = Eigen::ArrayXd::Ones(n);
    mesh.area = Eigen::ArrayXd::Ones(n);
    mesh.twin.assign(n, -1);
    mesh.is_back.assign(n, 0);
    mesh.reflectance = BandArray::Ones(n, 3);
    mesh.emission = BandArray::Zero(n, 3);
    for (int e = 0; e < n; ++e) {
      mesh.patch.push_back(e);
      mesh.first_element.push_back(e);
      mesh.surface.push_back(e);
      mesh.material.push_back(e);
      mesh.facet.push_back(e);
    }
    mesh.first_element.push_back(n);
    build_topology(mesh, positions_);
    RadiositySolution& s = result.solution;
    s.bands = rgb_bands();
    s.patch_radiosity = BandArray::Zero(n, 3);
    s.indirect_irradiance = BandArray::Zero(4 * n, 3);
    s.direct_irradiance = BandArray::Zero(4 * n, 3);
    for (int v = 0; v < 4 * n; ++v) s.direct_irradiance.row(v) = irradiance_[v].transpose();
    s.provenance.scene_file = "box.toml";
    return result;
  }

 private:
  std::vector<Eigen::Vector3d> positions_;
  std::vector<Eigen::Array3f> irradiance_;
  std::vector<std::array<int, 4>> corners_;
};

inline const Eigen::Array3f red{3.0f, 0.3f, 0.3f};
inline const Eigen::Array3f green{0.3f, 2.0f, 0.3f};
inline const Eigen::Array3f blue{0.3f, 0.3f, 2.5f};
inline const Eigen::Array3f white{2.0f, 2.0f, 2.0f};
inline const Eigen::Array3f grey{1.0f, 1.0f, 1.0f};

/// The room [0,2]^3, y up, open towards -z, with walls that face inwards. For a camera along +z
/// with y up, world +x with the green wall is on the left (right is direction x up), and the red
/// wall on the right.
inline SolvedScene solved_box() {
  SolvedQuads quads;
  quads.add({{{2, 0, 0}, {2, 0, 2}, {2, 2, 2}, {2, 2, 0}}}, green);  // x = 2, faces -x
  quads.add({{{0, 0, 0}, {0, 2, 0}, {0, 2, 2}, {0, 0, 2}}}, red);    // x = 0, faces +x
  quads.add({{{0, 0, 2}, {0, 2, 2}, {2, 2, 2}, {2, 0, 2}}}, white);  // z = 2, faces -z
  quads.add({{{0, 0, 0}, {0, 0, 2}, {2, 0, 2}, {2, 0, 0}}}, grey);   // y = 0, faces +y
  quads.add({{{0, 2, 0}, {2, 2, 0}, {2, 2, 2}, {0, 2, 2}}}, blue);   // y = 2, faces -y
  return quads.solved();
}

/// The box with light that varies over each wall.
inline SolvedScene shaded_box() {
  SolvedScene box = solved_box();
  for (int v = 0; v < box.mesh.vertex_count(); ++v) {
    const Eigen::Vector3d p = box.mesh.position(v);
    box.solution.direct_irradiance.row(v) *=
        static_cast<float>(1.0 + 0.5 * p.x() + 0.2 * p.y() + 0.1 * p.z() * p.x());
  }
  return box;
}

/// A camera in front of the opening.
inline Camera box_camera() {
  Camera camera;
  camera.name = "front";
  camera.position = {1, 1, -3};
  camera.direction = {0, 0, 1};
  camera.up = {0, 1, 0};
  camera.fov_degrees = 40.0;
  camera.width = 200;
  camera.height = 150;
  return camera;
}

}  // namespace lightwell
