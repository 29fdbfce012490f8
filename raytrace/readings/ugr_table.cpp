#include "raytrace/readings/ugr_table.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "radiosity/closed_forms/polygon_exchange.h"
#include "raytrace/readings/glare.h"
#include "scene/errors.h"
#include "scene/lamp_faces.h"

namespace lightwell {
namespace {

using std::numbers::pi;
constexpr double degrees = 180.0 / pi;
constexpr double H = 2.0;  // m, height of the luminaires above the eye
constexpr double apart = 0.25 * H;

/// Flux that leaves a luminaire within a small solid angle downwards.
struct FluxRay {
  std::array<double, 2> reach{};  ///< m, distances along C0 and C90 on the way to the floor
  double lumens = 0.0;
};

struct Flux {
  std::vector<FluxRay> down{};
  double up = 0.0;  ///< lm
};

Flux flux_of(const PhotometricWeb& web) {
  constexpr int rows = 360, sectors = 144;
  Flux flux;
  for (int g = 0; g < rows; ++g) {
    const double low = std::cos(pi * g / rows), high = std::cos(pi * (g + 1) / rows);
    const double gamma = pi * (g + 0.5) / rows, solid_angle = (low - high) * 2.0 * pi / sectors;
    for (int s = 0; s < sectors; ++s) {
      const double C = 2.0 * pi * (s + 0.5) / sectors, sine = std::sin(gamma);
      const Eigen::Vector3d way(sine * std::cos(C), sine * std::sin(C), -std::cos(gamma));
      const double lumens = solid_angle * web.at(way);
      if (way.z() > 0.0) {
        flux.up += lumens;
      } else if (lumens > 0.0) {
        const double steps = H / -way.z();
        flux.down.push_back(
            {.reach = {steps * std::abs(way.x()), steps * std::abs(way.y())}, .lumens = lumens});
      }
    }
  }
  return flux;
}

/// Number of luminaires, of `count` in a row between two walls, that send a ray this far without
/// meeting a wall.
double within(int count, double reach) {
  return std::clamp(std::ceil(count - 0.5 - reach / apart), 0.0, static_cast<double>(count));
}

/// A room with its luminaires. `sight` is the axis of the luminaire's frame, 0 or 1, along which
/// the eye looks.
class Room {
 public:
  Room(const UgrRoom& room, int sight) : sight_(sight) {
    size_[sight] = room.along * H;
    size_[1 - sight] = room.across * H;
    for (int a = 0; a < 2; ++a) count_[a] = static_cast<int>(std::lround(size_[a] / apart));
  }

  /// sum L^2 w / p^2 over the luminaires in sight, cd^2/m^4 sr.
  double glare(const LuminaireFile& luminaire) const {
    double sum = 0.0;
    for (int i = 0; i < count_[sight_]; ++i) {
      const double ahead = (i + 0.5) * apart;
      for (int j = 0; j < count_[1 - sight_]; ++j) {
        const double beside = (j + 0.5) * apart - 0.5 * size_[1 - sight_];
        if (!counts_for_glare(ahead, beside, H)) continue;
        Eigen::Vector3d to_eye;
        to_eye[sight_] = -ahead;
        to_eye[1 - sight_] = -beside;
        to_eye[2] = -H;
        const double d = to_eye.norm();
        to_eye /= d;
        const double I = luminaire.web->at(to_eye);
        if (!(I > 0.0)) continue;
        const double area = luminous_area(luminaire.opening, luminaire.opening_height, to_eye);
        const double p = position_index(std::acos(ahead / d) * degrees,
                                        std::atan2(std::abs(beside), H) * degrees);
        sum += I * I / (area * d * d * p * p);
      }
    }
    return sum;
  }

  /// E - E_direct of the walls, lx, for each set of reflectances, by the radiosity solution of
  /// three surfaces.
  std::array<double, ugr_reflectances.size()> indirect(const Flux& flux) const {
    const double luminaires = count_[0] * count_[1];
    double to_floor = 0.0, down = 0.0;
    for (const FluxRay& ray : flux.down) {
      to_floor += ray.lumens * within(count_[0], ray.reach[0]) * within(count_[1], ray.reach[1]);
      down += ray.lumens * luminaires;
    }
    const double x = size_[0], y = size_[1], base = x * y, walls = 2.0 * (x + y) * H;
    const double exchange =
        polygon_exchange(polygon_outline({{{0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0}}}),
                         polygon_outline({{{0, 0, H}, {0, y, H}, {x, y, H}, {x, 0, H}}}));
    const double across = exchange / base, to_walls = 1.0 - across;
    const double from_walls = base * to_walls / walls;
    Eigen::Matrix3d F;  // floor, walls, ceiling
    F << 0.0, to_walls, across, from_walls, 1.0 - 2.0 * from_walls, from_walls, across, to_walls,
        0.0;
    const Eigen::Vector3d direct(to_floor / base, (down - to_floor) / walls,
                                 luminaires * flux.up / base);
    std::array<double, ugr_reflectances.size()> E{};
    for (std::size_t r = 0; r < E.size(); ++r) {
      const auto& [ceiling, wall, floor] = ugr_reflectances[r];
      const Eigen::Vector3d rho(floor, wall, ceiling);
      const Eigen::Matrix3d system = Eigen::Matrix3d::Identity() - F * rho.asDiagonal();
      E[r] = system.partialPivLu().solve(direct)[1] - direct[1];
    }
    return E;
  }

 private:
  int sight_;
  std::array<double, 2> size_{};  // m, along C0 and C90
  std::array<int, 2> count_{};
};

}  // namespace

UgrTable ugr_table(const LuminaireFile& luminaire) {
  if (luminaire.is_radiometric) {
    throw InputError(
        fmt::format("{}: the intensities are in W/sr; UGR needs candela", luminaire.file.string()));
  }
  const LampOpening& opening = luminaire.opening;
  if (!(opening.along_c0 > 0.0 && opening.along_c90 > 0.0)) {
    throw InputError(fmt::format(
        "{}: the file gives no luminous area, without which luminance and UGR are undefined",
        luminaire.file.string()));
  }
  UgrTable table;
  const Flux flux = flux_of(*luminaire.web);
  for (std::size_t i = 0; i < ugr_rooms.size(); ++i) {
    for (const int sight : {0, 1}) {
      const Room room(ugr_rooms[i], sight);
      const double glare = room.glare(luminaire);
      const auto E = room.indirect(flux);
      for (std::size_t r = 0; r < E.size(); ++r) {
        const double background = E[r] / pi;
        const double ugr =
            glare > 0.0 ? std::max(0.0, 8.0 * std::log10(0.25 / background * glare)) : 0.0;
        auto& ratings = sight == 0 ? table.along_c0 : table.along_c90;
        ratings(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(r)) = ugr;
      }
    }
  }
  return table;
}

}  // namespace lightwell
