# What is installed besides programs and library, and what CPack makes of all: .deb, one per component, and .tar.gz.
# scripts/package.sh does it; docs/packages.md says what comes of it.
set(PELLUCID_MAINTAINER "Pellucid maintainers <maintainers@pellucid.invalid>"
    CACHE STRING "Who packages this, with an address to write to")
set(PELLUCID_DEB_REVISION 1 CACHE STRING "Revision of the Debian packages")

install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT docs)

# File managers: names and beginnings of files, and small pictures of them.
install(FILES packaging/desktop/pellucid.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT cli)
install(FILES packaging/desktop/pellucid.thumbnailer DESTINATION ${CMAKE_INSTALL_DATADIR}/thumbnailers COMPONENT cli)

# What Debian wants in each package, and a plain installation does not.
set(made ${PROJECT_BINARY_DIR}/debian)
file(MAKE_DIRECTORY ${made})
configure_file(packaging/debian/changelog.in ${made}/changelog @ONLY)
execute_process(COMMAND ${PELLUCID_GZIP} -9nc ${made}/changelog OUTPUT_FILE ${made}/changelog.Debian.gz)
execute_process(COMMAND ${PELLUCID_GZIP} -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md OUTPUT_FILE ${made}/changelog.gz)
foreach(pair cli:pellucid-cli images:pellucid-images gui:pellucid dev:libpellucid-dev)
    string(REPLACE ":" ";" pair ${pair})
    list(GET pair 0 component)
    list(GET pair 1 package)
    install(FILES packaging/debian/copyright ${made}/changelog.Debian.gz ${made}/changelog.gz
        DESTINATION share/doc/${package} COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()

set(CPACK_PACKAGE_NAME pellucid)
set(CPACK_PACKAGE_VENDOR "Pellucid")
set(CPACK_PACKAGE_CONTACT "${PELLUCID_MAINTAINER}")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_GENERATOR TGZ DEB)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE) # whatever the umask is
set(CPACK_COMPONENTS_ALL cli images dev)
if(PELLUCID_BUILD_GUI)
    list(APPEND CPACK_COMPONENTS_ALL gui)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${PELLUCID_DEB_REVISION})
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # CPack would put it before the summary that each package has of its own
set(same_version "(= ${PROJECT_VERSION}-${PELLUCID_DEB_REVISION})")

set(CPACK_DEBIAN_CLI_PACKAGE_NAME pellucid-cli)
set(CPACK_DEBIAN_CLI_PACKAGE_SECTION science)
set(CPACK_DEBIAN_CLI_PACKAGE_SUGGESTS "pellucid-images, pellucid, ffmpeg, libegl1, libosmesa6")
set(CPACK_DEBIAN_CLI_DESCRIPTION "volume explorer without a window
Draws volumes, such as CT and MRI scans or the results of simulations,
measures how visible and how salient each feature of a transfer function is,
and finds opacities that give each feature the share of attention that is
asked for. Reads DICOM, TIFF, OME-Zarr, HDF5, NetCDF, NRRD, MetaImage,
NIfTI, VTK, PVM, Voreen and headerless files.
.
This package has the command line, the programs that read file formats, the
types of these files and their thumbnails. It needs neither a display nor
Qt. It writes pictures as PNG files.")

set(CPACK_DEBIAN_IMAGES_PACKAGE_NAME pellucid-images)
set(CPACK_DEBIAN_IMAGES_PACKAGE_SECTION science)
set(CPACK_DEBIAN_IMAGES_PACKAGE_DEPENDS "pellucid-cli ${same_version}")
set(CPACK_DEBIAN_IMAGES_PACKAGE_RECOMMENDS "fonts-liberation | fonts-dejavu-core")
set(CPACK_DEBIAN_IMAGES_DESCRIPTION "volume explorer, pictures of many kinds
Reads pictures, writes them as EXR, TIFF and JPEG, and opens folders of PNG,
JPEG and BMP files as volumes. Makes figures for print, as SVG and PDF.
.
This package has what needs OpenImageIO and Pango, which bring 200 libraries
along, those of X11 among them.")

set(CPACK_DEBIAN_GUI_PACKAGE_NAME pellucid)
set(CPACK_DEBIAN_GUI_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_GUI_PACKAGE_DEPENDS "pellucid-cli ${same_version}, pellucid-images ${same_version}")
set(CPACK_DEBIAN_GUI_PACKAGE_RECOMMENDS "libgl1-mesa-dri, qt6-wayland")
set(CPACK_DEBIAN_GUI_PACKAGE_SUGGESTS "ffmpeg")
set(CPACK_DEBIAN_GUI_DESCRIPTION "volume explorer that finds the transfer function for you
Open a volume, such as a CT or MRI scan or the result of a simulation, and
say how much of the attention each feature should get. Pellucid measures how
visible and how salient every feature is from where you look, and changes
the opacities until the picture shows what you asked for.
.
This package has the window.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libpellucid-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libglm-dev, libeigen3-dev (>= 3.4), nlohmann-json3-dev, libpugixml-dev, libtbb-dev, zlib1g-dev, libbz2-dev, liblzma-dev, liblz4-dev, libdeflate-dev, libepoxy-dev")
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS "pellucid-cli ${same_version}, cmake")
set(CPACK_DEBIAN_DEV_DESCRIPTION "volume explorer, library and headers
Loads volumes, proposes transfer functions, draws, measures visibility and
saliency, and optimizes opacities, in C++20.
.
This package has a static library, its headers, a package for CMake
(find_package(Pellucid)) and an example. Formats that need libraries of
their own, such as DICOM, are read by programs of pellucid-cli.")
include(CPack)
