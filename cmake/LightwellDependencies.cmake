# Every third-party package, in one place. Which room may use which is said by the room's own CMakeLists.txt.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB REQUIRED CONFIG)
find_package(fmt REQUIRED CONFIG)
find_package(embree 4 QUIET CONFIG)
if(NOT embree_FOUND)
  find_package(embree 3.13 REQUIRED CONFIG)
endif()
# CONFIG is essential: CGAL puts a FindOpenMesh of its own on the module path.
find_package(OpenMesh REQUIRED CONFIG)
find_package(CGAL REQUIRED CONFIG)
find_package(tomlplusplus REQUIRED CONFIG)
find_package(assimp REQUIRED CONFIG)
find_package(pugixml REQUIRED CONFIG)
find_package(JPEG REQUIRED)
find_package(muparser REQUIRED CONFIG)
find_package(OpenEXR REQUIRED CONFIG)
find_package(PNG REQUIRED)
find_package(CLI11 REQUIRED CONFIG)
find_package(nlohmann_json REQUIRED CONFIG)

set(vtk_components CommonCore CommonDataModel IOXML)
if(LIGHTWELL_VIEWER)
  list(APPEND vtk_components CommonTransforms CommonExecutionModel FiltersCore FiltersGeneral IOImage
       InteractionStyle RenderingAnnotation RenderingCore RenderingFreeType RenderingOpenGL2 RenderingUI)
endif()
find_package(VTK 9.1 REQUIRED COMPONENTS ${vtk_components})

# Some of these targets carry no "::": a missing one would turn into a bare -lname at link time.
foreach(target embree OpenMeshCore Eigen3::Eigen TBB::tbb CGAL::CGAL VTK::IOXML fmt::fmt)
  if(NOT TARGET ${target})
    message(FATAL_ERROR "The package that should define the CMake target '${target}' was found, but does not define it.")
  endif()
endforeach()
