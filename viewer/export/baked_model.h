#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radiosity/solve.h"
#include "scene/scene.h"

namespace lightwell {

struct BakedYear;
class JoinedSurfaces;

/// One row of linear Rec. 709 RGB per vertex.
using RgbArray = Eigen::Array<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// A surface's texture and mask in the form of graphics hardware and model files.
struct DrawnPicture {
  int width = 0, height = 0;
  /// 4 bytes a texel, rows from the top: sRGB of rho, or of the exitance of a picture of emission,
  /// over `brightest`; alpha 0 in holes, else 255.
  std::vector<std::uint8_t> rgba{};
  Eigen::Array3f brightest = Eigen::Array3f::Ones();  ///< of a white texel, > 0
  bool has_holes = false;
  bool is_smooth = true;  ///< texels are interpolated; else flat squares
  std::array<TextureWrap, 2> wrap = {TextureWrap::repeat, TextureWrap::repeat};
};

/// One side of a surface, restricted to facets with one picture or to those without. A part's
/// vertices and faces are consecutive and belong to no other part.
struct BakedPart {
  std::string name{};              ///< the surface's; "surface 3" where the scene has no name
  int surface = 0;                 ///< index into Scene::surfaces
  int material = 0;                ///< index into BakedModel::materials
  int picture = -1;                ///< index into BakedModel::pictures; -1: none
  std::optional<Sphere> sphere{};  ///< on which the part's vertices lie, in the scene's axes
  bool is_back = false;
  int first_vertex = 0, vertex_count = 0;
  int first_face = 0, face_count = 0;
};

struct BakedMaterial {
  std::string name{};  ///< "material 2" where the scene has no name
  bool is_glass = false;
  /// Mirrors are drawn as if they scattered the mirrored light diffusely.
  bool is_mirror = false;
};

/// Camera with the exposure of the second pass's picture.
struct BakedCamera {
  Camera camera{};
  double scale = 1.0;  ///< from radiance to display values (see exposure_scale)
};

/// A plane face of a luminaire, of one colour.
struct BakedLampFace {
  int lamp = 0;                                      ///< index into BakedModel::lamp_names
  std::vector<Eigen::Vector3d> outline{};            ///< convex; metres, the scene's axes
  Eigen::Array3f radiance = Eigen::Array3f::Zero();  ///< as BakedModel::radiance
  std::vector<Eigen::Array3f> by_channel{};          ///< as BakedChannel::radiance, one per channel
};

/// Light of one channel of the solution. The channels' light times `weight` sums to the model's.
/// With spectral bands `weight` is the largest band of the channel's scale; the light includes the
/// rest of the scale, scale / weight.
struct BakedChannel {
  std::string name{};
  // Per vertex.
  RgbArray radiance{};     ///< as BakedModel::radiance
  RgbArray illuminance{};  ///< lx
  /// Luminous flux of the channel's emitters: of red, green and blue; spectral: one number.
  Spectrum lumens{};
  Eigen::Array3f weight = Eigen::Array3f::Ones();  ///< effective; spectral: three equal numbers
};

/// A lighting cue (see Cue) for the channels of a model.
struct BakedCue {
  std::string name{};
  std::vector<Eigen::Array3f> weights{};  ///< of all channels, as BakedChannel::weight
  double fade_up = 0.0, fade_down = 0.0, wait = 0.0, hold = 0.0;  ///< s
};

/// Sky, ground and sun around the scene. Radiance is linear Rec. 709 RGB, W/(m^2 sr), before the
/// weight of the dome's or the sun's channel. Directions are unit vectors in the scene's axes.
struct BakedSky {
  int columns = 0, rows_above = 0, rows_below = 0;     ///< steps of azimuth; of altitude
  RgbArray radiance{};                                 ///< rows * columns, the zenith's row first
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: north, east and up
  int channel = -1;                      ///< the dome's, index into BakedModel::channels; -1: none
  std::optional<Eigen::Vector3d> sun{};  ///< direction towards the sun
  double cosine_of_edge = 1.0;           ///< cosine of the sun's angular radius
  Eigen::Array3f sun_radiance = Eigen::Array3f::Zero();  ///< added to the dome's
  int sun_channel = -1;                                  ///< as `channel`
};

/// Solution ready to be written in another program's format: triangles and quads with a colour at
/// every vertex.
/// - Vertices are the mesh's, shared only where light is continuous. Facets whose pictures have
///   different texture maps do not share vertices.
/// - Of two coincident sides an unlit one is left out, so that no depth fighting occurs and a
///   closed room can be seen into. A side counts as lit by a channel that is off. Sides chooses
///   between two lit ones.
struct BakedModel {
  std::string title{};
  std::vector<BakedPart> parts{};
  std::vector<BakedMaterial> materials{};
  std::vector<DrawnPicture> pictures{};

