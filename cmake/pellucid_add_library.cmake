# pellucid_add_library(<name> SOURCES … [HEADERS …] [LINKS …] [PRIVATE_LINKS …])
# One layer of the architecture: target pellucid_<name>, alias pellucid::<name>, headers found as "<folder>/<file>.h".
# LINKS is the layer's place in the diagram: what it may include.
function(pellucid_add_library name)
    cmake_parse_arguments(arg "" "" "SOURCES;HEADERS;LINKS;PRIVATE_LINKS" ${ARGN})
    add_library(pellucid_${name} STATIC ${arg_SOURCES} ${arg_HEADERS})
    add_library(pellucid::${name} ALIAS pellucid_${name})
    target_include_directories(pellucid_${name} PUBLIC ${CMAKE_SOURCE_DIR}/src)
    target_link_libraries(pellucid_${name} PUBLIC ${arg_LINKS}
                          PRIVATE ${arg_PRIVATE_LINKS} $<BUILD_INTERFACE:pellucid_warnings>)
    set_target_properties(pellucid_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()
