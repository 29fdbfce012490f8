#include "scene/texture.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "scene/parallel.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Source texels whose mean is one coarser texel, with their weights: two of an even row, three of
// an odd one, so that the mean over the whole picture is kept.
struct Cover {
  int first = 0;
  std::array<float, 4> share{};
  int count = 0;
};

std::vector<Cover> texel_covers(int from, int to) {
  std::vector<Cover> result(static_cast<std::size_t>(to));
  const double step = static_cast<double>(from) / to;
  for (int i = 0; i < to; ++i) {
    const double low = i * step, high = (i + 1) * step;
    Cover& cover = result[static_cast<std::size_t>(i)];
    cover.first = static_cast<int>(low);
    for (int x = cover.first; x < std::min<double>(from, high) && cover.count < 4; ++x) {
      const double part = std::min<double>(x + 1, high) - std::max<double>(x, low);
      cover.share[static_cast<std::size_t>(cover.count++)] =
          static_cast<float>(std::max(0.0, part) / step);
    }
  }
  return result;
}

int wrapped_texel(int i, int size, TextureWrap wrap) {
  if (i >= 0 && i < size) return i;  // divisions would take most of the time here
  switch (wrap) {
    case TextureWrap::clamp:
      return std::clamp(i, 0, size - 1);
    case TextureWrap::mirror: {
      const int period = 2 * size, at = ((i % period) + period) % period;
      return at < size ? at : period - 1 - at;
    }
    case TextureWrap::repeat:
      break;
  }
  return ((i % size) + size) % size;
}

// The same position within one period of the wrap, so that its integer part fits an int. Beyond the
// resolution of doubles any position will do.
double within_period(double x, TextureWrap wrap) {
  if (wrap == TextureWrap::clamp) return std::clamp(x, -1.0, 2.0);
  const double period = wrap == TextureWrap::mirror ? 2.0 : 1.0;
  const double rest = x - period * std::floor(x / period);
  return rest >= 0.0 && rest <= period ? rest : 0.0;
}

}  // namespace

Texture::Code Texture::encode(float share) {
  const float inside = share > 0.0f ? std::min(share, 1.0f) : 0.0f;
  return static_cast<Code>(std::lround(65535.0f * std::sqrt(inside)));
}

Texture::Texture(int width, int height, int channels, std::vector<Code> texels)
    : channels_(channels) {
  const bool fits = width > 0 && height > 0 && (channels == 1 || channels == 3) &&
                    texels.size() == std::size_t(width) * std::size_t(height) *
                                         static_cast<std::size_t>(channels);
  if (!fits) throw std::invalid_argument("Texture: the texels do not fill width x height");
  levels_.push_back({.width = width, .height = height, .texels = std::move(texels)});
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    levels_.push_back(halved(levels_.back()));
  }
  measure();
}

Texture::Level Texture::halved(const Level& from) const {
  Level to{.width = std::max(1, from.width / 2), .height = std::max(1, from.height / 2)};
  const std::size_t row = static_cast<std::size_t>(to.width) * static_cast<std::size_t>(channels_);
  to.texels.resize(row * static_cast<std::size_t>(to.height));
  const auto columns = texel_covers(from.width, to.width),
             rows = texel_covers(from.height, to.height);
  parallel_for(to.height, 16, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const Cover& down = rows[static_cast<std::size_t>(y)];
      for (int x = 0; x < to.width; ++x) {
        const Cover& along = columns[static_cast<std::size_t>(x)];
        for (int c = 0; c < channels_; ++c) {
          float sum = 0.0f;
          for (int j = 0; j < down.count; ++j) {
            for (int i = 0; i < along.count; ++i) {
              const auto at = (std::size_t(down.first + j) * std::size_t(from.width) +
                               std::size_t(along.first + i)) *
                                  std::size_t(channels_) +
                              std::size_t(c);
              sum += down.share[std::size_t(j)] * along.share[std::size_t(i)] *
                     decode(from.texels[at]);
            }
          }
          to.texels[std::size_t(y) * row + std::size_t(x * channels_ + c)] = encode(sum);
        }
      }
    }
  });
  return to;
}

