# compile_for_widths(MODULE FILE WIDTH…)
# FILE, which the module compiles for every processor, once more for each kind with wider registers, of 4 or 8 doubles
# (DOPPEL_COMPILED_WIDTH); which of them runs is chosen at run time (integrate/widths.hpp). The module sees
# DOPPEL_WIDE_REGISTERS where there are wider kinds.
# Never with FMA: fused operations round differently. (Eigen would demand it for AVX-512, so it keeps to plain code here.)
# Always optimized: what is inlined has no name that the linker could take for the same in code for every processor; a test
# sees to it that no such name is left.
include(CheckCXXCompilerFlag)
function(compile_for_widths module file)
    if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|amd64")
        return()
    endif()
    set(flags_4 -mavx2)
    set(flags_8 -mavx512f -mavx512dq)
    # A copy by halves of a register makes the next to read it wait: 1.7 times as fast in AVX2 with whole ones (GCC).
    check_cxx_compiler_flag("-mmove-max=256 -mstore-max=256" DOPPEL_MOVES_REGISTERS)
    if(DOPPEL_MOVES_REGISTERS)
        list(APPEND flags_4 -mmove-max=256 -mstore-max=256)
        list(APPEND flags_8 -mmove-max=512 -mstore-max=512)
    endif()
    get_filename_component(name ${file} NAME_WE)
    foreach(width ${ARGN})
        set(objects ${module}_${name}_${width})
        add_library(${objects} OBJECT ${PROJECT_SOURCE_DIR}/src/${module}/${file})
        target_compile_options(${objects} PRIVATE ${flags_${width}} -mno-fma -O3 -fno-sanitize=all)
        target_compile_definitions(${objects} PRIVATE DOPPEL_COMPILED_WIDTH=${width} EIGEN_DONT_VECTORIZE NDEBUG)
        target_include_directories(${objects} PRIVATE $<TARGET_PROPERTY:${module},INCLUDE_DIRECTORIES>)
        target_include_directories(${objects} SYSTEM PRIVATE ${EIGEN3_INCLUDE_DIRS}
                                                             $<TARGET_PROPERTY:${module},INTERFACE_SYSTEM_INCLUDE_DIRECTORIES>)
        target_sources(${module} PRIVATE $<TARGET_OBJECTS:${objects}>)
        add_test(NAME ${module}:${name}_${width}.SharesNoFunction
                 COMMAND ${CMAKE_COMMAND} -D NM=${CMAKE_NM} -D OBJECT=$<TARGET_OBJECTS:${objects}>
                         -P ${CMAKE_CURRENT_FUNCTION_LIST_FILE})
    endforeach()
    target_compile_definitions(${module} PRIVATE DOPPEL_WIDE_REGISTERS)
endfunction()

# The test: the one global function of OBJECT is the one that is called, a template over the width, and none is weak (V = a
# weak datum, harmless).
if(CMAKE_SCRIPT_MODE_FILE)
    execute_process(COMMAND ${NM} --demangle --defined-only ${OBJECT} OUTPUT_VARIABLE names COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX MATCHALL "[0-9a-f]+ [TWuwi] [^\n]*" shared "${names}")
    set(called ${shared})
    list(FILTER called INCLUDE REGEX " T .*doppel::[a-z_]+<[48]>\\(")
    list(LENGTH called calls)
    list(LENGTH shared all)
    if(NOT (calls EQUAL 1 AND all EQUAL 1))
        list(JOIN shared "\n  " shared)
        message(FATAL_ERROR "${OBJECT} defines what other code may be given:\n  ${shared}")
    endif()
endif()
