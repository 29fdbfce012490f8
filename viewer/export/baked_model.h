#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "radiosity/solve.h"
#include "scene/scene.h"
#include "viewer/export/drawn_pictures.h"

namespace lightwell {

class JoinedSurfaces;

/// One row of linear Rec. 709 RGB per vertex.
using RgbArray = Eigen::Array<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// One side of one surface, or of it what shows a picture, or what shows none. Its vertices and
/// faces follow one another, and no other part uses them.
struct BakedPart {
  std::string name{};              ///< the surface's; "surface 3" where no scene tells it
  int surface = 0;                 ///< index into Scene::surfaces
  int material = 0;                ///< index into BakedModel::materials
  int picture = -1;                ///< index into BakedModel::pictures; -1: none
  std::optional<Sphere> sphere{};  ///< on which its vertices lie, in the scene's axes
  bool is_back = false;
  int first_vertex = 0, vertex_count = 0;
  int first_face = 0, face_count = 0;
};

struct BakedMaterial {
  std::string name{};  ///< "material 2" where no scene tells it
  bool is_glass = false;
  /// A mirror is drawn as if it scattered what it mirrors (see shown_radiance).
  bool is_mirror = false;
};

/// A place to look from, with the exposure of the second pass's picture from there.
struct BakedCamera {
  Camera camera{};
  double scale = 1.0;  ///< from radiance to display values (see exposure_scale)
};

/// Light of one channel of the solution, with the part of its scale that is not `weight`: times
/// `weight`, the channels add up to the model's own.
struct BakedChannel {
  std::string name{};
  // Per vertex.
  RgbArray radiance{};  ///< as BakedModel::radiance
  BandArray
      illuminance{};  ///< lx, vertices x 3 of red, green and blue, which add up; spectral: x 1
  Spectrum lumens{};  ///< of its emitters, in the columns of `illuminance`
  Eigen::Array3f weight = Eigen::Array3f::Ones();  ///< in force; spectral: three times the same
};

/// What is seen outside of the scene: radiance as linear Rec. 709 RGB, W/(m^2 sr), which is to be
/// multiplied by the weight of its channel where it has one. Directions are the scene's, unit.
struct BakedSky {
  int columns = 0, rows_above = 0, rows_below = 0;     ///< see SkyGrid
  RgbArray radiance{};                                 ///< of the grid
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: north, east and up
  int channel = -1;                      ///< of the dome, index into BakedModel::channels
  std::optional<Eigen::Vector3d> sun{};  ///< towards it
  double cosine_of_edge = 1.0;           ///< of the angle from the sun's middle to its edge
  Eigen::Array3f sun_radiance = Eigen::Array3f::Zero();  ///< on top of the dome's
  int sun_channel = -1;
};

/// A solution ready to be written in another program's format: triangles and quads with a colour at
/// every vertex. Vertices are those of the mesh, so they are shared only where light is continuous.
/// Of two sides that lie on each other one without light is left out, so that nothing flickers and
/// a closed room can be looked into; light of a channel that is off counts as light. Where pictures
/// meet that do not go on alike, vertices are not shared.
struct BakedModel {
  std::string title{};
  std::vector<BakedPart> parts{};
  std::vector<BakedMaterial> materials{};
  std::vector<DrawnPicture> pictures{};

  // Per vertex.
  std::vector<int> mesh_vertex{};           ///< of the solution's mesh
  std::vector<Eigen::Vector3d> position{};  ///< metres, the scene's axes
  RgbArray radiance{};                      ///< W/(m^2 sr) shown as light: see shown_radiance
  BandArray radiosity{};                    ///< B, W/m^2, vertices x bands
  BandArray irradiance{};                   ///< E, W/m^2, vertices x bands
  std::vector<float> illuminance{};         ///< lx
  // Empty in a model without pictures. Light and reflectances above are means over a patch.
  std::vector<Eigen::Vector2f> place{};  ///< in the part's picture (see DrawnPictures::place)
  RgbArray picture_gain{};               ///< times `radiance` is what a white texel shows

  std::vector<BakedChannel> channels{};  ///< the light above by who emits it; empty: as one

  // Per face.
  /// Vertices counter-clockwise seen from the side that is lit; [3] is -1 for a triangle. A quad
  /// that must become two triangles is split from [0] to [2] (see first_corner).
  std::vector<std::array<int, 4>> faces{};
  std::vector<int> element{};                ///< of the mesh
  std::vector<std::uint8_t> black_behind{};  ///< 1: its other side was left out

  std::optional<BakedSky> sky{};
  std::vector<BakedCamera> cameras{};  ///< the scene's, or one that shows all; never empty
  bool cameras_are_given = false;      ///< they are the scene's
  /// Rotates the scene's axes to those of glTF, y upwards. Its transpose rotates back.
  Eigen::Matrix3d to_y_up = Eigen::Matrix3d::Identity();
  Bands bands{};
  double metres_per_unit = 1.0;
  std::string unit_name = "m";
  bool relative_units = false;
  Provenance provenance{};

  int vertex_count() const { return static_cast<int>(position.size()); }
  int face_count() const { return static_cast<int>(faces.size()); }
  int corner_count(int face) const { return faces[static_cast<std::size_t>(face)][3] < 0 ? 3 : 4; }
};

/// `scene` gives names, mirrors, glass and cameras; without surfaces and cameras in it they have
/// numbers for names, and the model is looked at from where all is seen. `exposure_ev`: stops on
/// top of the automatic exposure of every camera. Where polygons of several surfaces were joined
/// (`names`, of this scene; null: nowhere) an element goes to the surface that has its middle.
/// Throws InputError if the scene has other surfaces or materials than the solution.
BakedModel bake_model(const SolvedScene& solved, const Scene& scene, double exposure_ev = 0.0,
                      const JoinedSurfaces* names = nullptr);

/// 8-bit sRGB, 3 bytes a vertex: the picture from the first camera (see display_colors).
std::vector<std::uint8_t> srgb_colors(const BakedModel& model);

/// The triangles of a model's faces, first_face to first_face + face_count - 1.
std::vector<std::array<int, 3>> triangles_of(const BakedModel& model, int first_face,
                                             int face_count);

}  // namespace lightwell
