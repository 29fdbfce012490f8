# Warnings are a private matter of our own targets; consumers never inherit them.
add_library(lightwell_warnings INTERFACE)
target_compile_options(lightwell_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                       -Woverloaded-virtual -Wno-missing-field-initializers
                       # GCC 13 and later take any reference returned by a call with a temporary for a dangling one.
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-dangling-reference>
                       $<$<BOOL:${LIGHTWELL_WERROR}>:-Werror>)

function(lightwell_compile_settings target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:lightwell_warnings>)
  # GCC 14 takes a value for unread by the function it is passed to (Shafts, at -O3) and hands over what lay on the
  # stack. Seen with 14.2, not with 12; 13 and 15 are said to be right too.
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION MATCHES "^14\\.")
    target_compile_options(${target} PRIVATE -fno-ipa-modref)
  endif()
  if(LIGHTWELL_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${LIGHTWELL_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${LIGHTWELL_SANITIZE})
  endif()
endfunction()

# Kilobytes that GCC's heap may have before GCC looks for memory to free, which takes a tenth of the time of a batch with
# GCC's own choice. A batch never fills 2 GB, but takes 0.2 GB more with them (1.7 GB at most): 4 GB for every core leave room.
cmake_host_system_information(RESULT lightwell_cores QUERY NUMBER_OF_LOGICAL_CORES)
cmake_host_system_information(RESULT lightwell_memory QUERY TOTAL_PHYSICAL_MEMORY)
math(EXPR lightwell_memory_of_core "${lightwell_memory} / ${lightwell_cores}")
set(lightwell_compiler_heap 300000)
if(lightwell_memory_of_core GREATER_EQUAL 4000)
  set(lightwell_compiler_heap 2000000)
endif()

# lightwell_unity(TARGET [BATCH]): BATCH sources of a target (LIGHTWELL_UNITY_BATCH unless told), in the order in which
# they are listed (by folder), are compiled as one file, which reads their headers and makes their templates once.
# Sources with SKIP_UNITY_BUILD_INCLUSION stay on their own.
function(lightwell_unity target)
  if(NOT LIGHTWELL_UNITY)
    return()
  endif()
  get_target_property(all ${target} SOURCES)
  set(sources)
  foreach(source IN LISTS all)
    get_source_file_property(alone ${source} SKIP_UNITY_BUILD_INCLUSION)
    if(source MATCHES "\\.cpp$" AND NOT alone)
      list(APPEND sources ${source})
    endif()
  endforeach()
  # Batches of equal size: 13 files make 7 + 6, not 12 + 1.
  set(batch_size ${LIGHTWELL_UNITY_BATCH})
  if(ARGC GREATER 1)
    set(batch_size ${ARGV1})
  endif()
  list(LENGTH sources count)
  math(EXPR batches "(${count} + ${batch_size} - 1) / ${batch_size}")
  set(index 0)
  foreach(source IN LISTS sources)
    math(EXPR batch "${index} * ${batches} / ${count}")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${target}_${batch})
    math(EXPR index "${index} + 1")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # GCC takes every source of a batch for a header, whose classes should have no members of a source's own types.
  target_compile_options(${target} PRIVATE
    $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage;--param=ggc-min-heapsize=${lightwell_compiler_heap}>)
endfunction()

# Headers of the standard library and of other libraries, which are read once instead of for every source. A target of
# its own has them precompiled: with GCC, targets may share what was read under no more macros than they define, and
# under the same options: one target for libraries, one for programs.
set(lightwell_precompiled_headers
    <algorithm> <array> <charconv> <chrono> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits> <map> <memory>
    <mutex> <numbers> <numeric> <optional> <set> <span> <stdexcept> <string> <string_view> <tuple> <utility> <variant>
    <vector> <fmt/format.h> <Eigen/Geometry> <Eigen/LU> <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>)
function(lightwell_precompile target)
  if(LIGHTWELL_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE ${lightwell_precompiled_headers} ${ARGN})
  endif()
endfunction()
if(LIGHTWELL_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # Not file(WRITE), which touches the file each time CMake runs, so that everything would be compiled again.
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled.cpp CONTENT "// No more than the precompiled headers.\n")
  add_library(lightwell_precompiled OBJECT ${PROJECT_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(lightwell_precompiled PRIVATE Eigen3::Eigen fmt::fmt OpenMeshCore)
  lightwell_compile_settings(lightwell_precompiled)
  lightwell_precompile(lightwell_precompiled)

  add_library(lightwell_precompiled_programs OBJECT EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(lightwell_precompiled_programs PRIVATE Eigen3::Eigen fmt::fmt OpenMeshCore)
  lightwell_compile_settings(lightwell_precompiled_programs)
  # As CMake compiles programs; GCC shares nothing between -fPIC and -fPIE.
  set_target_properties(lightwell_precompiled_programs PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  target_compile_options(lightwell_precompiled_programs PRIVATE -fPIE)
  lightwell_precompile(lightwell_precompiled_programs)
endif()

# lightwell_program(TARGET): the settings of a program that links lightwell::radiosity or what is above it, and fmt.
function(lightwell_program target)
  lightwell_compile_settings(${target})
  lightwell_unity(${target})
  if(TARGET lightwell_precompiled_programs)
    target_precompile_headers(${target} REUSE_FROM lightwell_precompiled_programs)
  endif()
endfunction()

# lightwell_library(NAME HEADERS ... SOURCES ... PUBLIC ... PRIVATE ...)
# One static library per room, lightwell::NAME, with headers beside the sources, included as "room/header.h". HEADERS are
# those that are installed for users of the library; rooms above include any header. A library without HEADERS serves
# the program alone, and is not installed.
function(lightwell_library name)
  cmake_parse_arguments(arg "" "" "HEADERS;SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target lightwell_${name})
  add_library(${target} STATIC ${arg_SOURCES})
  add_library(lightwell::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${arg_HEADERS})
  target_link_libraries(${target} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  lightwell_compile_settings(${target})
  lightwell_unity(${target})
  # CGAL compiles mesh with -frounding-math, so it shares with no other.
  if(TARGET lightwell_precompiled AND NOT name STREQUAL mesh)
    target_precompile_headers(${target} REUSE_FROM lightwell_precompiled)
  elseif(NOT name STREQUAL scene)
    lightwell_precompile(${target})
  endif()
  if(arg_HEADERS)
    install(TARGETS ${target} EXPORT lightwellTargets
            ARCHIVE COMPONENT development LIBRARY COMPONENT development
            FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lightwell COMPONENT development
            INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lightwell)
  endif()
endfunction()
