# embed(ROOM PATTERN…)
# Builds the files that match into the room, so that the program needs none of them at run time. The room finds them in
# std::span<const doppel::EmbeddedFile> doppel::ROOM_files(), declared in "embedded/ROOM.hpp", under their paths without the
# first folder: "figures/links.toml" of presets/figures/links.toml.
function(embed room)
    set(files)
    foreach(pattern IN LISTS ARGN)
        file(GLOB found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${pattern})
        list(APPEND files ${found})
    endforeach()
    set(folder ${PROJECT_BINARY_DIR}/generated)
    set(output ${folder}/embedded/${room}.cpp)
    add_custom_command(
        OUTPUT ${output} ${folder}/embedded/${room}.hpp
        COMMAND ${CMAKE_COMMAND} -D ROOM=${room} -D OUTPUT=${output} -D SOURCE=${PROJECT_SOURCE_DIR} -D "FILES=${files}"
                -P ${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake
        DEPENDS ${files} ${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake
        COMMENT "Embedding the files of ${room}"
        VERBATIM)
    set_source_files_properties(${output} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    target_sources(${room} PRIVATE ${output} ${folder}/embedded/${room}.hpp)
    target_include_directories(${room} PRIVATE ${folder})
endfunction()
