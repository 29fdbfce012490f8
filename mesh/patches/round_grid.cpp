#include "mesh/patches/round_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace lightwell {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

// First of n cells in block c of m even blocks.
int block(int c, int m, int n) {
  return static_cast<int>((static_cast<std::int64_t>(c) * n + m - 1) / m);
}

/// A shape as a globe: `down` runs from the north, ring 0, to the south, from 0 to `span`, evenly
/// along each meridian.
struct SphereGlobe {
  const Sphere& shape;

  static constexpr double span = pi;  // `down` is the polar angle

  static constexpr int least_rows = 2, least_sectors = 4;  // fewer do not resemble a sphere
  static constexpr bool has_north = true, has_south = true;
  double meridian() const { return pi * shape.radius; }
  double widest() const { return shape.radius; }
  /// Radius of the widest parallel between two.
  double radius_between(double north, double south) const {
    if (2.0 * north < span && 2.0 * south > span) return shape.radius;
    return shape.radius * std::max(std::sin(north), std::sin(south));
  }
  Vector3d at(double down, double phi) const {
    return shape.center + shape.radius * Vector3d(std::sin(down) * std::cos(phi),
                                                  std::sin(down) * std::sin(phi), std::cos(down));
  }
  /// Area between two parallels and two meridians `dphi` apart (Archimedes).
  double area(double north, double south, double dphi) const {
    return shape.radius * shape.radius * dphi * (std::cos(north) - std::cos(south));
  }
  std::pair<double, double> down_and_phi(const Vector3d& point) const {
    const Vector3d direction = point - shape.center;
    const double across = std::hypot(direction.x(), direction.y());
    return {std::atan2(across, direction.z()), std::atan2(direction.y(), direction.x())};
  }
  /// The point that leaves the share v of the area between two parallels to its south.
  Vector3d even_at(double north, double south, double phi, double v) const {
    const double low = std::cos(south), high = std::cos(north);
    const double z = std::clamp(low + v * (high - low), -1.0, 1.0), across = std::sqrt(1.0 - z * z);
    return shape.center +
           shape.radius * Vector3d(across * std::cos(phi), across * std::sin(phi), z);
  }
};

struct FrustumGlobe {
  const Frustum& shape;

  static constexpr double span = 1.0;
  LongitudeFrame frame = longitudes(shape);

  static constexpr int least_rows = 1, least_sectors = 24;  // pages draw the elements
  bool has_north = shape.top_radius == 0.0, has_south = shape.base_radius == 0.0;
  double meridian() const { return slant_height(shape); }
  double widest() const { return std::max(shape.base_radius, shape.top_radius); }
  double radius(double down) const { return radius_at(shape, 1.0 - down); }
  double radius_between(double north, double south) const {
    return std::max(radius(north), radius(south));
  }
  Vector3d at(double down, double phi) const {
    return shape.base + (1.0 - down) * shape.height * shape.axis +
           radius(down) * (std::cos(phi) * frame.zero + std::sin(phi) * frame.quarter);
  }
  double area(double north, double south, double dphi) const {
    return 0.5 * dphi * (radius(north) + radius(south)) * (south - north) * meridian();
  }
  std::pair<double, double> down_and_phi(const Vector3d& point) const {
    const Vector3d from_base = point - shape.base;
    return {1.0 - place_along(shape, point),
            std::atan2(from_base.dot(frame.quarter), from_base.dot(frame.zero))};
  }
  /// Area grows as the square of the radius, and evenly where the radius is constant.
  Vector3d even_at(double north, double south, double phi, double v) const {
    const double low = radius(south), high = radius(north);
    const double square = low * low + v * (high * high - low * low);
    const double sum = std::sqrt(std::max(0.0, square)) + low;
    const double share = sum > 0.0 ? v * (high + low) / sum : 0.0;
    return at(south + share * (north - south), phi);
  }
};

/// Calls visit() with the globe of a shape.
template <class Visit>
auto with_globe(const RoundShape& shape, const Visit& visit) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return visit(SphereGlobe{*sphere});
  return visit(FrustumGlobe{std::get<Frustum>(shape)});
}

/// Makes the elements of a globe.
template <class Globe>
class Cutter {
 public:
  Cutter(const Globe& globe, const CutSize& size) : globe_(globe), size_(size) {}

  RoundElements cut() {
    const int rows = std::max(Globe::least_rows, size_.patches(globe_.meridian()));
    out_.rings = std::max(rows, size_.pieces(globe_.meridian()));
    out_.sectors = std::max(Globe::least_sectors, size_.pieces(2.0 * pi * globe_.widest()));
    add_vertices();
    out_.element.resize(static_cast<std::size_t>(out_.rings) * out_.sectors);
    for (int row = 0; row < rows; ++row) {
      add_row(block(row, rows, out_.rings), block(row + 1, rows, out_.rings));
    }
    return std::move(out_);
  }

 private:
  double down(int parallel) const { return Globe::span * parallel / out_.rings; }
  bool is_pole(int parallel) const {
    return (parallel == 0 && globe_.has_north) || (parallel == out_.rings && globe_.has_south);
  }

  void add_vertices() {
    // Poles come first.
    for (const int parallel : {0, out_.rings}) {
      if (is_pole(parallel)) out_.position.push_back(globe_.at(down(parallel), 0.0));
    }
    for (int parallel = 0; parallel <= out_.rings; ++parallel) {
      if (is_pole(parallel)) continue;
      for (int sector = 0; sector < out_.sectors; ++sector) {
        out_.position.push_back(globe_.at(down(parallel), 2.0 * pi * sector / out_.sectors));
      }
    }
  }

