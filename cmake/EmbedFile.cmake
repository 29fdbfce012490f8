# cmake -DINPUT=FILE -DOUTPUT=FILE.cpp -DNAME=NAME [-DHEADER=ROOM/FILE.h -DSPACE=NAMESPACE] -P EmbedFile.cmake
# The bytes of a file as C++: const std::string_view lightwell::SPACE::NAME, which HEADER declares.
if(NOT HEADER)
  set(HEADER viewer/export/web_files.h)
  set(SPACE web)
endif()
file(READ ${INPUT} bytes HEX)
# Lines of 32 bytes; a \x escape ends at the next backslash or quote.
string(REGEX REPLACE "(................................................................)" "\\1\"\n\"" bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" bytes "${bytes}")
file(SIZE ${INPUT} size)
get_filename_component(file ${INPUT} NAME)
file(WRITE ${OUTPUT} "// Made from ${file}.
#include \"${HEADER}\"

namespace lightwell::${SPACE} {
const std::string_view ${NAME}(
\"${bytes}\", ${size});
}  // namespace lightwell::${SPACE}
")
