# embed(MODULE PATTERN…)
# Builds the files that match into the module, so that the program needs none of them at run time. The module finds them in
# std::span<const doppel::EmbeddedFile> doppel::MODULE_files(), declared in "embedded/MODULE.hpp", under their paths without the
# first folder: "figures/links.toml" of presets/figures/links.toml.
function(embed module)
    set(files)
    foreach(pattern IN LISTS ARGN)
        file(GLOB found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${pattern})
        list(APPEND files ${found})
    endforeach()
    set(folder ${PROJECT_BINARY_DIR}/generated)
    set(output ${folder}/embedded/${module}.cpp)
    add_custom_command(
        OUTPUT ${output} ${folder}/embedded/${module}.hpp
        COMMAND ${CMAKE_COMMAND} -D MODULE=${module} -D OUTPUT=${output} -D SOURCE=${PROJECT_SOURCE_DIR} -D "FILES=${files}"
                -P ${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake
        DEPENDS ${files} ${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake
        COMMENT "Embedding the files of ${module}"
        VERBATIM)
    # by a target of its own: what a target generates would wait for all that it links, and its files for that
    add_library(embedded_${module} OBJECT ${output} ${folder}/embedded/${module}.hpp)
    target_include_directories(embedded_${module} PRIVATE ${PROJECT_SOURCE_DIR}/src ${folder})
    target_link_libraries(embedded_${module} PRIVATE fmt::fmt)
    target_sources(${module} PRIVATE $<TARGET_OBJECTS:embedded_${module}>)
    target_include_directories(${module} PRIVATE ${folder})
endfunction()
