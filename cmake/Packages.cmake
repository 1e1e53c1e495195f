# Packages for Debian, by `cpack -G DEB` (tools/package.sh does all of it): the program with its scenes, manual pages and
# completions, the shared library of the C interface, what is needed to link the libraries, and the Python module.
set(CPACK_PACKAGE_NAME tenebra)
set(CPACK_PACKAGE_CONTACT "The Tenebra authors")  # tools/package.sh says who
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "exact shadows and ambient occlusion for animated scenes")
set(CPACK_PACKAGE_CHECKSUM SHA256)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL program runtime development)
if(TENEBRA_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python3)
endif()
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
set(control ${CMAKE_BINARY_DIR}/deb)
set(release "${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}")
list(PREPEND needed "libtenebra1 (= ${release})")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_REPLACES "libtenebra-dev (<< ${PROJECT_VERSION}-2)")  # had the library before
file(WRITE ${control}/triggers "activate-noawait ldconfig\n")
file(WRITE ${control}/shlibs "libtenebra 1 libtenebra1 (>= ${PROJECT_VERSION})\n")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA "${control}/triggers;${control}/shlibs")
list(JOIN needed ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
  "${about}This package has the\nlibraries and headers that other programs link.")

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME libtenebra1)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION
  "${about}This package has the\nshared library of the C interface, which programs need to run.")

# Modules are of one version of Python; Debian's tools compile the files beside them where it is installed.
set(CPACK_DEBIAN_PYTHON3_PACKAGE_NAME python3-tenebra)
set(CPACK_DEBIAN_PYTHON3_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON3_PACKAGE_SHLIBDEPS ON)
execute_process(COMMAND /usr/bin/python3 -c
  "import sys; a, b = sys.version_info[:2]; print(f'python3 (>= {a}.{b}), python3 (<< {a}.{b + 1}), python3-numpy', end='')"
  OUTPUT_VARIABLE CPACK_DEBIAN_PYTHON3_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_PYTHON3_PACKAGE_CONTROL_EXTRA "${control}/postinst;${control}/prerm")
set(CPACK_DEBIAN_PYTHON3_PACKAGE_CONTROL_STRICT_PERMISSION ON)
foreach(script "postinst py3compile" "prerm py3clean")
  string(REPLACE " " ";" script "${script}")
  list(GET script 0 name)
  list(GET script 1 tool)
  file(WRITE ${control}/${name}
    "#!/bin/sh\nset -e\nif command -v ${tool} > /dev/null; then ${tool} -p python3-tenebra; fi\n")
endforeach()
set(CPACK_COMPONENT_PYTHON3_DESCRIPTION
  "${about}This package has the\nmodule tenebra for Python: numpy arrays in and out.")
include(CPack)

# Files for the desktop and the shells. Manual pages, completions and the texts that Debian asks for are made by
# tools/package.sh, as they come from the program itself.
install(FILES packaging/tenebra.desktop DESTINATION share/applications COMPONENT program)
install(FILES packaging/tenebra.svg DESTINATION share/icons/hicolor/scalable/apps COMPONENT program)
install(FILES packaging/tenebra-mime.xml DESTINATION share/mime/packages RENAME tenebra.xml COMPONENT program)
foreach(component program development runtime)
  install(DIRECTORY ${CMAKE_BINARY_DIR}/package/${component}/ DESTINATION . COMPONENT ${component} OPTIONAL)
endforeach()
