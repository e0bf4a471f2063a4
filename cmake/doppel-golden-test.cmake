# cmake -D DOPPEL=program -D SETTINGS=file [-D UPDATE=ON] -P doppel-golden-test.cmake
# What the test of doppel_add_golden_test() does: draws the pictures, and compares them with the goldens or replaces those.
cmake_minimum_required(VERSION 3.21)
include("${SETTINGS}")

# On one line: the space keeps CMake from breaking it.
function(fail words)
    message(FATAL_ERROR " ${words}")
endfunction()

set(arguments compare --render "${PRESET}" "${GOLDEN}" --out "${FOLDER}")
if(NOT FIGURE)
    list(APPEND arguments --frames "${FRAMES}")
endif()
if(SIZE)
    list(APPEND arguments --size "${SIZE}")
endif()
foreach(value IN LISTS SET)
    list(APPEND arguments --set "${value}")
endforeach()

if(UPDATE)
    execute_process(COMMAND "${DOPPEL}" ${arguments} --update RESULT_VARIABLE code)
    if(NOT code EQUAL 0)
        fail("${NAME}: the goldens could not be made (${code})")
    endif()
    message("${NAME}: the goldens in ${GOLDEN} are as drawn now. Look at them before you commit them.")
    return()
endif()

set(update "make the goldens with the target doppel-update-goldens-${NAME}, look at them, and commit them")
if(NOT EXISTS "${GOLDEN}")
    fail("${NAME}: ${GOLDEN} is missing; ${update}")
endif()
execute_process(COMMAND "${DOPPEL}" ${arguments} --junit "${FOLDER}/compare.xml" --html "${FOLDER}/compare.html"
                RESULT_VARIABLE code)
if(code EQUAL 1)
    fail("${NAME}: not as expected: see ${FOLDER}/compare.html. If the new pictures are right, ${update}")
elseif(NOT code EQUAL 0)
    fail("${NAME}: the pictures could not be drawn or compared (${code})")
endif()
