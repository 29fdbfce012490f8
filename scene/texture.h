#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace lightwell {

/// A picture for surfaces: texels of linear shares in [0,1], one channel or three, rows from the
/// top. All coarser levels are kept (mip map; Williams 1983), each the mean of the level before.
/// Position (0,0) is the picture's top left corner, (1,1) its bottom right corner.
class Texture {
 public:
  /// 16-bit code of a share in [0,1]: the square root, which is finer in the dark.
  using Code = std::uint16_t;
  static Code encode(float share);
  static float decode(Code code) {
    constexpr float scale = 1.0f / (65535.0f * 65535.0f);
    return scale * static_cast<float>(code) * static_cast<float>(code);
  }

  /// `texels`: width x height x channels (1 or 3). Throws std::invalid_argument if the sizes
  /// differ.
  Texture(int width, int height, int channels, std::vector<Code> texels);

  int width() const { return levels_.front().width; }
  int height() const { return levels_.front().height; }
  int channels() const { return channels_; }
  int level_count() const { return static_cast<int>(levels_.size()); }
  int level_width(int level) const { return levels_[static_cast<std::size_t>(level)].width; }
  int level_height(int level) const { return levels_[static_cast<std::size_t>(level)].height; }

  /// Texel (x, y) of a level, within the level's size; a single channel is repeated three times.
  Eigen::Array3f texel(int level, int x, int y) const;
  /// Mean of all texels, per channel.
  Eigen::Array3f mean() const { return mean_; }
  /// Largest texel, per channel.
  Eigen::Array3f largest() const { return largest_; }
  /// Hash of size and texels, equal for equal pictures.
  std::uint64_t hash() const { return hash_; }

  /// A picture with three channels whose texels are `change` of this picture's texels; shares in
  /// [0,1].
  Texture mapped(const std::function<Eigen::Array3f(const Eigen::Array3f&)>& change) const;

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<Code> texels{};
  };
  Level halved(const Level& from) const;
  void measure();

  int channels_ = 3;
  std::vector<Level> levels_{};  // the last is one texel
  Eigen::Array3f mean_ = Eigen::Array3f::Zero(), largest_ = Eigen::Array3f::Zero();
  std::uint64_t hash_ = 0;
};

/// Continuation of a picture beyond its edges.
enum class TextureWrap : std::uint8_t { repeat, mirror, clamp };

/// A picture and its layout over texture coordinates (u, v).
struct SurfaceTexture {
  std::shared_ptr<const Texture> picture{};  ///< shared by all materials that show it; not null
  std::array<TextureWrap, 2> wrap = {TextureWrap::repeat, TextureWrap::repeat};  ///< in u and v
  bool is_smooth = true;  ///< bilinear between the middles of texels; else texels are flat squares
  /// Position in the picture: placement * (u, v, 1).
  Eigen::Matrix<double, 2, 3> placement = Eigen::Matrix<double, 2, 3>::Identity();

  /// Unfiltered value of the picture at (u, v).
  Eigen::Array3f at(const Eigen::Vector2d& uv) const;
  /// Mean of the picture about (u, v) over the parallelogram with sides `footprint` (columns, in u
  /// and v): linear between texels and between levels of the mip map, at up to 16 sample points
  /// along the longer side (McCormack, Perry, Farkas & Jouppi 1999).
  Eigen::Array3f over(const Eigen::Vector2d& uv, const Eigen::Matrix2d& footprint) const;

 private:
  Eigen::Vector2d place(const Eigen::Vector2d& uv) const {
    return placement.leftCols<2>() * uv + placement.col(2);
  }
  Eigen::Array3f at_level(const Eigen::Vector2d& place, int level) const;
};

/// Texture coordinates over a facet's plane: (u, v) = gradient p + offset, p in metres.
struct UvMap {
  Eigen::Matrix<double, 2, 3> gradient = Eigen::Matrix<double, 2, 3>::Zero();  ///< 1/m
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();

  Eigen::Vector2d at(const Eigen::Vector3d& p) const { return gradient * p + offset; }
};

}  // namespace lightwell
