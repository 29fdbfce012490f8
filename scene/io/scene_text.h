#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "scene/io/lighting_design.h"
#include "scene/io/read_scene.h"
#include "scene/io/window_states.h"
#include "scene/scene.h"

namespace lightwell {

/// Tables of the native format (docs/scene-format.md) that a program holds in memory. Messages
/// about them name the table and the key, without a place in a file.
struct SceneText {
  std::string text{};              ///< TOML
  std::filesystem::path folder{};  ///< files that the text names are relative to this folder
  References references = References::anywhere;
};

/// Adds surfaces to a scene whose bands, materials and motions are complete.
using AddSurfaces = std::function<void(Scene&)>;

/// Reads a scene as read_scene() reads a file of this text. Scene::file stays empty.
/// `add_surfaces`, unless empty, stands in place of [[surfaces]]. Throws InputError naming table,
/// key, value and remedy; LimitError for a reference that `references` forbids.
Scene read_scene_text(const SceneText& text, const AddSurfaces& add_surfaces = {});

/// Reads the lighting design of the text that `scene` was read from, as read_toml_lighting() does.
LightingDesign read_lighting_text(const SceneText& text, const Scene& scene);

/// Reads the [[windows]] of the text that `scene` was read from, as read_windows() does of a file;
/// none where the text has none.
OperatedWindows read_windows_text(const SceneText& text, const Scene& scene);

/// Reads the keys of one [[cameras]] table, lengths in metres, for a picture of `scene`: its
/// `motion` is one of the scene's, and its shutter lies about the instant that light is solved for.
/// Throws InputError naming camera, key, value and remedy.
Camera read_camera_text(const std::string& text, const Scene& scene);

}  // namespace lightwell
