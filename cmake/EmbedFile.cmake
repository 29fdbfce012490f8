# cmake -DINPUT=FILE -DOUTPUT=FILE.cpp -DNAME=NAME -P EmbedFile.cmake
# The bytes of a file as C++: const std::string_view lightwell::web::NAME.
file(READ ${INPUT} bytes HEX)
# Lines of 32 bytes; a \x escape ends at the next backslash or quote.
string(REGEX REPLACE "(................................................................)" "\\1\"\n\"" bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" bytes "${bytes}")
file(SIZE ${INPUT} size)
get_filename_component(file ${INPUT} NAME)
file(WRITE ${OUTPUT} "// Made from ${file}.
#include \"viewer/export/web_files.h\"

namespace lightwell::web {
const std::string_view ${NAME}(
\"${bytes}\", ${size});
}  // namespace lightwell::web
")
