# Packages for Debian, by `cpack -G DEB` (tools/package.sh does all of it): the program with its scenes, manual pages and
# completions, and the libraries with their headers.
set(CPACK_PACKAGE_NAME tenebra)
set(CPACK_PACKAGE_CONTACT "The Tenebra authors")  # tools/package.sh says who
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "exact shadows and ambient occlusion for animated scenes")
set(CPACK_PACKAGE_CHECKSUM SHA256)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_COMPONENTS_GROUPING IGNORE)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(about "Tenebra draws animated scenes with hard shadows, soft shadows of area\n")
string(APPEND about "lights and ambient occlusion that need no shadow bias and are checked\nagainst exact arithmetic. ")

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME tenebra)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# Loaded while it runs: OpenGL for the window, and for pictures where it is faster.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "libgl1, libegl1, libegl-mesa0, fonts-dejavu-core")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
  "${about}This package has the program:\na viewer, and a renderer of pictures.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libtenebra-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(needed libglm-dev libfmt-dev libexpected-dev libtbb-dev libhwy-dev libzstd-dev libdeflate-dev)
if(embree_FOUND)
  list(APPEND needed libembree-dev)
endif()
# It has the shared library of the C interface, too.
list(APPEND needed libc6 libstdc++6 libgcc-s1)
set(control ${CMAKE_BINARY_DIR}/deb)
file(WRITE ${control}/triggers "activate-noawait ldconfig\n")
file(WRITE ${control}/shlibs "libtenebra 1 libtenebra-dev (>= ${PROJECT_VERSION})\n")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_CONTROL_EXTRA "${control}/triggers;${control}/shlibs")
list(JOIN needed ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
  "${about}This package has the\nlibraries and headers that other programs link.")
include(CPack)

# What the desktop and the shells read. Manual pages, completions and the texts that Debian asks for are made by
# tools/package.sh, as they come from the program itself.
install(FILES packaging/tenebra.desktop DESTINATION share/applications COMPONENT program)
install(FILES packaging/tenebra.svg DESTINATION share/icons/hicolor/scalable/apps COMPONENT program)
install(FILES packaging/tenebra-mime.xml DESTINATION share/mime/packages RENAME tenebra.xml COMPONENT program)
foreach(component program development)
  install(DIRECTORY ${CMAKE_BINARY_DIR}/package/${component}/ DESTINATION . COMPONENT ${component} OPTIONAL)
endforeach()
