#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/direct_light/lit_scene.h"
#include "scene/progress.h"
#include "scene/scene.h"

namespace lightwell {

/// Points where light of DirectLight's lights first meets a diffuse surface after mirrors and clear
/// surfaces alone (paths L S+ D), with the power that arrives.
struct CausticPhotons {
  std::vector<Eigen::Vector3d> position{};  ///< m
  std::vector<int> element{};               ///< of the mesh, that holds the point
  BandArray power{};                        ///< W, photons x bands
  int sent = 0;                             ///< photons sent, those that did not arrive included

  std::size_t count() const { return element.size(); }
};

constexpr int most_photons = 1 << 24;

/// Sends about `count` photons, 1 to most_photons, towards specular surfaces (Jensen 1996).
///
/// - Pairs of an emitter and a specular target share the photons by the power that the emitter
///   would send to a sphere around the target.
/// - A photon starts at a sample point of the emitter, uniform in area, in a direction of the cone
///   that the sphere fills, by a scrambled Sobol sequence of the pair's own. The photon counts if
///   the target is the first surface it meets, so each path belongs to one pair and the sum of
///   powers has no bias.
/// - LightPaths follows the photon, by smooth normals where there are any. A photon keeps its
///   power, so all light that a facet catches goes where the curved surface sends it.
/// - Light that only passes straight through smooth thin panes is left out: it is direct light.
///
/// The same photons for any number of threads. Throws std::invalid_argument if the count is out of
/// range, Interrupted when progress says stop.
CausticPhotons shoot_photons(const LitScene& lit, int count, int max_specular_depth,
                             const Progress& progress = {});

}  // namespace lightwell
