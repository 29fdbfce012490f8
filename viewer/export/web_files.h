#pragma once

#include <string_view>

/// The files of viewer/export/web, which CMake turns into C++ (cmake/EmbedFile.cmake).
namespace lightwell::web {

extern const std::string_view page_html, page_css, library_js, licenses_txt;
extern const std::string_view spheres_js, model_js, picture_js, sky_js, probe_js, walk_js,
    lights_js, page_js;

}  // namespace lightwell::web
