#include "python/binding/scene_data.h"

#include <utility>

namespace lightwell::python {

SharedScene scene_data(Scene given, References references, std::optional<NumberedScene> faces,
                       std::optional<SceneText> text) {
  auto data = std::make_shared<SceneData>();
  data->clean = merge_planar_regions(given, &data->clean_up);
  data->given = std::move(given);
  data->references = references;
  data->faces = std::move(faces);
  data->text = std::move(text);
  return data;
}

}  // namespace lightwell::python
