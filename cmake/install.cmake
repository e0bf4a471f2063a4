# The CMake package of an installed Doppel: find_package(doppel) gives doppel::doppel and doppel_add_golden_test(). It finds the
# program from its own place, so the whole may be moved.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# before anything is copied
install(CODE "if(NOT EXISTS \"${PROJECT_BINARY_DIR}/doppel\")
    message(FATAL_ERROR \" doppel: the program is not built, and nothing was installed; first: cmake --build ${PROJECT_BINARY_DIR}\")
endif()")

set(doppel_package ${CMAKE_INSTALL_DATADIR}/cmake/doppel)
set(doppel_path ${CMAKE_INSTALL_BINDIR}/doppel)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/doppel-config.cmake.in ${PROJECT_BINARY_DIR}/generated/doppel-config.cmake
                              INSTALL_DESTINATION ${doppel_package} PATH_VARS doppel_path)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/generated/doppel-config-version.cmake COMPATIBILITY SameMajorVersion
                                 ARCH_INDEPENDENT)
install(FILES ${PROJECT_BINARY_DIR}/generated/doppel-config.cmake ${PROJECT_BINARY_DIR}/generated/doppel-config-version.cmake
              ${PROJECT_SOURCE_DIR}/cmake/doppel-golden-test.cmake
        DESTINATION ${doppel_package})
