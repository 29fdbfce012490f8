# Warnings are a private matter of our own targets; consumers never inherit them.
add_library(lightwell_warnings INTERFACE)
target_compile_options(lightwell_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                       -Woverloaded-virtual -Wno-missing-field-initializers
                       # GCC 13 and later take any reference returned by a call with a temporary for a dangling one.
                       -Wno-dangling-reference
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

# Unity builds: the sources of a folder are compiled LIGHTWELL_UNITY_BATCH at a time, as one file, which reads the
# headers and makes the templates of all of them once. Sources with SKIP_UNITY_BUILD_INCLUSION stay on their own.
function(lightwell_unity target)
  if(NOT LIGHTWELL_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  set(folders)
  foreach(source IN LISTS sources)
    get_source_file_property(alone ${source} SKIP_UNITY_BUILD_INCLUSION)
    if(NOT source MATCHES "\\.cpp$" OR alone)
      continue()
    endif()
    cmake_path(GET source PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER "${target}/${folder}" key)
    list(APPEND folders "${key}")
    list(APPEND in_${key} ${source})
  endforeach()
  list(REMOVE_DUPLICATES folders)
  foreach(key IN LISTS folders)
    # Batches of equal size: 9 files make 5 + 4, not 8 + 1.
    list(LENGTH in_${key} count)
    math(EXPR batches "(${count} + ${LIGHTWELL_UNITY_BATCH} - 1) / ${LIGHTWELL_UNITY_BATCH}")
    set(index 0)
    foreach(source IN LISTS in_${key})
      math(EXPR batch "${index} * ${batches} / ${count}")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP "${key}_${batch}")
      math(EXPR index "${index} + 1")
    endforeach()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # GCC takes every source of a batch for a header, whose classes should have no members of a source's own types.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()

# lightwell_library(NAME HEADERS ... SOURCES ... PUBLIC ... PRIVATE ...)
# One static library per room, lightwell::NAME, with headers beside the sources, included as "room/header.h".
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
  install(TARGETS ${target} EXPORT lightwellTargets
          FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lightwell
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lightwell)
endfunction()
