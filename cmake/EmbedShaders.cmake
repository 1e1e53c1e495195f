# tenebra_shaders: every file of shaders/ as text in one generated header, <embedded_shaders.h>:
# namespace tenebra::shaders { inline constexpr std::string_view NAME_EXT = ...; }
file(GLOB shader_files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/shaders/*.vert ${CMAKE_SOURCE_DIR}/shaders/*.frag
  ${CMAKE_SOURCE_DIR}/shaders/*.glsl ${CMAKE_SOURCE_DIR}/shaders/*.comp)
set(shader_header ${CMAKE_BINARY_DIR}/shaders/embedded_shaders.h)
set(text "#pragma once\n#include <string_view>\nnamespace tenebra::shaders {\n")
foreach(file ${shader_files})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  get_filename_component(name ${file} NAME)
  string(REPLACE "." "_" name ${name})
  file(READ ${file} source)
  string(APPEND text "inline constexpr std::string_view ${name} = R\"GLSL(${source})GLSL\";\n")
endforeach()
string(APPEND text "}  // namespace tenebra::shaders\n")
file(CONFIGURE OUTPUT ${shader_header} CONTENT "${text}" @ONLY)
add_library(tenebra_shaders INTERFACE)
target_include_directories(tenebra_shaders INTERFACE ${CMAKE_BINARY_DIR}/shaders)
