# Debian packages, by `cpack` in a build folder: lightwell (the program, its manual pages, completions, scenes and
# handler of solutions) and liblightwell-dev (headers and libraries). A package belongs to the Debian release that built it, since
# it depends on that release's libraries.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME lightwell)
set(CPACK_PACKAGE_VENDOR lightwell)
set(CPACK_PACKAGE_CONTACT "The Lightwell project")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME lightwell)
set(CPACK_DEBIAN_PROGRAM_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# Mesa draws the window where no graphics card does; reports in PDF are set in DejaVu Sans.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "libgl1-mesa-dri, fonts-dejavu-core")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
"Light in rooms, computed once and shown from everywhere.
Solves the radiosity equation of a scene (its own .toml, glTF, OBJ, Mitsuba,
RADIANCE and others), renders mirrors, glass and shadows on top, and reports
lux, glare, daylight of a year and view factors, each with its error.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME liblightwell-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
string(JOIN ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  libeigen3-dev libtbb-dev libfmt-dev libembree-dev libcgal-dev libopenmesh-dev libvtk9-dev libtomlplusplus-dev
  libassimp-dev libdraco-dev libmeshoptimizer-dev libpugixml-dev libmuparser-dev libjpeg-dev libopenexr-dev libpng-dev
  pkgconf libcairo2-dev libpango1.0-dev librsvg2-dev zlib1g-dev nlohmann-json3-dev)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
"Headers and static libraries of Lightwell.
find_package(lightwell) in CMake gives lightwell::scene, ::mesh, ::radiosity,
::raytrace and what stands on them.")
include(CPack)
