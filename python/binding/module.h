#pragma once

#include <nanobind/nanobind.h>

// The parts of the extension module `_lightwell`. Each adds its classes and functions.
namespace lightwell::python {

void add_errors();
void add_camera(nanobind::module_& module);
void add_scene(nanobind::module_& module);
void add_form_factors(nanobind::module_& module);
void add_solve(nanobind::module_& module);
void add_solution(nanobind::module_& module);
void add_pictures(nanobind::module_& module);
void add_lightmaps(nanobind::module_& module);
void add_shortwave(nanobind::module_& module);
void add_report(nanobind::module_& module);
void add_daylight(nanobind::module_& module);
void add_radiation(nanobind::module_& module);

}  // namespace lightwell::python
