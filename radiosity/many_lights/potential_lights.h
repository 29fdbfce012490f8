#pragma once

#include <vector>

#include "radiosity/many_lights/light_choice.h"

namespace lightwell {

/// A light and about what it would give a point without occluders, W/m^2, mean of the bands.
struct PotentialLight {
  int light = 0;
  double about = 0.0;
};

/// The lights in order of what they may give, until all others together may give no more than
/// `least`, W/m^2. The others count as if they were as visible as these (Ward 1991, "Adaptive
/// shadow testing for ray tracing").
std::vector<LightSample> sorted_samples(std::vector<PotentialLight> lights, double least);

/// The lights that may give more than `least`, W/m^2, and two drawn among the others for u in
/// [0,1), as the members of `cluster` (Shirley, Wang & Zimmerman 1996, "Monte Carlo techniques for
/// direct lighting calculations").
std::vector<LightSample> important_samples(const std::vector<PotentialLight>& lights, double least,
                                           double u, int cluster);

}  // namespace lightwell
