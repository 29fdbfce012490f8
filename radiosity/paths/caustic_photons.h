#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/emitters/direct_light.h"
#include "radiosity/emitters/lit_scene.h"
#include "scene/progress.h"
#include "scene/scene.h"

namespace lightwell {

/// Places where light of DirectLight's emitters first meets something diffuse after mirrors and
/// clear surfaces alone (paths L S+ D), and the power that arrives there.
struct CausticPhotons {
  std::vector<Eigen::Vector3d> position{};  ///< m
  std::vector<int> element{};               ///< that it lies on
  BandArray power{};                        ///< W, photons x bands
  int sent = 0;                             ///< of which these arrived

  std::size_t count() const { return element.size(); }
};

constexpr int most_photons = 1 << 24;

/// Sends about `count` photons, 1 to most_photons, towards what mirrors or is clear (Jensen 1996):
/// pairs of an emitter and a specular surface share them by the power that the one would send to a
/// sphere around the other. A photon starts at a place of the emitter, evenly spread over its area,
/// into the cone which that sphere fills seen from there, by a scrambled Sobol sequence of the
/// pair's own, and counts if that surface is the first it meets; so each path belongs to one
/// pair, and the sum of powers has no bias. Surfaces are followed as LightPaths does, by smooth
/// normals where there are any: a photon keeps its power, so that what a facet catches goes where
/// the surface that it stands for sends it, all of it. Light that only goes straight through smooth
/// thin panes is none of it: DirectLight has that.
///
/// The same photons for any number of threads. Throws std::invalid_argument if the count is out of
/// range, Interrupted when progress says stop.
CausticPhotons shoot_photons(const LitScene& lit, int count, int max_specular_depth,
                             const Progress& progress = {});

}  // namespace lightwell
