# What software centres say of the window: pellucid.metainfo.xml in the build folder. A test runs this file alone, by
# cmake -P.
set(PELLUCID_SCREENSHOT_URL "" CACHE STRING "Public address of the folder docs/images, for software centres; empty: none")
string(REGEX REPLACE "/+$" "" address "${PELLUCID_SCREENSHOT_URL}")
string(REPLACE "&" "&amp;" address "${address}")
set(PELLUCID_SCREENSHOTS)
# NAME WIDTH HEIGHT CAPTION; the first is the one that lists show.
foreach(screenshot IN ITEMS
        "window_optimized|1280|800|Opacities that give each feature the attention that was asked for"
        "slices|1280|800|A volume and the slices through it"
        "keyframes|1280|800|Keyframes of a film through the volume")
    string(REPLACE "|" ";" parts "${screenshot}")
    list(POP_FRONT parts name width height caption)
    set(type)
    if(NOT PELLUCID_SCREENSHOTS)
        set(type " type=\"default\"")
    endif()
    string(APPEND PELLUCID_SCREENSHOTS "\n    <screenshot${type}>\n      <caption>${caption}</caption>\n"
        "      <image type=\"source\" width=\"${width}\" height=\"${height}\">${address}/${name}.png</image>\n"
        "    </screenshot>")
endforeach()
if(address)
    set(PELLUCID_SCREENSHOTS "\n  <screenshots>${PELLUCID_SCREENSHOTS}\n  </screenshots>")
else() # software centres fetch pictures, and without an address there are none
    set(PELLUCID_SCREENSHOTS)
endif()
configure_file(${PROJECT_SOURCE_DIR}/packaging/desktop/pellucid.metainfo.xml.in
    ${PROJECT_BINARY_DIR}/pellucid.metainfo.xml @ONLY)
