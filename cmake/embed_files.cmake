# cmake -D MODULE=… -D OUTPUT=….cpp -D SOURCE=… -D FILES=a;b -P embed_files.cmake: writes the source and header that hold the files.
set(arrays "")
set(table "")
set(number 0)
foreach(file IN LISTS FILES)
    file(READ ${file} bytes HEX)
    string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
    file(RELATIVE_PATH name ${SOURCE} ${file})
    string(FIND ${name} "/" slash)  # a regular expression from ^ on would match again and again
    math(EXPR slash "${slash} + 1")
    string(SUBSTRING ${name} ${slash} -1 name)
    string(APPEND arrays "constexpr unsigned char file_${number}[] = {\n${bytes}};\n")
    string(APPEND table "    {\"${name}\", {reinterpret_cast<const char*>(file_${number}), sizeof file_${number}}},\n")
    math(EXPR number "${number} + 1")
endforeach()
if(number EQUAL 0)
    message(FATAL_ERROR "there is nothing to embed into ${MODULE}")
endif()
string(REPLACE ".cpp" ".hpp" header "${OUTPUT}")
file(WRITE ${header} "#pragma once
#include \"base/embedded.hpp\"
#include <span>
namespace doppel {
std::span<const EmbeddedFile> ${MODULE}_files();
}
")
file(WRITE ${OUTPUT} "#include \"embedded/${MODULE}.hpp\"
namespace doppel {
namespace {
${arrays}const EmbeddedFile files[] = {
${table}};
}
std::span<const EmbeddedFile> ${MODULE}_files() { return files; }
}
")
