# Makes the Debian packages and looks into them. Options:
#   CPACK    the program cpack
#   CONFIG   CPackConfig.cmake of the build
#   SCRATCH  a folder that this script empties
file(REMOVE_RECURSE ${SCRATCH})
execute_process(COMMAND ${CPACK} --config ${CONFIG} -B ${SCRATCH} COMMAND_ERROR_IS_FATAL ANY)
set(unpacked ${SCRATCH}/unpacked)
file(GLOB program ${SCRATCH}/lightwell_*.deb)
file(GLOB development ${SCRATCH}/liblightwell-dev_*.deb)
foreach(package ${program} ${development})
  execute_process(COMMAND dpkg-deb -x ${package} ${unpacked} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
foreach(file bin/lightwell share/man/man1/lightwell.1 share/man/man1/lightwell-run.1 share/applications/lightwell.desktop
        share/bash-completion/completions/lightwell share/zsh/site-functions/_lightwell
        share/fish/vendor_completions.d/lightwell.fish share/lightwell/cornell/cornell.toml share/lightwell/office/office.toml
        include/lightwell/scene/scene.h share/doc/lightwell/copyright)
  if(NOT EXISTS ${unpacked}/usr/${file})
    message(SEND_ERROR "The packages lack /usr/${file}.")
  endif()
endforeach()
# Nothing of the build or of the tests is in the package of the program.
execute_process(COMMAND dpkg-deb -c ${program} OUTPUT_VARIABLE listing COMMAND_ERROR_IS_FATAL ANY)
if(listing MATCHES "_test|\\.a\n|reference/")
  message(SEND_ERROR "The package of the program holds what belongs elsewhere:\n${listing}")
endif()
execute_process(COMMAND dpkg-deb -f ${program} Depends OUTPUT_VARIABLE depends COMMAND_ERROR_IS_FATAL ANY)
if(NOT depends MATCHES "libembree" OR NOT depends MATCHES "libvtk")
  message(SEND_ERROR "The package of the program names no libraries that it needs: ${depends}")
endif()
execute_process(COMMAND ${unpacked}/usr/bin/lightwell info ${unpacked}/usr/share/lightwell/office/office.toml
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
