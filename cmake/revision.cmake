# cmake -D VERSION=… -D SOURCE=… -D OUTPUT=….cpp -P revision.cmake: writes the file only where it changes.
execute_process(COMMAND git describe --always --dirty --abbrev=10 WORKING_DIRECTORY ${SOURCE}
                OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
if(failed)
    set(revision unknown)
endif()
set(text "#include \"base/embedded.hpp\"
namespace doppel {
std::string_view version() { return \"${VERSION}\"; }
std::string_view revision() { return \"${revision}\"; }
}
")
set(old "")
if(EXISTS ${OUTPUT})
    file(READ ${OUTPUT} old)
endif()
if(NOT old STREQUAL text)
    file(WRITE ${OUTPUT} "${text}")
endif()