// The mean is that of the finest level, free of the rounding of coarser levels.
void Texture::measure() {
  const Level& all = levels_.front();
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  hash_ = random_key(static_cast<std::uint64_t>(all.width), static_cast<std::uint64_t>(all.height),
                     static_cast<std::uint64_t>(channels_));
  for (int y = 0; y < all.height; ++y) {
    Eigen::Array3d row = Eigen::Array3d::Zero();
    for (int x = 0; x < all.width; ++x) {
      const Eigen::Array3f value = texel(0, x, y);
      row += value.cast<double>();
      largest_ = largest_.max(value);
    }
    sum += row;
  }
  const auto count = static_cast<double>(all.width) * all.height;
  mean_ = (sum / count).cast<float>();
  constexpr std::uint64_t odd = 0x9e3779b97f4a7c15ull;
  for (const Code code : all.texels) hash_ = (hash_ ^ code) * odd + (hash_ >> 29);
}

Eigen::Array3f Texture::texel(int level, int x, int y) const {
  const Level& at = levels_[static_cast<std::size_t>(level)];
  const Code* code = &at.texels[(std::size_t(y) * std::size_t(at.width) + std::size_t(x)) *
                                std::size_t(channels_)];
  if (channels_ == 1) return Eigen::Array3f::Constant(decode(*code));
  return {decode(code[0]), decode(code[1]), decode(code[2])};
}

Texture Texture::mapped(const std::function<Eigen::Array3f(const Eigen::Array3f&)>& change) const {
  const int w = width(), h = height();
  std::vector<Code> texels(std::size_t{3} * std::size_t(w) * std::size_t(h));
  parallel_for(h, 16, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      for (int x = 0; x < w; ++x) {
        const Eigen::Array3f value = change(texel(0, x, y));
        for (int c = 0; c < 3; ++c) {
          texels[3 * (std::size_t(y) * std::size_t(w) + std::size_t(x)) + std::size_t(c)] =
              encode(value[c]);
        }
      }
    }
  });
  return {w, h, 3, std::move(texels)};
}

Eigen::Array3f SurfaceTexture::at(const Eigen::Vector2d& uv) const {
  return at_level(place(uv), 0);
}

Eigen::Array3f SurfaceTexture::over(const Eigen::Vector2d& uv,
                                    const Eigen::Matrix2d& footprint) const {
  const Eigen::Vector2d center = place(uv);
  const Eigen::Matrix2d sides = placement.leftCols<2>() * footprint;
  const Eigen::Array2d size(picture->width(), picture->height());
  double longer = (sides.col(0).array() * size).matrix().norm();
  double shorter = (sides.col(1).array() * size).matrix().norm();
  Eigen::Vector2d along = sides.col(0);
  if (!(longer >= shorter)) {
    std::swap(longer, shorter);
    along = sides.col(1);
  }
  if (!(longer > 1.0) || !std::isfinite(longer)) return at_level(center, 0);
  constexpr double most_places = 16.0;
  const double width = std::max({shorter, longer / most_places, 1.0});
  const int places = static_cast<int>(std::ceil(std::min(longer / width, most_places)));
  const double level = std::min(std::log2(width), picture->level_count() - 1.0);
  const int fine = static_cast<int>(level);
  const int coarse = std::min(fine + 1, picture->level_count() - 1);
  const auto share = static_cast<float>(level - fine);
  Eigen::Array3f sum = Eigen::Array3f::Zero();
  for (int i = 0; i < places; ++i) {
    const Eigen::Vector2d at = center + ((i + 0.5) / places - 0.5) * along;
    sum += (1.0f - share) * at_level(at, fine);
    if (share > 0.0f) sum += share * at_level(at, coarse);
  }
  return sum / static_cast<float>(places);
}

Eigen::Array3f SurfaceTexture::at_level(const Eigen::Vector2d& place, int level) const {
  const int w = picture->level_width(level), h = picture->level_height(level);
  const double x = within_period(place.x(), wrap[0]) * w;
  const double y = within_period(place.y(), wrap[1]) * h;
  const auto column = [&](int i) { return wrapped_texel(i, w, wrap[0]); };
  const auto row = [&](int j) { return wrapped_texel(j, h, wrap[1]); };
  if (!is_smooth && level == 0) {
    return picture->texel(level, column(static_cast<int>(std::floor(x))),
                          row(static_cast<int>(std::floor(y))));
  }
  const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
  const int i = static_cast<int>(left), j = static_cast<int>(top);
  const auto s = static_cast<float>(x - 0.5 - left), t = static_cast<float>(y - 0.5 - top);
  const std::array columns{column(i), column(i + 1)}, rows{row(j), row(j + 1)};
  const auto along = [&](int y_of_row) {
    return Eigen::Array3f((1.0f - s) * picture->texel(level, columns[0], y_of_row) +
                          s * picture->texel(level, columns[1], y_of_row));
  };
  return (1.0f - t) * along(rows[0]) + t * along(rows[1]);
}

}  // namespace lightwell
