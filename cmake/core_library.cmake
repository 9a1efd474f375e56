# One library of the layers that other programs can use (Pellucid::core), without those that need pictures' libraries or
# Qt, and its headers. Run as a script it merges the archives of the layers.
if(CMAKE_SCRIPT_MODE_FILE)
    set(steps "create ${OUTPUT}\n")
    foreach(part IN LISTS PARTS)
        string(APPEND steps "addlib ${part}\n")
    endforeach()
    file(REMOVE ${OUTPUT})
    file(WRITE ${OUTPUT}.steps "${steps}save\nend\n")
    execute_process(COMMAND ${AR} -M INPUT_FILE ${OUTPUT}.steps COMMAND_ERROR_IS_FATAL ANY)
    return()
endif()

set(layers base volume tf saliency render ranks engines optimize session)
set(archives ${layers} render_gl)
if(PELLUCID_STANDARD_THREADS STREQUAL "1")
    list(APPEND archives parallel_threads)
    set(PELLUCID_CORE_NEEDS_TBB OFF)
else()
    set(PELLUCID_CORE_NEEDS_TBB ON)
    list(APPEND archives parallel_tbb)
endif()
set(parts ${archives})
list(TRANSFORM parts REPLACE ".+" "$<TARGET_FILE:pellucid_\\0>")
list(TRANSFORM archives PREPEND pellucid_)
set(core ${PROJECT_BINARY_DIR}/lib/libpellucid.a)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
add_custom_command(OUTPUT ${core} DEPENDS ${archives} ${CMAKE_CURRENT_LIST_FILE} VERBATIM
    COMMAND ${CMAKE_COMMAND} -DAR=${CMAKE_AR} "-DPARTS=${parts}" -DOUTPUT=${core} -P ${CMAKE_CURRENT_LIST_FILE})
set(always)
if(CMAKE_BUILD_TYPE STREQUAL "Release") # others are large, and not what is installed
    set(always ALL)
endif()
add_custom_target(pellucid_core ${always} DEPENDS ${core})

install(FILES ${core} DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev OPTIONAL)
foreach(layer IN LISTS layers)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/${layer} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pellucid COMPONENT dev
        FILES_MATCHING PATTERN "*.h" PATTERN gl EXCLUDE PATTERN mpi EXCLUDE)
endforeach()

# Those that CMake has no module for, by the names of their files.
set(plain_libraries lz4 epoxy)
if(TARGET PkgConfig::DEFLATE)
    list(APPEND plain_libraries deflate)
endif()
string(REPLACE ";" " " plain_libraries "${plain_libraries}")
include(CMakePackageConfigHelpers)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/Pellucid)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/PellucidConfig.cmake.in ${PROJECT_BINARY_DIR}/PellucidConfig.cmake
    INSTALL_DESTINATION ${package} PATH_VARS CMAKE_INSTALL_LIBDIR CMAKE_INSTALL_INCLUDEDIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/PellucidConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/PellucidConfig.cmake ${PROJECT_BINARY_DIR}/PellucidConfigVersion.cmake
    DESTINATION ${package} COMPONENT dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libpellucid-dev COMPONENT dev)
