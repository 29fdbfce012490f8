#pragma once

#include "scene/scene.h"

namespace lightwell {

/// Makes all names of a scene plain text in UTF-8 (see plain_text), as terminals, tables, file
/// names and XML need them. Names of cameras stay unique.
void clean_names(Scene& scene);

}  // namespace lightwell
