# CDT, headers alone: the target lightwell_cdt and cdt_version. An installation serves if it has version 2 (CDT_INCLUDE_DIR);
# otherwise the headers come in the source archive of the Python package pythoncdt.
find_path(CDT_INCLUDE_DIR CDT.h PATH_SUFFIXES CDT)
mark_as_advanced(CDT_INCLUDE_DIR)
set(cdt_folder "")
# The installation names no version. Version 1 has no such message.
if(CDT_INCLUDE_DIR AND EXISTS ${CDT_INCLUDE_DIR}/Triangulation.h)
  file(STRINGS ${CDT_INCLUDE_DIR}/Triangulation.h cdt_line REGEX "class CDT_EXPORT InvalidEdgeSplitVertex")
  if(cdt_line)
    set(cdt_folder ${CDT_INCLUDE_DIR})
    set(cdt_version 2)
  endif()
endif()
if(NOT cdt_folder)
  set(cdt_version 2.0.2)
  include(FetchContent)
  # SOURCE_SUBDIR names a folder that is not there, so that nothing but the headers is used.
  FetchContent_Declare(cdt
    URL https://files.pythonhosted.org/packages/0b/08/21a9533f8349de75025251592a0e54759044f7124dbb27f5d47fc9c83f9a/pythoncdt-${cdt_version}.tar.gz
    URL_HASH SHA256=303832cae14a5ce90bb4bc696274c8add0f1f0b9bd4edb943e24fd10417036c4
    DOWNLOAD_EXTRACT_TIMESTAMP OFF SOURCE_SUBDIR no-cmake)
  FetchContent_MakeAvailable(cdt)
  set(cdt_folder ${cdt_SOURCE_DIR}/CDT/CDT/include)
endif()
# Not lightwell_library(): headers alone, of which nothing is installed.
add_library(lightwell_cdt INTERFACE)
target_include_directories(lightwell_cdt SYSTEM INTERFACE $<BUILD_INTERFACE:${cdt_folder}>)
install(TARGETS lightwell_cdt EXPORT lightwellTargets)