  // Per vertex.
  std::vector<int> mesh_vertex{};           ///< vertex of the solution's mesh
  std::vector<Eigen::Vector3d> position{};  ///< metres, the scene's axes
  RgbArray radiance{};                      ///< W/(m^2 sr) shown as light: B / pi
  BandArray radiosity{};                    ///< B, W/m^2, vertices x bands
  BandArray irradiance{};                   ///< E, W/m^2, vertices x bands
  std::vector<float> illuminance{};         ///< lx
  // Per vertex; empty in a model without pictures. The radiosity above is for the mean reflectance
  // of each patch.
  std::vector<Eigen::Vector2f> place{};  ///< in the part's picture; (0, 0): top left
  RgbArray picture_gain{};               ///< factor from `radiance` to that of a white texel

  std::vector<BakedChannel> channels{};  ///< the light above by channel; empty: not separated

  std::vector<BakedCue> cues{};  ///< for pages

  /// Names of the scene's lamps, numbered where another lamp or a surface has that name.
  std::vector<std::string> lamp_names{};
  std::vector<BakedLampFace> lamp_faces{};  ///< in the order of lamps

  // Per face.
  /// Vertices, counter-clockwise seen from the face's side; [3] is -1 for a triangle. Two triangles
  /// of a quad share the diagonal from [0] to [2].
  std::vector<std::array<int, 4>> faces{};
  std::vector<int> element{};  ///< element of the mesh
  /// Bound of the error of illuminance in each face, lx, odds of about 19 to 1; empty if the
  /// solution has no error estimate.
  std::vector<float> lux_within{};
  std::vector<std::uint8_t> black_behind{};  ///< 1: the face's other side was left out

  std::optional<BakedSky> sky{};
  /// Data of pages of a year. The light above is then the mean of the year's hours with light.
  std::shared_ptr<const BakedYear> year{};
  std::vector<BakedCamera> cameras{};  ///< the scene's, or a chosen one; never empty
  bool cameras_are_given = false;      ///< `cameras` are the scene's
  /// Scale of linear colours, which files clip at 1: that of the first camera, or as little as an
  /// eighth of it, so that 99 of 100 vertices are not clipped; lamps do not count.
  double color_scale = 1.0;
  /// Rotation from the scene's axes to glTF's, y upwards; the transpose rotates back.
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

/// Choice of the sides of thin surfaces that a model has. The two sides of a thin surface lie on
/// each other, and programs that draw the backs of faces too show now the one, now the other. In
/// all three an unlit side is left out if its other side has light.
enum class Sides : std::uint8_t {
  lit,    ///< all with light, in their places: for a drawer that shows no backs, such as the page
  front,  ///< those that are seen from within rooms or by cameras; two of them are moved apart
  both,   ///< all with light; two of them are moved apart
};

/// Collects a solution's geometry, light and pictures into a model.
/// - `scene` supplies names, mirrors, glass, pictures, sky and cameras. Surfaces and materials
///   without a name are numbered. Without cameras the model has one, of the whole scene from
///   outside or across the room.
/// - `exposure_ev`: stops added to the automatic exposure of every camera.
/// - `names`, of this scene: polygons that join several surfaces; null: none. An element belongs to
///   the surface that contains the element's centre.
/// - `sides`: which sides of thin surfaces the model has.
/// Throws InputError if the scene has surfaces, but fewer than the solution, and for bands other
/// than RGB without wavelengths.
BakedModel bake_model(const SolvedScene& solved, const Scene& scene, double exposure_ev = 0.0,
                      const JoinedSurfaces* names = nullptr, Sides sides = Sides::lit);

/// Colours at the exposure of the first camera, 8-bit sRGB, 3 bytes a vertex.
std::vector<std::uint8_t> srgb_colors(const BakedModel& model);

/// Triangles of a model's faces first_face to first_face + face_count - 1, as vertices.
std::vector<std::array<int, 3>> triangles_of(const BakedModel& model, int first_face,
                                             int face_count);

}  // namespace lightwell
