#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/io/polygon.h"
#include "scene/scene.h"

namespace lightwell::test {

/// Polygons of one surface as a file has them, before a reader repairs them.
struct RawSurface {
  std::string name{};
  int material = 0;
  std::vector<lightwell::Loop> polygons{};
};

/// A model as a file has it. Materials are those of empty_scene() and add_lamp().
struct RawModel {
  std::vector<RawSurface> surfaces{};
};

/// Number of furnished() models.
inline constexpr int furnished_models = 6;

/// A small model with a lamp: a room with a table and a ball, a bent cloth with a fringe, terrain,
/// stairs, crossing blocks, or an L-shaped room with a window.
RawModel furnished(int number);

/// The polygons of a scene, its spheres and holes left out.
RawModel raw_model(const Scene& scene);

/// The model with one to four of the defects of real models, with random places and sizes: cut by
/// a plane, snapped to a lattice, mirrored, scaled, moved far away, rounded to single precision,
/// jittered with and without tearing, doubled, turned over, cut into slivers and needles, copied
/// into itself, with corners inside edges of neighbours, with holes at the end of a bridge, with
/// corners exchanged (bow ties), spikes, repeated corners, polygons without area, and crossed by a
/// heap of polygons. `defects` receives their names.
RawModel dirty_variant(const RawModel& model, std::uint32_t seed, std::string* defects = nullptr);

/// The scene that a reader makes of the model, with its notes.
Scene read_model(const RawModel& model);

}  // namespace lightwell::test
