#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "scene/errors.h"
#include "viewer/export/lightmap.h"
#include "viewer/export/lightmap_charts.h"
#include "viewer/export/pack_rectangles.h"

namespace lightwell {
namespace {

/// Texels along each side of a chart: two suffice for a bilinear slope.
constexpr int least_texels = 2;
/// Texels between two borders of a chart, so that no bilinear filter reads across.
constexpr double least_gap = 2.0;

void check(const LightmapOptions& options) {
  if (options.size < least_lightmap_size || options.size > most_lightmap_size) {
    throw InputError(fmt::format("a lightmap of {0} x {0} texels cannot be made; take {1} to {2}",
                                 options.size, least_lightmap_size, most_lightmap_size));
  }
  if (!(options.texels_per_metre >= 0.0) || !std::isfinite(options.texels_per_metre)) {
    throw InputError(fmt::format("{} texels per metre is no density; give a number above 0",
                                 options.texels_per_metre));
  }
  if (options.padding < 1 || options.padding > 64) {
    throw InputError(
        fmt::format("{} texels of padding are not possible; take 1 to 64", options.padding));
  }
}

double face_area(const BakedModel& model) {
  double area = 0.0;
  for (const auto& t : triangles_of(model, 0, model.face_count())) {
    const Eigen::Vector3d& p = model.position[t[0]];
    area += 0.5 * (model.position[t[1]] - p).cross(model.position[t[2]] - p).norm();
  }
  return area;
}

/// Packs charts into atlases at a given density, texels/m.
class Packing {
 public:
  Packing(const std::vector<LightmapChart>& charts, int padding)
      : charts_(charts), padding_(padding) {}

  /// Texels along an edge of a chart of `length` metres, without padding, rounded up. An excess of
  /// up to 1e-6 over a whole number is rounding and ignored.
  static double texels(double length, double density) {
    return std::max<double>(least_texels, std::ceil(length * density - 1e-6));
  }
  std::optional<std::vector<ChartRectangle>> pack(double density, int size, int most) const {
    std::vector<Eigen::Vector2i> sizes;
    std::vector<int> number;  // each chart's rectangle; -1: its host's
    std::optional<int> dark;  // rectangle shared by all dark charts, which look alike
    for (const LightmapChart& chart : charts_) {
      if (chart.host >= 0 || (chart.is_dark && dark)) {
        number.push_back(chart.host >= 0 ? -1 : *dark);
        continue;
      }
      number.push_back(static_cast<int>(sizes.size()));
      if (chart.is_dark) dark = number.back();
      Eigen::Vector2d wanted = Eigen::Vector2d::Constant(least_texels);
      for (int i = 0; i < 2 && !chart.is_dark; ++i) wanted[i] = texels(chart.size[i], density);
      if (wanted.maxCoeff() + 2.0 * padding_ > size) return std::nullopt;
      sizes.push_back(wanted.cast<int>() + Eigen::Vector2i::Constant(2 * padding_));
    }
    const auto packed = pack_rectangles(sizes, size, most);
    if (!packed) return std::nullopt;
    std::vector<ChartRectangle> places;
    for (const int n : number) {
      if (n < 0) {
        places.emplace_back();
        continue;
      }
      const PackedPosition& at = (*packed)[n];
      places.push_back({.atlas = at.square,
                        .x = at.x + padding_,
                        .y = at.y + padding_,
                        .width = sizes[n].x() - 2 * padding_,
                        .height = sizes[n].y() - 2 * padding_});
    }
    for (std::size_t c = 0; c < charts_.size(); ++c) {
      if (charts_[c].host >= 0) places[c] = places[static_cast<std::size_t>(charts_[c].host)];
    }
    return places;
  }
  double box_area() const {
    double area = 0.0;
    for (const LightmapChart& c : charts_) area += c.is_dark ? 0.0 : c.size.x() * c.size.y();
    return area;
  }

