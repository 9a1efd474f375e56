# The window's place on a desktop: its entry, what software centres say of it, and its icon in all sizes.
set(sizes 16 24 32 48 64 128 256 512)
set(drawing ${PROJECT_SOURCE_DIR}/packaging/desktop/pellucid.svg)
set(icons ${PROJECT_BINARY_DIR}/icons)
file(MAKE_DIRECTORY ${icons})
set(pictures)
foreach(size IN LISTS sizes)
    list(APPEND pictures ${icons}/pellucid-${size}.png)
endforeach()
add_executable(icon_pictures icon_pictures.cpp)
target_link_libraries(icon_pictures PRIVATE Qt6::Gui Qt6::Svg pellucid_warnings)
add_custom_command(OUTPUT ${pictures} DEPENDS ${drawing} icon_pictures VERBATIM
    COMMAND icon_pictures ${drawing} ${icons}/pellucid ${sizes})
add_custom_target(pellucid_icons DEPENDS ${pictures})
add_dependencies(pellucid pellucid_icons)
foreach(size IN LISTS sizes)
    install(FILES ${icons}/pellucid-${size}.png COMPONENT gui RENAME pellucid.png
        DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/${size}x${size}/apps)
endforeach()
install(FILES ${drawing} DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT gui)
install(FILES ${PROJECT_SOURCE_DIR}/packaging/desktop/pellucid.desktop
    DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT gui)
include(metainfo)
install(FILES ${PROJECT_BINARY_DIR}/pellucid.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo COMPONENT gui)