  int vertex(int parallel, int sector) const {
    const int north = globe_.has_north ? 1 : 0, south = globe_.has_south ? 1 : 0;
    if (is_pole(parallel)) return parallel == 0 ? 0 : north;
    return north + south + (parallel - north) * out_.sectors + sector % out_.sectors;
  }

  // Adds the patches between two parallels.
  void add_row(int north, int south) {
    const double widest = globe_.radius_between(down(north), down(south));
    // A patch takes the whole sectors that fit into its width, but no fewer than the elements along
    // its edge.
    const double sector_width = 2.0 * pi / out_.sectors * widest;
    const double whole = std::min<double>(out_.sectors, size_.patch_size / sector_width);
    const int fit = std::max(size_.elements_per_edge, static_cast<int>(whole * (1.0 + 1e-9)));
    const int columns = std::max(4, (out_.sectors + fit - 1) / fit);
    for (int column = 0; column < columns; ++column) {
      const int west = block(column, columns, out_.sectors);
      const int east = block(column + 1, columns, out_.sectors);
      for (int ring = north; ring < south; ++ring) {
        for (int sector = west; sector < east; ++sector) add_element(ring, sector);
      }
      out_.first_element.push_back(static_cast<int>(out_.corners.size()));
    }
  }

  void add_element(int ring, int sector) {
    out_.element[static_cast<std::size_t>(ring) * out_.sectors + sector] =
        static_cast<int>(out_.corners.size());
    const int sw = vertex(ring + 1, sector), se = vertex(ring + 1, sector + 1);
    const int ne = vertex(ring, sector + 1), nw = vertex(ring, sector);
    if (is_pole(ring)) {
      out_.corners.push_back({sw, se, ne, -1});
    } else if (is_pole(ring + 1)) {
      out_.corners.push_back({sw, ne, nw, -1});
    } else {
      out_.corners.push_back({sw, se, ne, nw});
    }
    out_.area.push_back(globe_.area(down(ring), down(ring + 1), 2.0 * pi / out_.sectors));
  }

  const Globe& globe_;
  const CutSize& size_;
  RoundElements out_;
};

}  // namespace

RoundElements round_elements(const RoundShape& shape, const CutSize& size) {
  return with_globe(shape, [&](const auto& globe) { return Cutter(globe, size).cut(); });
}

RoundGridPoint round_grid_point(const RoundGrid& grid, const Vector3d& point) {
  auto [down, phi] = with_globe(grid.shape, [&](const auto& globe) {
    const auto [of_span, longitude] = globe.down_and_phi(point);
    return std::pair(of_span / globe.span, longitude);
  });
  if (phi < 0.0) phi += 2.0 * pi;
  // Rounding may carry x or y to the end of its range, which is the last cell's far edge.
  const double x = phi / (2.0 * pi) * grid.sectors, y = down * grid.rings;
  RoundGridPoint place;
  place.sector = std::clamp(static_cast<int>(x), 0, grid.sectors - 1);
  place.ring = std::clamp(static_cast<int>(y), 0, grid.rings - 1);
  place.u = std::clamp(x - place.sector, 0.0, 1.0);
  place.v = std::clamp(1.0 - (y - place.ring), 0.0, 1.0);
  return place;
}

Vector3d point_at(const RoundGrid& grid, const RoundGridPoint& place) {
  const double phi = 2.0 * pi * (place.sector + place.u) / grid.sectors;
  return with_globe(grid.shape, [&](const auto& globe) -> Vector3d {
    return globe.at(globe.span * (place.ring + 1.0 - place.v) / grid.rings, phi);
  });
}

Vector3d even_point(const RoundGrid& grid, int ring, int sector, double u, double v) {
  const double phi = 2.0 * pi * (sector + u) / grid.sectors;
  return with_globe(grid.shape, [&](const auto& globe) -> Vector3d {
    return globe.even_at(globe.span * ring / grid.rings, globe.span * (ring + 1.0) / grid.rings,
                         phi, v);
  });
}

bool ends_north(const RoundGrid& grid, int ring) {
  return ring == 0 && with_globe(grid.shape, [](const auto& globe) { return globe.has_north; });
}

bool ends_south(const RoundGrid& grid, int ring) {
  return ring == grid.rings - 1 &&
         with_globe(grid.shape, [](const auto& globe) { return globe.has_south; });
}

Eigen::Array4f round_weights(const RoundGrid& grid, const RoundGridPoint& place) {
  const auto u = static_cast<float>(place.u), v = static_cast<float>(place.v);
  const float sw = (1 - u) * (1 - v), se = u * (1 - v), ne = u * v, nw = (1 - u) * v;
  if (ends_north(grid, place.ring)) return {sw, se, v, 0.0f};
  if (ends_south(grid, place.ring)) return {1 - v, ne, nw, 0.0f};
  return {sw, se, ne, nw};
}

const RoundGrid* round_grid_of(const PatchMesh& mesh, int facet) {
  const auto& grids = mesh.round_grids;  // in ascending order of facets
  const auto grid = std::lower_bound(grids.begin(), grids.end(), facet,
                                     [](const RoundGrid& g, int f) { return g.facet < f; });
  return grid != grids.end() && grid->facet == facet ? &*grid : nullptr;
}

Vector3d round_normal(const PatchMesh& mesh, const RoundGrid& grid, int patch,
                      const Vector3d& point) {
  const Vector3d normal = front_normal(grid.shape, point);
  return mesh.is_back[patch] != 0 ? Vector3d(-normal) : normal;
}

}  // namespace lightwell
