#pragma once

#include <string_view>

/// Contents of the files in viewer/export/web, embedded by CMake (cmake/EmbedFile.cmake).
namespace lightwell::web {

extern const std::string_view page_html, page_css, library_js, licenses_txt;
extern const std::string_view texts_js, spheres_js, model_js, white_js, picture_js, sky_js,
    probe_js, walk_js, lights_js, cues_js, isolux_js, legend_js, plan_js, measure_js, gestures_js,
    stick_js, panels_js, sunlight_js, year_js, page_js;

}  // namespace lightwell::web
