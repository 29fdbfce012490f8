#pragma once

#include <Eigen/Core>
#include <vector>

#include "radiosity/direct_light/lit_scene.h"
#include "raytrace/readings/lux_grid.h"

namespace lightwell {

/// Illuminance at the points of a grid, lx, with bounds as those of ProbeBounds.
struct LuxReadings {
  Eigen::ArrayXd lux{}, lux_within{}, read_within{};
};

/// Planes around a cylinder, or around half of one, over which its illuminance is a mean.
inline constexpr int planes_of_a_cylinder = 25;
/// Planes all around that half a cylinder has besides, which tell how much light is behind it.
inline constexpr int planes_all_around = 5;

/// Probes whose mean is the illuminance of the side of an upright cylinder, or of the half of it
/// that faces `grid.facing`:
///
///     E_z = (1/pi) int L sin(beta) dw                    mean over the whole side
///     E_sz = (1/pi) int L sin(beta) (1 + cos(alpha)) dw  mean over half of it
///
/// where beta is the angle from `grid.upright`, and alpha that around it from `grid.facing`. For
/// half a cylinder, `planes_all_around` probes follow, whose mean is E_z.
///
/// An odd number n of planes: for light from one direction, the mean of n planes around a cylinder
/// differs from E_z by at most (pi/n)^2 / 12 of it, and that around half a cylinder from E_sz by at
/// most (pi/n)^2 / 8 of E_z. An even n would leave four times as much around the whole.
std::vector<Probe> cylinder_probes(const LuxGrid& grid, const Eigen::Vector3d& position);

/// Readings at the points of a grid, of its quantity. The mean of a cylinder is that of its
/// cylinder_probes(), each with an eighth of the rays of `options`; its bounds contain the error of
/// the finite number of planes for a single small lamp, which all points share.
LuxReadings read_grid(const LitScene& lit, const RadiositySolution& solution, const LuxGrid& grid,
                      const GatherOptions& options);

}  // namespace lightwell