 private:
  const std::vector<LightmapChart>& charts_;
  int padding_;
};

[[noreturn]] void refuse_size(const LightmapLayout& layout, const Packing& packing) {
  const std::string asked = fmt::format("{} charts do not fit into one lightmap of {} x {} texels",
                                        layout.charts.size(), layout.size, layout.size);
  for (int size = 2 * layout.size; size <= most_lightmap_size; size *= 2) {
    if (!packing.pack(0.0, size, 1)) continue;
    throw InputError(
        fmt::format("{}; take size {} or more, or say how many texels per metre are "
                    "wanted and get several lightmaps",
                    asked, size));
  }
  throw InputError(fmt::format(
      "{}, nor into the largest; say how many texels per metre are wanted and get several", asked));
}

void pack_densely(LightmapLayout& layout, const Packing& packing) {
  constexpr int halvings = 10;
  // Upper bound: a packing without padding or gaps fills the atlas.
  const double area = packing.box_area();
  double high = area > 0.0 ? layout.size / std::sqrt(area) : 0.0, low = 0.0;
  auto best = packing.pack(low, layout.size, 1);
  if (!best) refuse_size(layout, packing);
  for (int i = 0; i < halvings && high > 0.0; ++i) {
    const double middle = 0.5 * (low + high);
    auto packed = packing.pack(middle, layout.size, 1);
    (packed ? low : high) = middle;
    if (!packed) continue;
    best = std::move(packed);
  }
  layout.texels_per_metre = low;
  layout.place = std::move(*best);
  layout.atlas_count = 1;
}

[[noreturn]] void refuse_density(const BakedModel& model, const LightmapLayout& layout,
                                 double density) {
  const int room = layout.size - 2 * layout.padding;
  const auto length = [](const LightmapChart& c) { return c.is_dark ? 0.0 : c.size.maxCoeff(); };
  const LightmapChart& longest = *std::ranges::max_element(layout.charts, {}, length);
  const double texels = Packing::texels(length(longest), density);
  if (texels > room) {
    const auto part = std::ranges::find_if(model.parts, [&](const BakedPart& p) {
      return longest.faces.front() < p.first_face + p.face_count;
    });
    throw InputError(fmt::format(
        "'{}' is {:.4g} m long, which is {:.0f} texels at {:g} per metre, and a lightmap of {} "
        "texels holds {}; take a larger size or at most {:.4g} texels per metre",
        part->name, length(longest), texels, density, layout.size, room, room / length(longest)));
  }
  throw InputError(fmt::format(
      "at {:g} texels per metre there would be more than {} lightmaps of {} x {} texels; take a "
      "larger size or fewer texels per metre",
      density, most_atlases, layout.size, layout.size));
}

}  // namespace

Eigen::Vector2d LightmapLayout::texel(int chart, const Eigen::Vector2d& at) const {
  const ChartRectangle& to = place[chart];
  const Eigen::Vector2d& from = charts[chart].size;
  const double u = from.x() > 0.0 ? at.x() / from.x() : 0.5;
  const double v = from.y() > 0.0 ? at.y() / from.y() : 0.5;
  return {to.x + u * to.width, to.y + (1.0 - v) * to.height};
}

LightmapLayout lay_out_lightmap(const BakedModel& model, const PatchMesh& mesh,
                                const LightmapOptions& options) {
  check(options);
  LightmapLayout layout{.size = options.size, .padding = options.padding};
  const double density = options.texels_per_metre > 0.0
                             ? options.texels_per_metre
                             : options.size / std::sqrt(face_area(model));
  layout.charts = cut_charts(model, mesh, least_gap / density);
  const Packing packing(layout.charts, options.padding);
  if (!(options.texels_per_metre > 0.0)) {
    pack_densely(layout, packing);
    return layout;
  }
  auto packed = packing.pack(density, options.size, most_atlases);
  if (!packed) refuse_density(model, layout, density);
  layout.texels_per_metre = density;
  layout.place = std::move(*packed);
  for (const ChartRectangle& at : layout.place) {
    layout.atlas_count = std::max(layout.atlas_count, at.atlas + 1);
  }
  return layout;
}

}  // namespace lightwell
