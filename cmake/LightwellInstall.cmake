# find_package(lightwell): targets lightwell::scene, ::mesh, ::radiosity, ::raytrace, ::daylight, ::export and, if built, ::viewer.
include(CMakePackageConfigHelpers)
set(lightwell_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/lightwell)

install(EXPORT lightwellTargets NAMESPACE lightwell:: DESTINATION ${lightwell_config_dir})
string(REPLACE ";" " " vtk_component_list "${vtk_components}")
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/lightwellConfig.cmake.in
  ${PROJECT_BINARY_DIR}/lightwellConfig.cmake INSTALL_DESTINATION ${lightwell_config_dir})
# Before 1.0 any minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lightwellConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lightwellConfig.cmake
  ${PROJECT_BINARY_DIR}/lightwellConfigVersion.cmake DESTINATION ${lightwell_config_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
