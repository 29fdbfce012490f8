# find_package(lightwell): targets lightwell::scene, ::mesh, ::radiosity, ::raytrace, ::standards, ::daylight, ::export and, if
# built, ::viewer.
include(CMakePackageConfigHelpers)
set(lightwell_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/lightwell)

install(EXPORT lightwellTargets NAMESPACE lightwell:: DESTINATION ${lightwell_config_dir} COMPONENT development)
string(REPLACE ";" " " vtk_component_list "${vtk_components}")
string(REPLACE ";" " " pdf_module_list "${pdf_modules}")
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/lightwellConfig.cmake.in
  ${PROJECT_BINARY_DIR}/lightwellConfig.cmake INSTALL_DESTINATION ${lightwell_config_dir})
# Before 1.0 any minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lightwellConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lightwellConfig.cmake
  ${PROJECT_BINARY_DIR}/lightwellConfigVersion.cmake DESTINATION ${lightwell_config_dir} COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/packaging/copyright
        DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/packaging/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/liblightwell-dev COMPONENT development)

# Scenes to begin with, and the handler of solutions.
set(lightwell_data ${CMAKE_INSTALL_DATADIR}/lightwell)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/cornell/ DESTINATION ${lightwell_data}/cornell COMPONENT program
        FILES_MATCHING PATTERN "*.toml" PATTERN "data/*.csv" PATTERN "output" EXCLUDE PATTERN "reference" EXCLUDE)
foreach(example office room)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples/${example} DESTINATION ${lightwell_data} COMPONENT program)
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/packaging/lightwell.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/packaging/lightwell.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT program)
