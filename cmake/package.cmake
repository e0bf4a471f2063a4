# What `cmake --install` puts beside the program, and the Debian package: cmake --build --preset release --target package.
include(GNUInstallDirs)
set(pages ${PROJECT_BINARY_DIR}/pages)  # of what the program says of itself

install(TARGETS doppel)
install(DIRECTORY presets DESTINATION ${CMAKE_INSTALL_DATADIR}/doppel FILES_MATCHING PATTERN *.toml PATTERN *.json PATTERN *.csv)
install(FILES python/doppel.py DESTINATION lib/python3/dist-packages)  # Debian's folder for modules of every Python 3
install(PROGRAMS .ci/golden DESTINATION ${CMAKE_INSTALL_DATADIR}/doppel/ci)
install(FILES packaging/doppel.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps)
install(FILES packaging/copyright README.md action.yml DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} PATTERN update-gallery EXCLUDE)
set(track presets/data/double-pendulum-track)
foreach(linked CHANGELOG.md debian-packages.txt fonts/LICENSE-DejaVu ${track}/LICENSE ${track}/README.md)  # by the pages
    cmake_path(GET linked PARENT_PATH folder)
    install(FILES ${linked} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder})
endforeach()

add_custom_command(
    OUTPUT ${pages}/made
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${pages}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${pages}/man
    COMMAND ${PROJECT_SOURCE_DIR}/packaging/manual-pages $<TARGET_FILE:doppel> ${pages}/man
    COMMAND gzip -9nr ${pages}/man
    COMMAND doppel completion bash > ${pages}/doppel
    COMMAND doppel completion zsh > ${pages}/_doppel
    COMMAND doppel completion fish > ${pages}/doppel.fish
    COMMAND gzip -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md > ${pages}/changelog.gz
    COMMAND ${CMAKE_COMMAND} -E touch ${pages}/made
    DEPENDS doppel CHANGELOG.md packaging/manual-pages VERBATIM)
add_custom_target(pages ALL DEPENDS ${pages}/made)
# OPTIONAL: there are none where the target doppel alone was built
install(CODE "if(NOT EXISTS \"${pages}/made\")
    message(STATUS \"doppel: the manual pages and completions are not built, and left out; for them: cmake --build ${PROJECT_BINARY_DIR} --target pages\")
endif()")
install(DIRECTORY ${pages}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL FILES_MATCHING PATTERN *.1.gz)
install(FILES ${pages}/doppel DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions OPTIONAL)
install(FILES ${pages}/_doppel DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions OPTIONAL)
install(FILES ${pages}/doppel.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d OPTIONAL)
install(FILES ${pages}/changelog.gz DESTINATION ${CMAKE_INSTALL_DOCDIR} OPTIONAL)

# The release of Debian that this is: "deb12", "deb13", "sid".
set(release "")
if(EXISTS /etc/os-release)
    file(STRINGS /etc/os-release lines)
    foreach(line IN LISTS lines)
        if(line MATCHES "^([A-Z_]+)=\"?([^\"]*)\"?$")
            set(os_${CMAKE_MATCH_1} "${CMAKE_MATCH_2}")
        endif()
    endforeach()
    if(os_ID STREQUAL "debian" AND os_VERSION_ID MATCHES "^(12|13)$")
        set(release deb${os_VERSION_ID})
    elseif(os_ID STREQUAL "debian" AND os_PRETTY_NAME MATCHES "sid$")
        set(release sid)
    endif()
endif()
if(NOT release)
    add_custom_target(package COMMAND ${CMAKE_COMMAND} -E echo
                      "doppel: packages are made on Debian 12, 13 and sid; this is ${os_PRETTY_NAME}" COMMAND false VERBATIM)
    return()
endif()

# changelog.Debian.gz and the date in it: that of the commit, so that the same source gives the same package
set(maintainer "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
if(NOT maintainer MATCHES "^[^<]+ <[^<]+@[^<]+>$")
    set(maintainer "The Doppel authors <doppel@users.noreply.github.com>")
endif()
execute_process(COMMAND git log -1 --format=%cD WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE date
                OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
if(failed)
    execute_process(COMMAND date -R OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE)
endif()
string(REGEX REPLACE ", ([0-9]) " ", 0\\1 " date "${date}")
set(debian_version ${PROJECT_VERSION}-1+${release})
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/changelog.Debian CONTENT
"doppel (${debian_version}) unstable; urgency=medium

  * Release ${PROJECT_VERSION}; changelog.gz tells what is new.

 -- ${maintainer}  ${date}
")
execute_process(COMMAND gzip -9nkf ${PROJECT_BINARY_DIR}/changelog.Debian)
install(FILES ${PROJECT_BINARY_DIR}/changelog.Debian.gz DESTINATION ${CMAKE_INSTALL_DOCDIR})

# libraries that the program opens itself, which dpkg-shlibdeps cannot see: what draws, and what makes the palettes of GIFs
find_library(OSMESA_LIBRARY NAMES libOSMesa.so.8 OSMesa)
set(egl "libegl1, libegl-mesa0, libgl1-mesa-dri")
if(OSMESA_LIBRARY)
    set(CPACK_DEBIAN_PACKAGE_DEPENDS libosmesa6)
    set(CPACK_DEBIAN_PACKAGE_SUGGESTS "${egl}")
else()
    set(CPACK_DEBIAN_PACKAGE_DEPENDS "${egl}")
endif()
string(REGEX MATCH "^[0-9]+" avfilter "${AVFILTER_VERSION}")
string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", libavfilter${avfilter} | libavfilter-extra${avfilter}")
string(JOIN ", " CPACK_DEBIAN_PACKAGE_SUGGESTS ${CPACK_DEBIAN_PACKAGE_SUGGESTS} python3)
install(FILES packaging/lintian-overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides RENAME doppel)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME doppel)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                                WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1+${release})
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${maintainer}")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Doppel simulates pairs of pendulums that differ slightly, films them side
by side with the trace of how they diverge, and writes videos, pictures and
tables. It needs no display and no graphics card. It is made for teaching,
videos, research and tests.")
include(CPack)
